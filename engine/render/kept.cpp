#include "render/kept.hpp"

#include "core/stamp.hpp"
#include "render/views.hpp"

#include <algorithm>
#include <cstring>

namespace catoptric::render {

namespace {

/// Of a sequence, and of what is rendered beside it and follows nothing.
constexpr std::array<const char*, 3> kSets{"a", "b", "aside"};
constexpr std::uint64_t kCleared = 1; // the drawing of a face that holds nothing

/// A mirror that is not captured is one without a capture, unless that would leave none.
std::vector<CaptureOptions> required_options(const std::vector<CaptureOptions>& options,
                                             const require::Model& model) {
    std::vector<CaptureOptions> required = options;
    for (std::size_t mirror = 0; mirror < options.size(); ++mirror)
        if (!model.mirrors[mirror].is_captured) required[mirror].face = 0;
    const auto exists = [](const CaptureOptions& one) { return one.face > 0; };
    return std::ranges::any_of(required, exists) ? required : options;
}

/// The same for as long as that holds all that is wanted: arrays do not become smaller.
std::vector<CaptureOptions> layout_of(std::vector<CaptureOptions> wanted,
                                      const KeptCaptures* before) {
    if (!before) return wanted;
    for (std::size_t mirror = 0; mirror < wanted.size(); ++mirror)
        if (wanted[mirror].face > 0 && !same_contents(wanted[mirror], before->options[mirror]))
            return wanted;
    for (std::size_t mirror = 0; mirror < wanted.size(); ++mirror)
        wanted[mirror].face = before->options[mirror].face > 0 && wanted[mirror].face == 0
                                  ? before->options[mirror].face
                                  : wanted[mirror].face;
    return wanted;
}

bool same_layout(const std::vector<CaptureOptions>& a, const std::vector<CaptureOptions>& b) {
    return std::ranges::equal(a, b, same_contents);
}

/// Tells what a frame has to do, mirror by mirror.
class Decider {
public:
    Decider(const GpuScene& scene, const require::Model& model,
            const std::vector<CaptureOptions>& layout, const KeptCaptures* before, bool compares)
        : scene_(scene), model_(model), layout_(layout), before_(before), compares_(compares) {
        if (before) changed_ = changed(*before);
        Stamp lit;
        for (std::uint32_t light = 0; light < scene.light_count(); ++light) {
            lit.add_all(std::span(scene.backdrops(light)));
            for (std::uint32_t face = 0; face < scene.drawn_shadow_faces(light); ++face)
                lit.add(scene.views()[scene.shadow_view(light) + face]);
        }
        shadow_views_ = lit.value();
    }

    bool was_there(std::uint32_t mirror) const {
        return before_ && layout_[mirror].face > 0 &&
               same_contents(before_->options[mirror], layout_[mirror]);
    }

    void decide(std::uint32_t mirror, CaptureWork& work, KeptCaptures& kept) const {
        Change change = Change::none;
        std::vector<std::uint32_t>& saw = kept.saw[mirror];
        for (std::uint32_t face = 0; face < 6; ++face) {
            const std::vector<std::uint32_t> seen = seen_by(mirror, face);
            const FaceWork what = decide(mirror, face, seen, kept.faces[mirror][face]);
            work.faces[mirror][face] = what;
            if (what == FaceWork::draw) change = Change::some;
            if (what != FaceWork::compare) continue;
            change = std::max(change, Change::unknown);
            saw.insert(saw.end(), seen.begin(), seen.end());
        }
        kept.changes[mirror] = change;
    }

private:
    /// The other mirrors that the face shows by their captures.
    std::vector<std::uint32_t> seen_by(std::uint32_t mirror, std::uint32_t face) const {
        const shared::View& view = scene_.views()[scene_.capture_view(mirror) + face];
        std::vector<std::uint32_t> seen;
        for (const std::uint32_t other : model_.mirrors[mirror].sees)
            if (layout_[other].face > 0 &&
                may_meet(view, scene_.ranges()[scene_.mirror_object(other)]))
                seen.push_back(other);
        return seen;
    }

