// Passes that draw the captures of mirrors' surroundings.
#include "core/half.hpp"
#include "render/draw.hpp"
#include "render/face_area.hpp"
#include "render/pass_faces.hpp"
#include "render/passes.hpp"
#include "render/shown_faces.hpp"

#include <limits>

namespace catoptric::render {

namespace {

using graph::ClearValue;
using graph::ImageHandle;
using graph::PassCommands;
using graph::PassPurpose;
using graph::ResourceUse;

/// Depth peeling keeps a surface in the second layer if its distance exceeds that of the first by
/// the largest rounding error of a stored distance. Vulkan lets devices round unorm8 and halves to
/// either neighbour; Direct3D, for which graphics cards are made, too, allows errors of .6 steps of
/// unorm8. An NVIDIA H200 rounds unorm8 by more than half a step, and seems to round halves towards
/// zero. A whole step for unorm8 would lose surfaces of the second layer where its range is much
/// too large.
constexpr float kUnorm8Rounding = .6f / 255, kPeelMarginOfHalves = 0x1p-9f;

/// Declares that a pass clears and writes the images of a cube map. If an area is given, only this
/// area is cleared and written.
void declare_cube_writes(graph::PassBuilder& pass, const CaptureOptions& options,
                         const CubeCaptureArray& cubes,
                         const std::optional<graph::PixelRectangle>& area = {}) {
    // If no surface is seen in a direction, the stored distance is +infinity. Unorm8 cannot store
    // infinity, and stores the end of its range.
    const float nothing = options.distance == TexelFormat::r8_unorm
                              ? 1.0f
                              : std::numeric_limits<float>::infinity();
    const auto write = [&](ImageHandle image, const ClearValue& clear) {
        area ? pass.updates(image, ResourceUse::colour, clear)
             : pass.writes(image, ResourceUse::colour, clear);
    };
    write(cubes.colour, kClearBlack);
    if (cubes.distance) write(*cubes.distance, ClearValue{nothing, 0, 0, 0});
    if (cubes.surfaces) write(*cubes.surfaces, ClearValue{});
    if (area) pass.render_area(*area);
}

bool may_face_show(const GpuScene& scene, std::uint32_t mirror, std::uint32_t face,
                   const require::FacePart& part, std::size_t object) {
    return part.is_whole() ||
           !intersect(part,
                      part_showing(scene.list_views()[scene.capture_view(mirror) + face],
                                   static_cast<int>(face), scene.draw_ranges()[object].bounds))
                .is_empty();
}

/// Returns the balls inside mirrors that a capture draws completely.
std::vector<InnerBall> occluding_balls(const GpuScene& scene, const MirrorShaders& looks) {
    std::vector<InnerBall> balls;
    for (std::uint32_t mirror = 0; mirror < scene.mirror_count(); ++mirror)
        if (looks.of_mirror[mirror] != MirrorShaders::kByPart)
            balls.push_back(scene.inner_ball(mirror));
    return balls;
}

/// Declares a pass that draws a range of faces of a mirror's capture. `peeled`: draws only what
/// lies behind these distances.
void add_capture_pass(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options,
                      const FaceRange& faces, const std::string& pass_name,
                      const CubeCaptureArray& cubes,
                      const std::shared_ptr<const MirrorShaders>& looks,
                      std::optional<ImageHandle> peeled, const require::FacePart& changing) {
    const std::string name = inputs.prefix + pass_name;
    const ImageHandle depth = graph.add_image({name + ".depth", TexelFormat::d32f, options.face,
                                               options.face, faces.count, faces.count == 6});
    graph::PassBuilder pass = graph.add_pass(name, PassPurpose::scene);
    declare_shader_reads(pass, options.lighting, *looks);
    if (peeled) pass.reads(*peeled, ResourceUse::sampled);
    const require::FacePart part = grow_to_texels(changing, options.face);
    declare_cube_writes(pass, options, cubes, to_pixel_area(part, options.face));
    DrawSettings drawing{.first_view = inputs.scene.capture_view(faces.owner) + faces.first,
                         .layers = faces.count,
                         .lighting = options.lighting,
                         .looks = looks,
                         .store = {{"distance_scale", 1 / options.stored_unit}},
                         .peeled = peeled};
    if (options.colour == TexelFormat::rgba16f && options.saturates)
        drawing.store.emplace_back("largest_colour", kMaxHalf);
    if (cubes.surfaces) drawing.store.emplace_back("keeps_surface", 1u);
    if (peeled && options.distance == TexelFormat::r8_unorm)
        drawing.store.emplace_back("stored_rounding", kUnorm8Rounding);
    if (peeled && options.distance == TexelFormat::r16f)
        drawing.store.emplace_back("peel_margin", kPeelMarginOfHalves);
    pass.writes(depth, ResourceUse::depth, kClearFarthest)
        .layers(faces.count)
        .record([&scene = inputs.scene, mirror = faces.owner, face = faces.first, part,
                 edge = options.face, drawing = std::move(drawing),
                 stores = cubes.distance.has_value(), alpha = options.blended_alpha,
                 leaves_out = options.leaves_out_spheres](PassCommands& commands) {
            const auto is_wanted = [&](std::size_t object) {
                const DrawRange& range = scene.draw_ranges()[object];
                return object != scene.mirror_object(mirror) &&
                       !(leaves_out && range.mirror && range.exact_sphere && !range.lit) &&
                       may_face_show(scene, mirror, face, part, object);
            };
            if (drawing.peeled) { // a second layer shows what the first layer hides
                draw_scene(commands, scene, drawing, is_wanted);
                return;
            }
            const std::vector<std::uint8_t> shown = find_shown_faces(
                std::span(scene.list_views()).subspan(drawing.first_view, drawing.layers),
                {edge, scene.device().limits().subPixelPrecisionBits}, scene.draw_ranges(),
                occluding_balls(scene, *drawing.looks), is_wanted);
            const auto is_shown = [&](std::size_t object) { return shown[object] != 0; };
            draw_scene(commands, scene, drawing, is_shown, shown);
            draw_sky(commands, scene, drawing.first_view, drawing.layers, drawing.store);
            draw_blended_surfaces(commands, scene, drawing, is_shown, shown);
            if (stores) draw_blended_distances(commands, scene, drawing, alpha, is_shown, shown);
        });
}

/// Declares a pass that clears capture faces into which no ray can look.
void add_clear_pass(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options,
                    const FaceRange& faces, const std::string& name,
                    const CubeCaptureArray& cubes) {
    graph::PassBuilder pass = graph.add_pass(inputs.prefix + face_range_name(name, faces) +
                                             ".clear");
    declare_cube_writes(pass, options, cubes);
    if (cubes.colour2)
        declare_cube_writes(pass, options,
                            {cubes.face, *cubes.colour2, cubes.distance2, {}, {}, {}});
    pass.layers(faces.count).record([](PassCommands&) {});
}

} // namespace

void add_captures(graph::Graph& graph, const FrameInputs& inputs, const MirrorCaptures& captures,
                  MirrorShaders looks, const CaptureWork& work) {
    const auto shared = std::make_shared<const MirrorShaders>(std::move(looks));
    for (std::uint32_t mirror = 0; mirror < captures.options.size(); ++mirror) {
        if (!captures.places[mirror].has_capture()) continue;
        const auto& [array, cube] = captures.places[mirror];
        const CaptureOptions& options = captures.options[mirror];
        const std::string number = "/" + std::to_string(mirror + 1);
        const auto draw = [&, first_layer = 6 * cube, &cubes = captures.arrays[array]](
                              std::uint32_t first, std::uint32_t end) {
            const FaceRange faces{mirror, first, end - first};
            const require::FacePart changing = work.drawn_part(mirror, first);
            const CubeCaptureArray part = select_layers(cubes, first_layer + first, faces.count);
            const CubeCaptureArray front{part.face, part.colour, part.distance,
                                         {},        {},          part.surfaces};
            add_capture_pass(graph, inputs, options, faces,
                             face_range_name(captures.name + number, faces), front, shared, {},
                             changing);
            if (part.colour2)
                add_capture_pass(graph, inputs, options, faces,
                                 face_range_name(captures.name + "2" + number, faces),
                                 {part.face, *part.colour2, part.distance2, {}, {}, {}}, shared,
                                 part.distance, changing);
        };
        const auto clear = [&, first_layer = 6 * cube, &cubes = captures.arrays[array]](
                               std::uint32_t first, std::uint32_t end) {
            add_clear_pass(graph, inputs, options, {mirror, first, end - first},
                           captures.name + number,
                           select_layers(cubes, first_layer + first, end - first));
        };
        for_each_face_range(
            [&](std::uint32_t face) {
                return work.is_drawn(mirror, face) && work.drawn_part(mirror, face).is_whole();
            },
            draw);
        for (std::uint32_t face = 0; face < 6; ++face)
            if (!work.drawn_part(mirror, face).is_whole()) draw(face, face + 1);
        for_each_face_range(
            [&](std::uint32_t face) { return work.face_work(mirror, face) == FaceUpdate::clear; },
            clear);
    }
}

} // namespace catoptric::render
