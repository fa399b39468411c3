// How mirrors are drawn in the camera's view: each technique makes the shader of its mirrors
// (Technique::look or Technique::search), and this file adds what all shaders may read.
#include "reflect/captures.hpp"
#include "reflect/feature.hpp"

#include <algorithm>

namespace catoptric::reflect {

namespace {

/// Returns whether the picture without glass needs levels; none: no glass looks it up.
std::optional<bool> find_opaque_levels(const FrameDeclaration& frame) {
    const render::GpuScene& scene = frame.inputs.scene;
    bool is_read = false, has_levels = false;
    for (std::uint32_t mirror = 0; mirror < frame.assignment.of_mirror.size(); ++mirror) {
        const SharedKnobs& knobs = frame.choices()[frame.assignment.of_mirror[mirror]].shared;
        if (knobs.refract != render::kRefractScreen) continue;
        is_read = is_read || scene.draw_ranges()[scene.mirror_object(mirror)].glass;
        // Shaders of rough mirrors read levels.
        has_levels = has_levels || (knobs.rough.uses_levels() && scene.is_rough_mirror(mirror));
    }
    return is_read ? std::optional(has_levels) : std::nullopt;
}

constexpr FrameFeature kOpaquePictureFeature{
    .name = "opaque picture",
    .order = feature_order::kOpaquePicture,
    .applies =
        [](const FrameDeclaration& frame) {
            return is_rasterised(frame) && find_opaque_levels(frame).has_value();
        },
    .add =
        [](FrameDeclaration& frame) {
            frame.opaque = render::declare_opaque_picture(frame.graph, frame.inputs,
                                                          *find_opaque_levels(frame));
        }};
const RegisteredFeature kOpaquePictureRegistration{kOpaquePictureFeature};

std::vector<std::uint32_t> mirrors_of(std::size_t choice, const Assignment& assignment) {
    std::vector<std::uint32_t> mirrors;
    for (std::uint32_t i = 0; i < assignment.of_mirror.size(); ++i)
        if (assignment.of_mirror[i] == choice) mirrors.push_back(i);
    return mirrors;
}

/// Returns how a technique draws its mirrors. Declares the passes that this needs.
MirrorShading make_look(FrameDeclaration& frame, const TechniqueChoice& choice,
                        const ShadingInputs& around) {
    const Technique& technique = *choice.technique;
    if (technique.search) return {make_search_shader(technique, around, choice.settings), {}};
    render::FrameInputs own = frame.inputs;
    if (frame.is_mixed()) own.prefix += choice.file_name() + "/";
    return technique.look(frame.graph, own, choice.settings, around);
}

/// Adds images that glass reads: the back faces behind it, and the picture without glass.
/// `glass_backs` is made at first use.
void add_glass_images(FrameDeclaration& frame, std::uint32_t refract, MirrorShading& look,
                      std::optional<graph::ImageHandle>& glass_backs) {
    const std::optional<render::OpaquePicture>& opaque = frame.opaque;
    if (refract == render::kRefractBackface && frame.inputs.scene.has_glass()) {
        if (!glass_backs) glass_backs = render::add_glass_back_pass(frame.graph, frame.inputs);
        look.mirror.images.emplace_back(kGlassBackImage, std::vector{*glass_backs});
    }
    if (refract == render::kRefractScreen) {
        if (!opaque) remove_view_images(look.mirror);
        if (opaque)
            look.mirror.images.emplace_back(kOpaquePictureImage, std::vector{opaque->colour});
        if (opaque && opaque->levels)
            look.mirror.images.emplace_back(kOpaqueLevelImage, std::vector{*opaque->levels});
    }
    if (opaque && look.tracer && look.tracer->first_raster) {
        // Glass would look up the numbers of triangles that such a shader draws.
        look.mirror.variant.clear();
        look.tracer->first_raster = false;
    }
}

/// Adds the tracer that completes the pixels which a mirror's shader leaves to rays.
void add_tracer(FrameDeclaration& frame, MirrorShading& look) {
    if (!look.tracer) return;
    if (!look.tracer->paths) {
        look.tracer->lighting.probes = frame.lighting.probes;
        look.tracer->lighting.ambient_occlusion = frame.view_lighting.ambient_occlusion;
    }
    frame.tracers.push_back(*look.tracer);
    look.mirror.constants.emplace_back("tracer", static_cast<std::uint32_t>(frame.tracers.size()));
}

void add_looks(FrameDeclaration& frame) {
    std::optional<graph::ImageHandle> glass_backs;
    for (std::size_t i = 0; i < frame.choices().size(); ++i) {
        const TechniqueChoice& choice = frame.choices()[i];
        const ShadingInputs around{frame.outputs.captures,
                                   frame.completes_view
                                       ? frame.lighting
                                       : frame.light_with(choose_shadow_map(choice.shared.shadow)),
                                   mirrors_of(i, frame.assignment), frame.completes_view};
        MirrorShading look = make_look(frame, choice, around);
        if (frame.captures && look.mirror.captures == frame.captures->captures)
            frame.levels->add_lookup(frame.graph, around.mirrors, choice.shared, look.mirror);
        add_glass_images(frame, choice.shared.refract, look, glass_backs);
        add_tracer(frame, look);
        if (!frame.outputs.captures) frame.outputs.captures = look.mirror.captures;
        frame.looks.looks.push_back(std::move(look.mirror));
    }
}

constexpr FrameFeature kMirrorFeature{
    .name = "mirrors",
    .order = feature_order::kMirrors,
    .applies = is_rasterised,
    .add = [](FrameDeclaration& frame) {
        frame.looks.of_mirror = frame.assignment.of_mirror;
        if (frame.completes_view || !frame.assignment.of_mirror.empty()) add_looks(frame);
        if (!frame.outputs.captures) return;
        const std::vector<std::string>& notes = frame.outputs.captures->notes;
        frame.outputs.notes.insert(frame.outputs.notes.begin(), notes.begin(), notes.end());
    }};
const RegisteredFeature kMirrorRegistration{kMirrorFeature};

} // namespace

} // namespace catoptric::reflect
