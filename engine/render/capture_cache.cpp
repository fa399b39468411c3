#include "render/capture_cache.hpp"

#include "core/error.hpp"
#include "render/capture_decider.hpp"
#include "render/postponed_redraws.hpp"
#include "require/model.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

/// Names of the two sets of capture arrays of a frame sequence, and of the set for frames outside
/// any sequence.
constexpr std::array<const char*, 3> kSetNames{"a", "b", "aside"};

/// Leaves out the captures of mirrors that need none. If no capture would remain, all captures
/// stay.
std::vector<CaptureOptions> remove_unneeded(const std::vector<CaptureOptions>& options,
                                            const require::WorkModel& model) {
    if (model.is_everything) return options;
    std::vector<CaptureOptions> required = options;
    for (std::size_t mirror = 0; mirror < options.size(); ++mirror)
        if (!model.mirrors[mirror].is_captured) required[mirror].face = 0;
    const auto exists = [](const CaptureOptions& one) { return one.face > 0; };
    return std::ranges::any_of(required, exists) ? required : options;
}

/// Returns the arrangement of the previous frame's captures if it holds every wanted capture,
/// because arrays do not shrink. Otherwise returns `wanted`.
std::vector<CaptureOptions> choose_layout(std::vector<CaptureOptions> wanted,
                                          const CaptureCache* before) {
    if (!before) return wanted;
    for (std::size_t mirror = 0; mirror < wanted.size(); ++mirror)
        if (wanted[mirror].face > 0 &&
            !have_equal_contents(wanted[mirror], before->options[mirror]))
            return wanted;
    for (std::size_t mirror = 0; mirror < wanted.size(); ++mirror)
        wanted[mirror].face = before->options[mirror].face > 0 && wanted[mirror].face == 0
                                  ? before->options[mirror].face
                                  : wanted[mirror].face;
    return wanted;
}

bool have_equal_layouts(const std::vector<CaptureOptions>& a,
                        const std::vector<CaptureOptions>& b) {
    return std::ranges::equal(a, b, have_equal_contents);
}

/// Calls visit for each pair of images that exist in both cube arrays.
template <typename Visit>
void for_each_image_pair(const CubeCaptureArray& from, const CubeCaptureArray& to,
                         const Visit& visit) {
    visit(from.colour, to.colour);
    for (const auto part : {&CubeCaptureArray::distance, &CubeCaptureArray::colour2,
                            &CubeCaptureArray::distance2, &CubeCaptureArray::surfaces})
        if (to.*part) visit(*(from.*part), *(to.*part));
}

CubeCaptureArray select_faces(const MirrorCaptures& captures, std::uint32_t mirror,
                              std::uint32_t first, std::uint32_t count) {
    const auto& [array, cube] = captures.places[mirror];
    return select_layers(captures.arrays[array], 6 * cube + first, count);
}

/// Declares the pass that copies unchanged contents into the set that the frame fills, if they are
/// not there yet. Records in the graph which picture each face will hold.
void copy_unchanged(graph::Graph& graph, const std::string& name, const CaptureUpdate& feeding) {
    const MirrorCaptures& captures = *feeding.captures;
    std::vector<std::pair<graph::ImageHandle, graph::ImageHandle>> copies;
    for (std::uint32_t mirror = 0; mirror < captures.places.size(); ++mirror) {
        if (!captures.places[mirror].has_capture()) continue;
        const auto drawing = [&](std::uint32_t face) {
            return feeding.kept->faces[mirror][face].drawing;
        };
        const auto is_made = [&](std::uint32_t face) {
            return feeding.work.face_work(mirror, face) != FaceUpdate::keep ||
                   !graph.has_content_hash(select_faces(captures, mirror, face, 1).colour,
                                           drawing(face));
        };
        const auto is_copied = [&](std::uint32_t face) {
            const CaptureWork& work = feeding.work;
            return is_made(face) && (work.face_work(mirror, face) == FaceUpdate::keep ||
                                     !work.drawn_part(mirror, face).is_whole());
        };
        for_each_face_range(is_copied, [&](std::uint32_t first, std::uint32_t end) {
            for_each_image_pair(select_faces(*feeding.last, mirror, first, end - first),
                                select_faces(captures, mirror, first, end - first),
                                [&](graph::ImageHandle from, graph::ImageHandle to) {
                                    copies.emplace_back(from, to);
                                });
        });
        for (std::uint32_t face = 0; face < 6; ++face) {
            if (!is_made(face)) continue;
            const CubeCaptureArray part = select_faces(captures, mirror, face, 1);
            for_each_image_pair(part, part, [&](graph::ImageHandle image, graph::ImageHandle) {
                graph.set_content_hash(image, drawing(face));
            });
        }
    }
    if (copies.empty()) return;
    graph::PassBuilder pass = graph.add_pass(name);
    for (const auto& [from, to] : copies)
        pass.reads(from, graph::ResourceUse::copy_from).writes(to, graph::ResourceUse::copy_to);
    pass.record([copies = std::move(copies)](graph::PassCommands& commands) {
        for (const auto& [from, to] : copies) commands.copy_image(from, to);
    });
}

/// Returns the images of this frame that captures of the next frame may read: colours and
/// distances.
std::shared_ptr<const MirrorCaptures> for_next_frame(MirrorCaptures captures) {
    for (CubeCaptureArray& cubes : captures.arrays)
        cubes.surfaces.reset(), cubes.colour2.reset(), cubes.distance2.reset();
    return std::make_shared<const MirrorCaptures>(std::move(captures));
}

