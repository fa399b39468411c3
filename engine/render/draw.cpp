#include "render/draw.hpp"

#include "render/views.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace catoptric::render {

namespace {

using graph::ImageHandle;
using graph::PassCommands;
using graph::TextureFilter;

constexpr const char* kBlackMirrorShader = "mirror_black.frag";

/// Returns the winding of back faces in a view's picture. Cube faces show the scene mirrored.
gpu::TriangleWinding back_face_winding(const shared::View& view) {
    return dot(glm::cross(view.right, view.down), view.forward) > 0
               ? gpu::TriangleWinding::clockwise
               : gpu::TriangleWinding::counterclockwise;
}

/// `own`: the objects are stored in object space.
std::string choose_vertex_shader(bool own, const shared::View& view) {
    return std::string(own ? "placed.vert" : "scene.vert") +
           (view.clip == vec4(0) ? "" : "#clipped");
}

/// Draws one object into the layers whose views it may meet. Draws neighbouring layers in one call
/// for each run of triangles.
void draw_object(PassCommands& commands, const GpuScene& scene, std::size_t object,
                 std::uint32_t first_view, std::uint32_t layers, const DrawnParts& parts) {
    const DrawRange& range = scene.draw_ranges()[object];
    const auto instance = static_cast<std::uint32_t>(object) << shared::kInstanceLayerBits;
    scene.bind_vertices(commands, object);
    const auto draw_layers = [&](std::uint32_t first, std::uint32_t count) {
        const auto draw = [&](std::uint32_t from, std::uint32_t indices) {
            commands.draw(range.first_index + from, indices, first, count, instance);
        };
        if (!parts.triangles) return draw(0, range.index_count);
        for (const auto& [from, end] : *parts.triangles) draw(3 * from, 3 * (end - from));
    };
    const auto is_drawn_in = [&](std::uint32_t layer) {
        if (!parts.layers.empty()) return (parts.layers[object] >> layer & 1) != 0;
        return may_show(scene.list_views()[first_view + layer], range);
    };
    for (std::uint32_t layer = 0; layer < layers;) {
        std::uint32_t end = layer;
        while (end < layers && is_drawn_in(end)) ++end;
        if (end > layer) draw_layers(layer, end - layer);
        layer = end + 1;
    }
}

/// Returns a list with one image of each array of captures.
template <typename Part>
std::vector<ImageHandle> cube_images(const MirrorCaptures& captures, Part&& part) {
    std::vector<ImageHandle> images;
    for (const CubeCaptureArray& cubes : captures.arrays) images.push_back(part(cubes));
    return images;
}

void bind_captures(PassCommands& commands, const MirrorCaptures& captures) {
    commands.bind("colour_cubes", cube_images(captures, [](const CubeCaptureArray& cubes) {
                      return cubes.colour;
                  }));
    // Every shader has these bindings. If captures lack an image, their colour image is bound as a
    // placeholder that no shader reads.
    commands.bind("surface_cubes", cube_images(captures, [](const CubeCaptureArray& cubes) {
                      return cubes.surfaces.value_or(cubes.colour);
                  }));
    const std::vector<ImageHandle> distances = cube_images(
        captures,
        [](const CubeCaptureArray& cubes) { return cubes.distance.value_or(cubes.colour); });
    commands.bind("distance_cubes", distances);
    commands.bind("linear_texels", TextureFilter::linear);
    commands.bind("nearest_texels", TextureFilter::nearest);
    commands.bind("mipmapped_texels", TextureFilter::mipmapped);
    if (captures.table) commands.bind("Captures", *captures.table);
}

/// Adds the constants that tell a shader where the captures are stored.
void add_capture_constants(const MirrorCaptures& captures, gpu::ShaderConstants& constants) {
    const auto unit_of = [](const CaptureOptions& options) { return options.stored_unit; };
    const float unit = unit_of(captures.options.front());
    const bool same = std::ranges::all_of(
        captures.options, [&](float other) { return other == unit; }, unit_of);
    if (captures.arrays.front().distance && same)
        constants.emplace_back("stored_unit", unit);
    else if (captures.table)
        constants.emplace_back("stored_unit", 0.f); // the table of captures holds this value for
                                                    // each mirror
    if (!captures.table) return;
    constants.emplace_back("has_capture_table", 1u);
    constants.emplace_back("array_count", static_cast<std::uint32_t>(captures.arrays.size()));
}

/// Returns the constants of the pass for fragment shaders that draw objects with a colour.
gpu::ShaderConstants fragment_constants(const GpuScene& scene, const DrawSettings& drawing) {
    gpu::ShaderConstants features;
    if (drawing.peeled) features.emplace_back("peels", 1u);
    if (scene.has_varying_colours()) features.emplace_back("lights_mirrors", 1u);
    if (drawing.lighting.shadow_map) features.emplace_back("has_shadow_map", 1u);
    if (drawing.lighting.probes)
        features.emplace_back("light_probe_content", drawing.lighting.probes->content);
    if (drawing.lighting.has_soft_shadows) features.emplace_back("soft_shadows", 1u);
    if (drawing.lighting.ambient_occlusion) features.emplace_back("has_ambient_occlusion", 1u);
    return features;
}

void draw_mirrors(PassCommands& commands, const GpuScene& scene, const DrawSettings& drawing,
                  const MirrorShader& look, const ObjectFilter& wanted, const DrawnParts& parts) {
    gpu::RasterState state{"", kBlackMirrorShader, drawing.store};
    state.features = fragment_constants(scene, drawing);
    if (!look.fragment.empty() && !look.blank) {
        state.fragment = look.fragment +
                         (look.ablated && !drawing.peeled ? "#ablate" : look.variant);
        state.constants.insert(state.constants.end(), look.constants.begin(), look.constants.end());
        // Known only when passes are recorded, unlike the other constants of ablations.
        if (look.ablated >> shared::kAblateDrawBits && scene.has_sampled_lamps())
            state.constants.emplace_back("samples_lamps", 1u);
        if (look.captures) bind_captures(commands, *look.captures);
        if (look.captures) add_capture_constants(*look.captures, state.constants);
        for (const auto& [name, images] : look.images) commands.bind(name, images);
        for (const auto& [name, buffer] : look.buffers) commands.bind(name, buffer);
        if (!look.captures) commands.bind("mipmapped_texels", TextureFilter::mipmapped);
    }
    const auto& draw = drawing.peeled ? draw_objects : draw_without_back_faces;
    draw(commands, scene, state, drawing.first_view, drawing.layers, {look.ablated, look.shown},
         wanted, parts);
}

/// Returns whether back faces of the object need not be drawn in a view, because none is visible.
/// For a sphere, this leaves out half of all triangles. Returns false if the eye is inside the
/// object's bounds or the view has a clip plane.
bool can_cull_back_faces(const GpuScene& scene, const shared::View& view, std::size_t object) {
    const DrawRange& range = scene.draw_ranges()[object];
    const bool within = all(lessThanEqual(range.bounds.lo, view.eye)) &&
                        all(lessThanEqual(view.eye, range.bounds.hi));
    return range.shell && !range.flipped && !within && view.parallel == 0 && view.clip == vec4(0);
}

/// Draws the parts of blended objects that are not opaque over the picture. The farthest object is
/// drawn first, and of each object first the triangles that face away. `state`: pipeline state of
/// opaque objects.
void draw_blended_objects(PassCommands& commands, const GpuScene& scene, gpu::RasterState state,
                          const DrawSettings& drawing, const ObjectFilter& wanted,
                          const DrawnParts& parts) {
    const shared::View& view = scene.list_views()[drawing.first_view];
    std::vector<std::pair<float, std::size_t>> order; // distance, object
    for (std::size_t i = 0; i < scene.draw_ranges().size(); ++i) {
        const DrawRange& range = scene.draw_ranges()[i];
        if (!range.blended || !wanted(i)) continue;
        const vec3 to_object = range.bounds.centre() - view.eye;
        order.emplace_back(view.parallel ? dot(view.forward, to_object) : length(to_object), i);
    }
    std::ranges::stable_sort(order, std::ranges::greater(), &std::pair<float, std::size_t>::first);
    state.blending = gpu::Blending::cover;
    state.constants.emplace_back("drawn_parts", shared::kDrawBlendedParts);
    std::ranges::copy(scene.feature_constants(drawing.first_view),
                      std::back_inserter(state.features));
    const gpu::TriangleWinding backs = back_face_winding(view),
                               fronts = backs == gpu::TriangleWinding::clockwise
                                            ? gpu::TriangleWinding::counterclockwise
                                            : gpu::TriangleWinding::clockwise;
    for (const auto& [distance, object] : order) {
        const DrawRange& range = scene.draw_ranges()[object];
        state.vertex = choose_vertex_shader(range.own.has_value(), view);
        for (const gpu::TriangleWinding hidden : {fronts, backs}) {
            if (hidden == fronts && range.one_sided) continue;
            state.hidden = hidden;
            commands.bind_pipeline(state);
            commands.push_constants(shared::DrawParameters{.first_view = drawing.first_view});
            draw_object(commands, scene, object, drawing.first_view, drawing.layers, parts);
        }
    }
}

} // namespace