    FaceWork decide(std::uint32_t mirror, std::uint32_t face,
                    const std::vector<std::uint32_t>& seen, KeptFace& now) const {
        const require::MirrorNeeds& needs = model_.mirrors[mirror];
        Stamp shown = Stamp(shadow_views_)
                          .add(needs.stamps[face])
                          .add(scene_.views()[scene_.capture_view(mirror) + face]);
        for (const std::uint32_t other : seen) shown.add(other);
        const std::uint64_t stamp = shown.value();
        now = was_there(mirror) ? before_->faces[mirror][face] : KeptFace();
        const bool shows_same = now.drawing > 0 && now.stamp == stamp;
        const auto has_changed = [&](std::uint32_t other) { return changed_[other] != 0; };
        if (shows_same && std::ranges::none_of(seen, has_changed)) return FaceWork::keep;
        if (!needs.is_captured || !(needs.faces >> face & 1)) {
            now.stamp = 0; // should somebody look again
            if (now.drawing > 0) return FaceWork::keep;
            now.drawing = kCleared;
            return FaceWork::clear;
        }
        now = {stamp, drawing(stamp, seen)};
        return shows_same && compares_ ? FaceWork::compare : FaceWork::draw;
    }

    /// By what it is made from, to the captures that it shows.
    std::uint64_t drawing(std::uint64_t stamp, const std::vector<std::uint32_t>& seen) const {
        Stamp number;
        number.add(stamp);
        for (const std::uint32_t other : seen)
            for (std::uint32_t face = 0; face < 6; ++face)
                number.add(was_there(other) ? before_->faces[other][face].drawing : 0);
        return std::max<std::uint64_t>(number.value(), kCleared + 1);
    }

