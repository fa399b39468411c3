#include "render/passes.hpp"

#include "core/half.hpp"
#include "render/box_filter.hpp"
#include "render/draw.hpp"
#include "render/pass_faces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::render {

namespace {

using graph::ClearValue;
using graph::ImageHandle;
using graph::PassCommands;
using graph::PassPurpose;
using graph::ResourceUse;

/// Returns the shaders with the given causes of error removed.
MirrorShaders remove_error_causes(MirrorShaders looks, const FrameInputs& inputs,
                                  const ShadingLights& lighting) {
    if (!inputs.ablated) return looks;
    inputs.requests.trace_rays(SphereMode::mesh, false);
    if (inputs.ablated >> shared::kAblateDrawBits) inputs.requests.sample_lamps();
    for (MirrorShader& look : looks.looks) {
        if (!look.captures) continue;
        look.ablated = inputs.ablated;
        for (const auto& [name, value] :
             {std::pair{"picture_width", inputs.size.x},
              {"picture_height", inputs.size.y},
              {"max_depth", kReferenceBounces},
              {"traces_lobes", inputs.ablated >> shared::kAblateDrawBits ? 1u : 0u},
              {"shadow", lighting.shadow_map ? 1u : 0u}})
            look.constants.emplace_back(name, value);
    }
    return looks;
}

/// The objects that a pass of the camera's view draws. Glass is that which is drawn as a mirror.
enum class CameraViewObjects { all, opaque, glass };

/// Records the draws of the camera's view. The sky belongs to the first of its passes, and blended
/// surfaces to the last.
void record_camera_view(PassCommands& commands, const GpuScene& scene, const DrawSettings& drawing,
                        CameraViewObjects drawn) {
    const auto is_seen = [&](std::size_t object) {
        return scene.draw_ranges()[object].seen_by_camera;
    };
    draw_scene(commands, scene, drawing, [&](std::size_t object) {
        const DrawRange& range = scene.draw_ranges()[object];
        const bool is_glass = range.glass && range.mirror;
        return is_seen(object) &&
               (drawn == CameraViewObjects::all || is_glass == (drawn == CameraViewObjects::glass));
    });
    if (drawn != CameraViewObjects::glass)
        draw_sky(commands, scene, drawing.first_view, drawing.layers, drawing.store);
    if (drawn != CameraViewObjects::opaque)
        draw_blended_surfaces(commands, scene, drawing, is_seen);
}

void add_opaque_picture(graph::Graph& graph, const FrameInputs& inputs, ImageHandle hdr,
                        const OpaquePicture& picture) {
    graph.add_pass(inputs.prefix + "opaque_picture")
        .reads(hdr, ResourceUse::copy_from)
        .writes(picture.colour, ResourceUse::copy_to)
        .record([hdr, colour = picture.colour](PassCommands& commands) {
            commands.copy_image(hdr, colour);
        });
    if (picture.levels)
        add_box_filter(graph, inputs.prefix + "opaque_picture/levels",
                       {{picture.colour, *picture.levels}});
}

} // namespace

OpaquePicture declare_opaque_picture(graph::Graph& graph, const FrameInputs& inputs,
                                     bool has_levels) {
    const uvec2 size = inputs.size;
    OpaquePicture picture{
        graph.add_image({inputs.prefix + "opaque_picture", TexelFormat::rgba32f, size.x, size.y}),
        {}};
    if (has_levels)
        picture.levels = add_picture_levels(graph, inputs.prefix + "opaque_picture/levels", size);
    return picture;
}

CameraOutputs add_camera_view(graph::Graph& graph, const FrameInputs& inputs,
                              const ShadingLights& lighting, MirrorShaders looks, bool is_traced,
                              ShadingTracer completing_tracer,
                              std::optional<GlassOverPicture> glass) {
    const uvec2 size = inputs.size;
    const ImageHandle hdr = graph.add_image(
        {inputs.prefix + "hdr", TexelFormat::rgba32f, size.x, size.y});
    const ImageHandle depth = graph.add_image(
        {inputs.prefix + "view.depth", TexelFormat::d32f, size.x, size.y});
    CameraOutputs view{hdr, {}, {}};
    if ((is_traced && completing_tracer.number == 0) || inputs.with_lookup) {
        // The order of attachments is that of the shaders' outputs. `tracers` takes the location
        // that captures use for distance. The lookup follows.
        view.tracers = graph.add_image(
            {inputs.prefix + "view.tracers", TexelFormat::r32f, size.x, size.y});
        view.lookup = graph.add_image(
            {inputs.prefix + "lookup", TexelFormat::rgba32f, size.x, size.y});
    }
    const auto add_pass = [&](const char* name, CameraViewObjects drawn, MirrorShaders own) {
        const bool is_first = drawn != CameraViewObjects::glass;
        const auto cleared_to = [&](const ClearValue& value) {
            return is_first ? std::optional(value) : std::nullopt;
        };
        graph::PassBuilder pass = graph.add_pass(inputs.prefix + name,
                                                 is_first ? PassPurpose::scene : PassPurpose::none);
        declare_shader_reads(pass, lighting, own);
        pass.writes(hdr, ResourceUse::colour, cleared_to(kClearBlack));
        if (view.tracers)
            pass.writes(*view.tracers, ResourceUse::colour, cleared_to(ClearValue{}))
                .writes(*view.lookup, ResourceUse::colour, cleared_to(ClearValue{}));
        DrawSettings drawing{.first_view = GpuScene::kCameraViewIndex,
                             .layers = 1,
                             .lighting = lighting,
                             .looks = std::make_shared<const MirrorShaders>(
                                 remove_error_causes(std::move(own), inputs, lighting)),
                             .store = {},
                             .completing_tracer = completing_tracer,
                             .peeled = {}};
        if (is_traced) drawing.store.emplace_back("distance_scale", 0.0f);
        pass.writes(depth, ResourceUse::depth, cleared_to(kClearFarthest))
            .record([&scene = inputs.scene, drawn,
                     drawing = std::move(drawing)](PassCommands& commands) {
                record_camera_view(commands, scene, drawing, drawn);
            });
    };
    if (glass) {
        add_pass("view", CameraViewObjects::opaque, std::move(glass->opaque_looks));
        add_opaque_picture(graph, inputs, hdr, glass->picture);
        add_pass("view.glass", CameraViewObjects::glass, std::move(looks));
    } else {
        add_pass("view", CameraViewObjects::all, std::move(looks));
    }
    return view;
}