void bind_lighting(PassCommands& commands, const ShadingLights& lighting) {
    if (lighting.shadow_map)
        commands.bind("shadow_map", *lighting.shadow_map, TextureFilter::compare);
    if (lighting.shadow_map && lighting.has_soft_shadows)
        commands.bind("shadow_depths", *lighting.shadow_map, TextureFilter::nearest);
    if (lighting.shadow_map && lighting.glass_depths)
        commands.bind("glass_depths", *lighting.glass_depths, TextureFilter::nearest);
    if (lighting.ambient_occlusion)
        commands.bind("ambient_occlusion", *lighting.ambient_occlusion, TextureFilter::nearest);
    if (!lighting.probes) return;
    commands.bind("probe_grid", lighting.probes->grid);
    commands.bind("probe_light", lighting.probes->light, TextureFilter::linear);
    commands.bind("probe_distances", lighting.probes->distances, TextureFilter::linear);
}

void draw_objects(PassCommands& commands, const GpuScene& scene, gpu::RasterState state,
                  std::uint32_t first_view, std::uint32_t layers, const MirrorDrawNumbers& numbers,
                  const ObjectFilter& wanted, const DrawnParts& parts) {
    std::ranges::copy(scene.feature_constants(first_view), std::back_inserter(state.features));
    for (const bool own : {false, true}) {
        if (own && !scene.has_object_spaces()) break;
        state.vertex = choose_vertex_shader(own, scene.list_views()[first_view]);
        bool in_use = false; // avoids creating a pipeline that draws nothing
        for (std::size_t i = 0; i < scene.draw_ranges().size(); ++i) {
            if (scene.draw_ranges()[i].own.has_value() != own || !wanted(i)) continue;
            if (!std::exchange(in_use, true)) {
                commands.bind_pipeline(state);
                commands.push_constants(
                    shared::DrawParameters{first_view, numbers.ablated, numbers.shown});
            }
            draw_object(commands, scene, i, first_view, layers, parts);
        }
    }
}