    const GpuScene& scene_;
    const require::Model& model_;
    const std::vector<CaptureOptions>& layout_;
    const KeptCaptures* before_;
    bool compares_;
    std::vector<char> changed_;
    std::uint64_t shadow_views_ = 0; ///< of all lights
};

/// Calls visit for each image of both that is there.
template <typename Visit>
void for_each_pair(const Cubes& from, const Cubes& to, const Visit& visit) {
    visit(from.colour, to.colour);
    for (const auto part : {&Cubes::distance, &Cubes::colour2, &Cubes::distance2, &Cubes::surfaces})
        if (to.*part) visit(*(from.*part), *(to.*part));
}

Cubes faces_of(const Captures& captures, std::uint32_t mirror, std::uint32_t first,
               std::uint32_t count) {
    const auto& [array, cube] = captures.places[mirror];
    return part_of(captures.arrays[array], 6 * cube + first, count);
}

/// Brings what stays into the set that the frame fills, unless it is there, and says what the frame
/// makes that from.
void add_keeping(graph::Graph& graph, const std::string& name, const Feeding& feeding) {
    const Captures& captures = *feeding.captures;
    std::vector<std::pair<graph::Image, graph::Image>> copies;
    for (std::uint32_t mirror = 0; mirror < captures.places.size(); ++mirror) {
        if (!captures.places[mirror].exists()) continue;
        const auto drawing = [&](std::uint32_t face) {
            return feeding.kept->faces[mirror][face].drawing;
        };
        const auto is_made = [&](std::uint32_t face) {
            return feeding.work.of(mirror, face) != FaceWork::keep ||
                   !graph.holds(faces_of(captures, mirror, face, 1).colour, drawing(face));
        };
        const auto is_copied = [&](std::uint32_t face) {
            return is_made(face) && feeding.work.of(mirror, face) == FaceWork::keep;
        };
        for_each_run(is_copied, [&](std::uint32_t first, std::uint32_t end) {
            for_each_pair(
                faces_of(*feeding.last, mirror, first, end - first),
                faces_of(captures, mirror, first, end - first),
                [&](graph::Image from, graph::Image to) { copies.emplace_back(from, to); });
        });
        for (std::uint32_t face = 0; face < 6; ++face) {
            if (!is_made(face)) continue;
            const Cubes part = faces_of(captures, mirror, face, 1);
            for_each_pair(part, part, [&](graph::Image image, graph::Image) {
                graph.made_from(image, drawing(face));
            });
        }
    }
    if (copies.empty()) return;
    graph::PassBuilder pass = graph.pass(name);
    for (const auto& [from, to] : copies)
        pass.reads(from, graph::Use::copy_from).writes(to, graph::Use::copy_to);
    pass.record([copies = std::move(copies)](graph::Commands& commands) {
        for (const auto& [from, to] : copies) commands.copy(from, to);
    });
}

/// What captures can see of last frame's.
std::shared_ptr<const Captures> looked_into(Captures captures) {
    for (Cubes& cubes : captures.arrays)
        cubes.surfaces.reset(), cubes.colour2.reset(), cubes.distance2.reset();
    return std::make_shared<const Captures>(std::move(captures));
}

bool is_idle(const CaptureWork& work) {
    return std::ranges::all_of(work.faces, [](const std::array<FaceWork, 6>& faces) {
        return std::ranges::all_of(faces, [](FaceWork what) { return what == FaceWork::keep; });
    });
}

} // namespace

Feeding feed_all(graph::Graph& graph, const FrameInputs& inputs, const std::string& name,
                 std::vector<CaptureOptions> options) {
    Feeding feeding;
    auto captures = std::make_shared<const Captures>(
        declare_captures(graph, inputs, name, std::move(options)));
    feeding.last = std::make_shared<const Captures>(previous(graph, *captures));
    feeding.was_there.assign(captures->options.size(),
                             graph.has_history(captures->arrays.front().colour));
    feeding.captures = std::move(captures);
    return feeding;
}

Feeding feed_required(graph::Graph& graph, const FrameInputs& inputs, const std::string& name,
                      const std::vector<CaptureOptions>& options, const require::Model& model,
                      const std::shared_ptr<KeptCaptures>& before, Comparisons* comparisons) {
    const std::size_t mirrors = options.size();
    const bool follows = before && before->options.size() == mirrors;
    const KeptCaptures* const known = follows ? before.get() : nullptr;
    const std::vector<CaptureOptions> layout = layout_of(required_options(options, model), known);
    const auto declare = [&](const std::vector<CaptureOptions>& laid_out,
                             const KeptCaptures& filled) {
        Captures captures = declare_captures(graph, inputs, name, laid_out, kSets[filled.set]);
        for (const std::array<KeptFace, 6>& faces : filled.faces)
            std::ranges::transform(faces, captures.drawings.emplace_back().begin(),
                                   &KeptFace::drawing);
        return std::make_shared<const Captures>(std::move(captures));
    };
    Feeding feeding;
    feeding.work.faces.resize(mirrors);
    feeding.kept = std::make_shared<KeptCaptures>();
    KeptCaptures& kept = *feeding.kept;
    kept.options = layout;
    kept.faces.resize(mirrors), kept.changes.resize(mirrors), kept.saw.resize(mirrors);
    const Decider decider(inputs.scene, model, layout, known, comparisons != nullptr);
    bool any_there = false;
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror) {
        feeding.was_there.push_back(decider.was_there(mirror));
        any_there = any_there || feeding.was_there.back();
        if (layout[mirror].face > 0) decider.decide(mirror, feeding.work, kept);
    }
    if (known && same_layout(layout, known->options) && is_idle(feeding.work)) {
        kept.set = known->set;
        feeding.captures = declare(layout, kept);
        return feeding;
    }
    kept.set = before ? 1 - before->set : (comparisons ? 0 : 2);
    if (any_there) feeding.last = declare(known->options, *known);
    feeding.captures = declare(layout, kept);
    add_keeping(graph, inputs.prefix + name + ".keep", feeding);
    if (any_there) feeding.last = looked_into(*feeding.last);
    if (std::ranges::find(kept.changes, Change::unknown) != kept.changes.end()) {
        kept.before = before;
        kept.differing = comparisons->buffer(mirrors);
    }
    return feeding;
}

} // namespace catoptric::render