ImageHandle add_glass_back_pass(graph::Graph& graph, const FrameInputs& inputs) {
    const uvec2 size = inputs.size;
    const ImageHandle backs = graph.add_image(
        {inputs.prefix + "glass_backs", TexelFormat::rgba32f, size.x, size.y});
    const ImageHandle depth = graph.add_image(
        {inputs.prefix + "glass_backs.depth", TexelFormat::d32f, size.x, size.y});
    graph.add_pass(inputs.prefix + "glass_backs")
        .writes(backs, ResourceUse::colour, ClearValue{})
        .writes(depth, ResourceUse::depth, kClearFarthest)
        .record([&scene = inputs.scene](PassCommands& commands) {
            scene.bind(commands);
            draw_objects(commands, scene, {"", "glass_back.frag", {}}, GpuScene::kCameraViewIndex,
                         1, {}, [&](std::size_t i) {
                             const DrawRange& range = scene.draw_ranges()[i];
                             return range.glass && range.seen_by_camera;
                         });
        });
    return backs;
}

MirroredViewImages add_mirrored_view(graph::Graph& graph, const FrameInputs& inputs,
                                     const std::string& name, const MirroredView& view,
                                     std::uint32_t number, const ShadingLights& lighting,
                                     MirrorShaders looks, std::optional<std::uint32_t> left_out,
                                     const MirroredViewWishes& wanted) {
    const uvec2 size = inputs.size;
    // Every device filters 16-bit floats linearly, as blurred look-ups need.
    const ImageHandle colour = graph.add_image(
        {inputs.prefix + name, wanted.has_levels ? TexelFormat::rgba16f : TexelFormat::rgba32f,
         size.x, size.y});
    MirroredViewImages images{colour, {}, {}};
    const ImageHandle depth = graph.add_image(
        {inputs.prefix + name + ".depth", TexelFormat::d32f, size.x, size.y});
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + name, PassPurpose::scene);
    declare_shader_reads(pass, lighting, looks);
    DrawSettings drawing{.first_view = number,
                         .layers = 1,
                         .lighting = lighting,
                         .looks = std::make_shared<const MirrorShaders>(std::move(looks)),
                         .store = {},
                         .peeled = {}};
    if (wanted.has_levels) drawing.store.emplace_back("largest_colour", kMaxHalf);
    pass.writes(colour, ResourceUse::colour, kClearBlack);
    if (wanted.has_distances) {
        constexpr float kNoSurface = std::numeric_limits<float>::infinity();
        images.distances = graph.add_image(
            {inputs.prefix + name + ".distances", TexelFormat::r16f, size.x, size.y});
        pass.writes(*images.distances, ResourceUse::colour,
                    ClearValue{{kNoSurface, kNoSurface, kNoSurface, kNoSurface}});
    }
    pass.writes(depth, ResourceUse::depth, kClearFarthest)
        .render_area(view.area)
        .record([&scene = inputs.scene, drawing, view, size, left_out](PassCommands& commands) {
            const auto is_left_out = [&](std::size_t object) {
                return left_out && object == scene.mirror_object(*left_out);
            };
            const auto is_shown = [&](std::size_t object) {
                return !is_left_out(object) &&
                       may_show(view, size, scene.draw_ranges()[object].bounds);
            };
            draw_scene(commands, scene, drawing, is_shown);
            draw_sky(commands, scene, drawing.first_view, drawing.layers, drawing.store);
            draw_blended_surfaces(commands, scene, drawing, is_shown);
        });
    if (wanted.has_levels) {
        images.levels = add_picture_levels(graph, inputs.prefix + name + "/levels", size);
        add_box_filter(graph, inputs.prefix + name + "/levels",
                       {{colour, *images.levels, view.area, images.distances}});
    }
    return images;
}

ImageHandle add_compose_pass(graph::Graph& graph, const FrameInputs& inputs, ImageHandle hdr,
                             double exposure_stops) {
    const uvec2 size = inputs.size;
    const ImageHandle picture = graph.add_image(
        {inputs.prefix + "ldr", TexelFormat::rgba8_unorm, size.x, size.y});
    graph.add_pass(inputs.prefix + "compose")
        .reads(hdr, ResourceUse::sampled)
        .writes(picture, ResourceUse::colour, kClearBlack)
        .record([=](PassCommands& commands) {
            commands.bind_pipeline(gpu::RasterState{"screen.vert", "compose.frag", {}});
            commands.bind("hdr", hdr);
            commands.push_constants(static_cast<float>(std::exp2(exposure_stops)));
            commands.draw_fullscreen();
        });
    return picture;
}

} // namespace catoptric::render