void draw_without_back_faces(PassCommands& commands, const GpuScene& scene, gpu::RasterState state,
                             std::uint32_t first_view, std::uint32_t layers,
                             const MirrorDrawNumbers& numbers, const ObjectFilter& wanted,
                             const DrawnParts& parts) {
    const shared::View& view = scene.list_views()[first_view];
    const auto is_front = [&](std::size_t i) { return can_cull_back_faces(scene, view, i); };
    draw_objects(
        commands, scene, state, first_view, layers, numbers,
        [&](std::size_t i) { return wanted(i) && !is_front(i); }, parts);
    state.hidden = back_face_winding(view);
    draw_objects(
        commands, scene, std::move(state), first_view, layers, numbers,
        [&](std::size_t i) { return wanted(i) && is_front(i); }, parts);
}

namespace {

gpu::RasterState make_diffuse_state(const GpuScene& scene, const DrawSettings& drawing) {
    gpu::RasterState diffuse{"", "diffuse.frag", drawing.store, gpu::TriangleWinding::none,
                             fragment_constants(scene, drawing)};
    const ShadingTracer& tracer = drawing.completing_tracer;
    if (tracer.number == 0) return diffuse;
    diffuse.fragment += "#first";
    diffuse.constants.emplace_back("tracer", tracer.number);
    diffuse.constants.emplace_back("traces_lobes", tracer.traces_lobes ? 1u : 0u);
    // The ray tracer continues behind blended surfaces.
    diffuse.constants.emplace_back("drawn_parts", shared::kDrawAllParts);
    return diffuse;
}

/// Draws all mirrors for which `wanted` returns true.
void draw_all_mirrors(PassCommands& commands, const GpuScene& scene, const DrawSettings& drawing,
                      const ObjectFilter& wanted, std::span<const std::uint8_t> shown) {
    const MirrorShaders& looks = *drawing.looks;
    for (std::uint32_t look = 0; look < looks.looks.size(); ++look)
        draw_mirrors(commands, scene, drawing, looks.looks[look],
                     [&](std::size_t i) {
                         const std::uint32_t mirror = scene.mirror_of(i);
                         return mirror > 0 && looks.of_mirror[mirror - 1] == look && wanted(i);
                     },
                     {nullptr, shown});
    for (const PartShader& part : looks.parts)
        draw_mirrors(
            commands, scene, drawing, looks.looks[part.look],
            [&](std::size_t i) { return scene.mirror_of(i) == part.mirror + 1 && wanted(i); },
            {&part.triangles, shown});
}

} // namespace

