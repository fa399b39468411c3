// Passes that draw shadow maps, or those parts that have changed.
#include "core/content_hash.hpp"
#include "render/draw.hpp"
#include "render/pass_faces.hpp"
#include "render/passes.hpp"
#include "render/views.hpp"
#include "require/model.hpp"

#include <array>

namespace catoptric::render {

namespace {

using graph::ImageHandle;
using graph::PassCommands;
using graph::PassPurpose;
using graph::ResourceUse;

/// Returns the content hash of everything that a face of a light's shadow map may show, and of the
/// face's view.
std::uint64_t hash_shadow_face(const GpuScene& scene, const require::WorkModel& model,
                               std::uint32_t light, std::uint32_t face) {
    const require::LightRequirements& needs = model.lights[light];
    ContentHash content_hash;
    content_hash.add(needs.has_map);
    if (!needs.has_map || face >= scene.drawn_shadow_faces(light)) return content_hash.sum();
    const shared::View& view = scene.list_views()[scene.shadow_view(light) + face];
    content_hash.add(needs.content_hash).add(view);
    content_hash.add_values(std::span(scene.backdrops(light)));
    for (const require::ShadowCaster& caster : model.casters)
        if (may_show(view, scene.draw_ranges()[caster.object]))
            content_hash.add(caster.object).add(caster.content_hash);
    return content_hash.sum();
}

/// Declares a pass that draws a range of faces of a light's shadow map. Without a map, only clears
/// them to the farthest depth, so that nothing is in shadow.
void add_shadow_pass(graph::Graph& graph, const GpuScene& scene, std::uint32_t light,
                     const FaceRange& faces, bool has_map, const std::string& name,
                     ImageHandle part) {
    graph.add_pass(name, PassPurpose::scene)
        .writes(part, ResourceUse::depth, kClearFarthest)
        .layers(faces.count)
        .record([&scene, light, faces, has_map](PassCommands& commands) {
            const std::uint32_t drawn = scene.drawn_shadow_faces(light);
            if (!has_map || faces.first >= drawn) return;
            scene.bind(commands);
            for (const bool masked : {false, true})
                draw_without_back_faces(commands, scene, {"", masked ? "masked.frag" : "", {}},
                                        scene.shadow_view(light) + faces.first,
                                        std::min(faces.count, drawn - faces.first), {},
                                        [&](std::size_t i) {
                                            const DrawRange& range = scene.draw_ranges()[i];
                                            return range.casts_shadow && range.masked == masked &&
                                                   !scene.backdrops(light)[i];
                                        });
        });
}

} // namespace

std::optional<ImageHandle> add_shadows(graph::Graph& graph, const FrameInputs& inputs,
                                       std::uint32_t edge, const require::WorkModel& model,
                                       const std::string& suffix) {
    const GpuScene& scene = inputs.scene;
    if (scene.light_count() == 0) return std::nullopt;
    const std::uint32_t faces = scene.shadow_face_count();
    const graph::ImageDesc desc{inputs.prefix + "shadow_map" + suffix, TexelFormat::d32f, edge,
                                edge, faces * scene.light_count()};
    const ImageHandle map = model.is_everything ? graph.add_image(desc)
                                                : graph.add_persistent(desc);
    for (std::uint32_t light = 0; light < scene.light_count(); ++light) {
        const bool has_map = model.is_everything || model.lights[light].has_map;
        const std::string name = scene.light_count() == 1 ? "shadow"
                                                          : "shadow/" + std::to_string(light + 1);
        const auto part = [&](std::uint32_t first, std::uint32_t count) {
            return map.layers(faces * light + first, count);
        };
        std::array<std::uint64_t, 6> content_hashes{};
        for (std::uint32_t face = 0; face < faces && !model.is_everything; ++face)
            content_hashes[face] = hash_shadow_face(scene, model, light, face);
        const auto is_drawn = [&](std::uint32_t face) {
            return face < faces && (model.is_everything ||
                                    !graph.has_content_hash(part(face, 1), content_hashes[face]));
        };
        for_each_face_range(is_drawn, [&](std::uint32_t first, std::uint32_t end) {
            const FaceRange run{light, first, end - first};
            for (std::uint32_t face = first; face < end && !model.is_everything; ++face)
                graph.set_content_hash(part(face, 1), content_hashes[face]);
            const std::string text = run.count == faces ? name : face_range_name(name, run);
            add_shadow_pass(graph, scene, light, run, has_map, inputs.prefix + text + suffix,
                            part(first, run.count));
        });
    }
    return map;
}

ImageHandle add_glass_shadows(graph::Graph& graph, const FrameInputs& inputs,
                              ImageHandle shadow_map, std::uint32_t edge,
                              const std::string& suffix) {
    const GpuScene& scene = inputs.scene;
    check(scene.device().blends_floats(), Failure::no_device,
          "--glass-shadow tint: wanted a device that adds rgba32f colours and blends one "
          "attachment alone, found none of both; render with --glass-shadow none");
    const std::uint32_t faces = scene.shadow_face_count();
    const ImageHandle depths = graph.add_image({inputs.prefix + "glass_depths" + suffix,
                                                TexelFormat::rgba32f, edge, edge,
                                                faces * scene.light_count()});
    for (std::uint32_t light = 0; light < scene.light_count(); ++light) {
        const std::string name = scene.light_count() == 1
                                     ? "glass_shadow"
                                     : "glass_shadow/" + std::to_string(light + 1);
        graph.add_pass(inputs.prefix + name + suffix)
            .reads(shadow_map, ResourceUse::sampled)
            .writes(depths.layers(faces * light, faces), ResourceUse::colour, graph::ClearValue{})
            .layers(faces)
            .record([&scene, light, shadow_map](PassCommands& commands) {
                scene.bind(commands);
                commands.bind("shadow_depths", shadow_map, graph::TextureFilter::nearest);
                gpu::RasterState state{"", "glass_shadow.frag", {}};
                state.blending = gpu::Blending::sum;
                draw_objects(commands, scene, state, scene.shadow_view(light),
                             scene.drawn_shadow_faces(light), {},
                             [&](std::size_t i) { return scene.draw_ranges()[i].tints; });
            });
    }
    return depths;
}

} // namespace catoptric::render
