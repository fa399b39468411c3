#include "render/capture_cache.hpp"

#include "core/error.hpp"
#include "render/decider.hpp"
#include "render/turns.hpp"
#include "require/model.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

/// Names of the two sets of a sequence, and of the set for frames outside any sequence.
constexpr std::array<const char*, 3> kSets{"a", "b", "aside"};

/// Removes the captures of mirrors that need none. If no capture would remain, keeps all of them.
std::vector<CaptureOptions> required_options(const std::vector<CaptureOptions>& options,
                                             const require::Model& model) {
    std::vector<CaptureOptions> required = options;
    for (std::size_t mirror = 0; mirror < options.size(); ++mirror)
        if (!model.mirrors[mirror].is_captured) required[mirror].face = 0;
    const auto exists = [](const CaptureOptions& one) { return one.face > 0; };
    return std::ranges::any_of(required, exists) ? required : options;
}

/// Returns the layout of the frame before if it holds every wanted capture, because arrays do not
/// shrink. Otherwise returns `wanted`.
std::vector<CaptureOptions> layout_of(std::vector<CaptureOptions> wanted,
                                      const CaptureCache* before) {
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

/// Calls visit for each image that both cube arrays have.
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

/// Declares the pass that copies unchanged contents into the set that the frame fills, if they are
/// not there yet. Records in the graph which picture each face will hold.
void add_keeping(graph::Graph& graph, const std::string& name, const CaptureUpdate& feeding) {
    const Captures& captures = *feeding.captures;
    std::vector<std::pair<graph::ImageHandle, graph::ImageHandle>> copies;
    for (std::uint32_t mirror = 0; mirror < captures.places.size(); ++mirror) {
        if (!captures.places[mirror].exists()) continue;
        const auto drawing = [&](std::uint32_t face) {
            return feeding.kept->faces[mirror][face].drawing;
        };
        const auto is_made = [&](std::uint32_t face) {
            return feeding.work.of(mirror, face) != FaceWork::keep ||
                   !graph.holds_content(faces_of(captures, mirror, face, 1).colour, drawing(face));
        };
        const auto is_copied = [&](std::uint32_t face) {
            const CaptureWork& work = feeding.work;
            return is_made(face) &&
                   (work.of(mirror, face) == FaceWork::keep || !work.part(mirror, face).is_whole());
        };
        for_each_run(is_copied, [&](std::uint32_t first, std::uint32_t end) {
            for_each_pair(faces_of(*feeding.last, mirror, first, end - first),
                          faces_of(captures, mirror, first, end - first),
                          [&](graph::ImageHandle from, graph::ImageHandle to) {
                              copies.emplace_back(from, to);
                          });
        });
        for (std::uint32_t face = 0; face < 6; ++face) {
            if (!is_made(face)) continue;
            const Cubes part = faces_of(captures, mirror, face, 1);
            for_each_pair(part, part, [&](graph::ImageHandle image, graph::ImageHandle) {
                graph.set_content_hash(image, drawing(face));
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

/// Returns the images that captures of the next frame may sample: colours and distances.
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

CaptureUpdate update_all_captures(graph::Graph& graph, const FrameInputs& inputs,
                                  const std::string& name, std::vector<CaptureOptions> options) {
    CaptureUpdate feeding;
    auto captures = std::make_shared<const Captures>(
        declare_captures(graph, inputs, name, std::move(options)));
    feeding.last = std::make_shared<const Captures>(previous(graph, *captures));
    feeding.was_there.assign(captures->options.size(),
                             graph.has_history(captures->arrays.front().colour));
    feeding.captures = std::move(captures);
    return feeding;
}

bool must_learn(const CaptureCache& captures, std::uint32_t most) {
    return captures.differing && (most > 0 || captures.is_late);
}

CaptureUpdate update_required_captures(graph::Graph& graph, const FrameInputs& inputs,
                                       const std::string& name,
                                       const std::vector<CaptureOptions>& options,
                                       const require::Model& model,
                                       const PreviousCaptures& sequel) {
    const auto& [before, comparisons, most] = sequel;
    check(!before || !must_learn(*before, most), Failure::internal, "captures '", name,
          "' are put off before it is known what changed");
    const std::size_t mirrors = options.size();
    const bool follows = before && before->options.size() == mirrors;
    const CaptureCache* const known = follows ? before.get() : nullptr;
    const std::vector<CaptureOptions> layout = layout_of(required_options(options, model), known);
    const auto declare = [&](const std::vector<CaptureOptions>& laid_out,
                             const CaptureCache& filled) {
        Captures captures = declare_captures(graph, inputs, name, laid_out, kSets[filled.set]);
        for (const std::array<CachedFace, 6>& faces : filled.faces)
            std::ranges::transform(faces, captures.drawings.emplace_back().begin(),
                                   &CachedFace::drawing);
        return std::make_shared<const Captures>(std::move(captures));
    };
    CaptureUpdate feeding;
    feeding.work.faces.resize(mirrors), feeding.work.parts.resize(mirrors);
    feeding.kept = std::make_shared<CaptureCache>();
    CaptureCache& kept = *feeding.kept;
    kept.options = layout;
    kept.faces.resize(mirrors), kept.changes.resize(mirrors), kept.saw.resize(mirrors);
    kept.waited.resize(mirrors);
    const Decider decider(inputs.scene, model, layout, known, comparisons != nullptr);
    bool any_there = false;
    std::vector<Asking> asking;
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror) {
        feeding.was_there.push_back(decider.was_there(mirror));
        any_there = any_there || feeding.was_there.back();
        if (layout[mirror].face == 0) continue;
        decider.decide(mirror, feeding.work, kept);
        if (most > 0 && kept.changes[mirror] != CaptureChange::none &&
            decider.can_wait(mirror, feeding.work))
            asking.push_back({mirror, decider.waited(mirror)});
    }
    for (const std::uint32_t mirror : put_off(std::move(asking), most))
        decider.put_off(mirror, feeding.work, kept);
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror)
        kept.is_late = kept.is_late ||
                       (kept.changes[mirror] != CaptureChange::none && decider.waited(mirror) > 0);
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
    if (std::ranges::find(kept.changes, CaptureChange::unknown) != kept.changes.end()) {
        kept.before = before;
        kept.differing = comparisons->buffer(mirrors);
    }
    return feeding;
}

} // namespace catoptric::render