void draw_scene(PassCommands& commands, const GpuScene& scene, const DrawSettings& drawing,
                const ObjectFilter& wanted, std::span<const std::uint8_t> shown) {
    const DrawnParts whole{nullptr, shown};
    const auto& [first_view, layers, lighting, looks, store, tracer, peeled] = drawing;
    scene.bind(commands);
    if (std::ranges::any_of(looks->looks, &MirrorShader::ablated)) scene.bind_tracing(commands);
    bind_lighting(commands, lighting);
    if (peeled) commands.bind("first_layer", *peeled);
    gpu::RasterState diffuse = make_diffuse_state(scene, drawing);
    const auto draw_diffuse = [&](bool one_sided, gpu::TriangleWinding hidden) {
        diffuse.hidden = hidden;
        draw_objects(
            commands, scene, diffuse, first_view, layers, {},
            [&](std::size_t i) {
                const DrawRange& range = scene.draw_ranges()[i];
                return !range.mirror && range.one_sided == one_sided && wanted(i);
            },
            whole);
    };
    const auto is_black = [&](std::size_t object) {
        return first_view == GpuScene::kCameraViewIndex && scene.encloses_camera(object);
    };
    const auto is_visible = [&](std::size_t i) { return wanted(i) && !is_black(i); };
    // In a scene of many mirrors, other mirrors cover most of a capture. Drawing them first avoids
    // shading the objects that they hide.
    const bool mirrors_first = scene.uses_mirror_tree() && first_view != GpuScene::kCameraViewIndex;
    if (mirrors_first) draw_all_mirrors(commands, scene, drawing, is_visible, shown);
    draw_diffuse(false, gpu::TriangleWinding::none);
    if (std::ranges::any_of(scene.draw_ranges(), &DrawRange::one_sided))
        draw_diffuse(true, back_face_winding(scene.list_views()[first_view]));
    if (!mirrors_first) draw_all_mirrors(commands, scene, drawing, is_visible, shown);
    const auto is_shut = [&](std::size_t i) { return is_black(i) && wanted(i); };
    for (std::size_t i = 0; i < scene.draw_ranges().size(); ++i)
        if (is_shut(i))
            return draw_objects(commands, scene,
                                {"", kBlackMirrorShader, store, gpu::TriangleWinding::none,
                                 fragment_constants(scene, drawing)},
                                first_view, layers, {}, is_shut, whole);
}

void draw_blended_surfaces(PassCommands& commands, const GpuScene& scene,
                           const DrawSettings& drawing, const ObjectFilter& wanted,
                           std::span<const std::uint8_t> shown) {
    if (!scene.has_blended_surfaces() || drawing.completing_tracer.number > 0 || drawing.peeled)
        return;
    // The ambient occlusion of these pixels is that of the opaque surface behind.
    DrawSettings unoccluded = drawing;
    unoccluded.lighting.ambient_occlusion.reset();
    scene.bind(commands);
    bind_lighting(commands, unoccluded.lighting);
    draw_blended_objects(commands, scene,
                         {"", "diffuse.frag", drawing.store, gpu::TriangleWinding::none,
                          fragment_constants(scene, unoccluded)},
                         drawing, wanted, {nullptr, shown});
}

void draw_blended_distances(PassCommands& commands, const GpuScene& scene,
                            const DrawSettings& drawing, float alpha, const ObjectFilter& wanted,
                            std::span<const std::uint8_t> shown) {
    if (!scene.has_blended_surfaces()) return;
    gpu::RasterState state{"", "blended_distance.frag", drawing.store};
    state.constants.emplace_back("blended_alpha", alpha);
    state.keeps_colour = true;
    scene.bind(commands);
    for (const bool one_sided : {false, true}) {
        state.hidden = one_sided ? back_face_winding(scene.list_views()[drawing.first_view])
                                 : gpu::TriangleWinding::none;
        draw_objects(commands, scene, state, drawing.first_view, drawing.layers, {},
                     [&](std::size_t i) {
                         const DrawRange& range = scene.draw_ranges()[i];
                         return range.blended && range.one_sided == one_sided && wanted(i);
                     },
                     {nullptr, shown});
    }
}

} // namespace catoptric::render
