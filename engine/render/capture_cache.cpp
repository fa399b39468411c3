#include "render/capture_cache.hpp"

#include "core/error.hpp"
#include "render/capture_decider.hpp"
#include "render/postponed_redraws.hpp"
#include "require/model.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

/// Names of the two sets of a sequence, and of the set for frames outside any sequence.
constexpr std::array<const char*, 3> kCaptureSetNames{"a", "b", "aside"};

/// Removes the captures of mirrors that need none. If no capture would remain, keeps all of them.
std::vector<CaptureOptions> drop_unneeded_captures(const std::vector<CaptureOptions>& options,
                                                   const require::Model& model) {
    std::vector<CaptureOptions> required = options;
    for (std::size_t mirror = 0; mirror < options.size(); ++mirror)
        if (!model.mirrors[mirror].is_captured) required[mirror].face = 0;
    const auto exists = [](const CaptureOptions& one) { return one.face > 0; };
    return std::ranges::any_of(required, exists) ? required : options;
}

/// Returns the layout of the frame before if it holds every wanted capture, because arrays do not
/// shrink. Otherwise returns `wanted`.
std::vector<CaptureOptions> choose_cache_layout(std::vector<CaptureOptions> wanted,
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

/// Calls visit for each image that both cube arrays have.
template <typename Visit>
void for_each_cube_pair(const CubeArray& from, const CubeArray& to, const Visit& visit) {
    visit(from.colour, to.colour);
    for (const auto part :
         {&CubeArray::distance, &CubeArray::colour2, &CubeArray::distance2, &CubeArray::surfaces})
        if (to.*part) visit(*(from.*part), *(to.*part));
}

CubeArray capture_faces(const Captures& captures, std::uint32_t mirror, std::uint32_t first,
                        std::uint32_t count) {
    const auto& [array, cube] = captures.places[mirror];
    return cube_layer_range(captures.arrays[array], 6 * cube + first, count);
}

/// Declares the pass that copies unchanged contents into the set that the frame fills, if they are
/// not there yet. Records in the graph which picture each face will hold.
void add_copy_of_unchanged(graph::Graph& graph, const std::string& name,
                           const CaptureUpdate& feeding) {
    const Captures& captures = *feeding.captures;
    std::vector<std::pair<graph::ImageHandle, graph::ImageHandle>> copies;
    for (std::uint32_t mirror = 0; mirror < captures.places.size(); ++mirror) {
        if (!captures.places[mirror].is_captured()) continue;
        const auto drawing = [&](std::uint32_t face) {
            return feeding.kept->faces[mirror][face].drawing;
        };
        const auto is_made = [&](std::uint32_t face) {
            return feeding.work.work_on_face(mirror, face) != FaceWork::keep ||
                   !graph.holds_content(capture_faces(captures, mirror, face, 1).colour,
                                        drawing(face));
        };
        const auto is_copied = [&](std::uint32_t face) {
            const CaptureWork& work = feeding.work;
            return is_made(face) && (work.work_on_face(mirror, face) == FaceWork::keep ||
                                     !work.part(mirror, face).is_whole());
        };
        for_each_face_run(is_copied, [&](std::uint32_t first, std::uint32_t end) {
            for_each_cube_pair(capture_faces(*feeding.last, mirror, first, end - first),
                               capture_faces(captures, mirror, first, end - first),
                               [&](graph::ImageHandle from, graph::ImageHandle to) {
                                   copies.emplace_back(from, to);
                               });
        });
        for (std::uint32_t face = 0; face < 6; ++face) {
            if (!is_made(face)) continue;
            const CubeArray part = capture_faces(captures, mirror, face, 1);
            for_each_cube_pair(part, part, [&](graph::ImageHandle image, graph::ImageHandle) {
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

/// Returns the images that captures of the next frame may sample: colours and distances.
std::shared_ptr<const Captures> images_for_next_frame(Captures captures) {
    for (CubeArray& cubes : captures.arrays)
        cubes.surfaces.reset(), cubes.colour2.reset(), cubes.distance2.reset();
    return std::make_shared<const Captures>(std::move(captures));
}

bool is_nothing_to_do(const CaptureWork& work) {
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
    feeding.last = std::make_shared<const Captures>(captures_of_previous_frame(graph, *captures));
    feeding.was_there.assign(captures->options.size(),
                             graph.has_history(captures->arrays.front().colour));
    feeding.captures = std::move(captures);
    return feeding;
}

bool must_read_comparisons(const CaptureCache& captures, std::uint32_t most) {
    return captures.differing && (most > 0 || captures.is_late);
}

CaptureUpdate update_required_captures(graph::Graph& graph, const FrameInputs& inputs,
                                       const std::string& name,
                                       const std::vector<CaptureOptions>& options,
                                       const require::Model& model,
                                       const PreviousCaptures& sequel) {
    const auto& [before, comparisons, most] = sequel;
    check(!before || !must_read_comparisons(*before, most), Failure::internal, "captures '", name,
          "' are put off before it is known what changed");
    const std::size_t mirrors = options.size();
    const bool follows = before && before->options.size() == mirrors;
    const CaptureCache* const known = follows ? before.get() : nullptr;
    const std::vector<CaptureOptions> layout = choose_cache_layout(
        drop_unneeded_captures(options, model), known);
    const auto declare = [&](const std::vector<CaptureOptions>& laid_out,
                             const CaptureCache& filled) {
        Captures captures = declare_captures(graph, inputs, name, laid_out,
                                             kCaptureSetNames[filled.set]);
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
    const CaptureDecider decider(inputs.scene, model, layout, known, comparisons != nullptr);
    bool any_there = false;
    std::vector<RedrawRequest> asking;
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror) {
        feeding.was_there.push_back(decider.had_same_capture(mirror));
        any_there = any_there || feeding.was_there.back();
        if (layout[mirror].face == 0) continue;
        decider.decide_faces(mirror, feeding.work, kept);
        if (most > 0 && kept.changes[mirror] != CaptureChange::none &&
            decider.can_wait(mirror, feeding.work))
            asking.push_back({mirror, decider.frames_waited(mirror)});
    }
    for (const std::uint32_t mirror : choose_postponed_mirrors(std::move(asking), most))
        decider.postpone_redraw(mirror, feeding.work, kept);
    for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror)
        kept.is_late = kept.is_late || (kept.changes[mirror] != CaptureChange::none &&
                                        decider.frames_waited(mirror) > 0);
    if (known && have_equal_layouts(layout, known->options) && is_nothing_to_do(feeding.work)) {
        kept.set = known->set;
        feeding.captures = declare(layout, kept);
        return feeding;
    }
    kept.set = before ? 1 - before->set : (comparisons ? 0 : 2);
    if (any_there) feeding.last = declare(known->options, *known);
    feeding.captures = declare(layout, kept);
    add_copy_of_unchanged(graph, inputs.prefix + name + ".keep", feeding);
    if (any_there) feeding.last = images_for_next_frame(*feeding.last);
    if (std::ranges::find(kept.changes, CaptureChange::unknown) != kept.changes.end()) {
        kept.before = before;
        kept.differing = comparisons->buffer(mirrors);
    }
    return feeding;
}

} // namespace catoptric::render