bool keeps_all(const CaptureWork& work) {
    return std::ranges::all_of(work.faces, [](const std::array<FaceUpdate, 6>& faces) {
        return std::ranges::all_of(faces, [](FaceUpdate what) { return what == FaceUpdate::keep; });
    });
}

} // namespace

CaptureUpdate update_all_captures(graph::Graph& graph, const FrameInputs& inputs,
                                  const std::string& name, std::vector<CaptureOptions> options) {
    CaptureUpdate feeding;
    auto captures = std::make_shared<const MirrorCaptures>(
        declare_capture_images(graph, inputs, name, std::move(options)));
    feeding.last = std::make_shared<const MirrorCaptures>(
        declare_previous_captures(graph, *captures));
    feeding.was_there.assign(captures->options.size(),
                             graph.has_history(captures->arrays.front().colour));
    feeding.captures = std::move(captures);
    return feeding;
}

bool take_turns(const std::vector<CaptureOptions>& options) {
    return std::ranges::any_of(options, [](const CaptureOptions& one) { return one.every > 1; });
}

bool must_read_comparisons(const CaptureCache& captures, std::uint32_t most) {
    return captures.differing && (most > 0 || captures.is_late || take_turns(captures.options));
}

namespace {

/// Decides what the frame does with each capture. `takes_turns`: captures wait for their turn
/// (CaptureOptions::every). Returns whether some capture was there in the frame before.
bool decide_redraws(const CaptureDecider& decider, const std::vector<CaptureOptions>& layout,
                    std::uint32_t most, bool takes_turns, CaptureUpdate& feeding) {
    CaptureCache& kept = *feeding.kept;
    const auto mirrors = static_cast<std::uint32_t>(layout.size());
    bool any_there = false;
    std::vector<RedrawRequest> asking;
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror) {
        feeding.was_there.push_back(decider.had_same_layout(mirror));
        any_there = any_there || feeding.was_there.back();
        if (layout[mirror].face == 0) continue;
        decider.decide(mirror, feeding.work, kept);
        if (kept.changes[mirror] == CaptureChange::none || !decider.can_wait(mirror, feeding.work))
            continue;
        if (takes_turns && !decider.has_turn(mirror))
            decider.postpone(mirror, feeding.work, kept);
        else if (most > 0)
            asking.push_back({mirror, decider.frames_waited(mirror)});
    }
    for (const std::uint32_t mirror : choose_postponed(std::move(asking), most))
        decider.postpone(mirror, feeding.work, kept);
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror)
        kept.is_late = kept.is_late || (kept.changes[mirror] != CaptureChange::none &&
                                        decider.frames_waited(mirror) > 0);
    return any_there;
}

} // namespace

CaptureUpdate update_required_captures(graph::Graph& graph, const FrameInputs& inputs,
                                       const std::string& name,
                                       const std::vector<CaptureOptions>& options,
                                       const require::WorkModel& model,
                                       const PreviousCaptures& sequel) {
    const auto& [before, comparisons, most] = sequel;
    check(!before || !must_read_comparisons(*before, most), Failure::internal, "captures '", name,
          "' depend on comparisons of faces: call read_comparisons before this frame");
    const std::size_t mirrors = options.size();
    const bool follows = before && before->options.size() == mirrors;
    const CaptureCache* const known = follows ? before.get() : nullptr;
    const std::vector<CaptureOptions> layout = choose_layout(remove_unneeded(options, model),
                                                             known);
    const auto declare = [&](const std::vector<CaptureOptions>& laid_out,
                             const CaptureCache& filled) {
        MirrorCaptures captures = declare_capture_images(graph, inputs, name, laid_out,
                                                         kSetNames[filled.set]);
        for (const std::array<CachedFace, 6>& faces : filled.faces)
            std::ranges::transform(faces, captures.drawings.emplace_back().begin(),
                                   &CachedFace::drawing);
        return std::make_shared<const MirrorCaptures>(std::move(captures));
    };
    CaptureUpdate feeding;
    feeding.work.faces.resize(mirrors), feeding.work.parts.resize(mirrors);
    feeding.kept = std::make_shared<CaptureCache>();
    CaptureCache& kept = *feeding.kept;
    kept.options = layout;
    kept.faces.resize(mirrors), kept.changes.resize(mirrors), kept.saw.resize(mirrors);
    kept.waited.resize(mirrors);
    const bool any_there = decide_redraws(CaptureDecider(inputs.scene, model, inputs.facts.number,
                                                         layout, known, comparisons != nullptr),
                                          layout, most, comparisons != nullptr, feeding);
    if (known && have_equal_layouts(layout, known->options) && keeps_all(feeding.work)) {
        kept.set = known->set;
        feeding.captures = declare(layout, kept);
        return feeding;
    }
    kept.set = before ? 1 - before->set : (comparisons ? 0 : 2);
    if (any_there) feeding.last = declare(known->options, *known);
    feeding.captures = declare(layout, kept);
    copy_unchanged(graph, inputs.prefix + name + ".keep", feeding);
    if (any_there) feeding.last = for_next_frame(*feeding.last);
    if (std::ranges::find(kept.changes, CaptureChange::unknown) != kept.changes.end()) {
        kept.before = before;
        kept.differing = comparisons->buffer(mirrors);
    }
    return feeding;
}

} // namespace catoptric::render
