#include "render/passes.hpp"

#include "core/half.hpp"
#include "render/views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catoptric::render {

namespace {

using graph::Clear;
using graph::Commands;
using graph::Filter;
using graph::Image;
using graph::Tag;
using graph::Use;

constexpr Clear kBlack{0, 0, 0, 1};
constexpr Clear kFarthest{0, 0, 0, 0}; // reversed depth

/// How triangles that are seen from behind run in a view's picture: cube faces show it mirrored.
gpu::Winding turns_away(const shared::View& view) {
    return dot(glm::cross(view.right, view.down), view.forward) > 0
               ? gpu::Winding::clockwise
               : gpu::Winding::counterclockwise;
}

/// Push constants of placed.vert.
struct PlacedDraw {
    shared::Draw draw;
    shared::Placement placement;
};

/// One object in the layers whose view it may meet; neighbouring layers in one draw.
void draw_object(Commands& commands, const GpuScene& scene, std::size_t object,
                 std::uint32_t first_view, std::uint32_t layers, std::uint32_t mended = 0) {
    const DrawRange& range = scene.ranges()[object];
    shared::Draw draw = scene.draw_of(object, first_view);
    draw.mended = mended;
    if (range.own)
        commands.push(PlacedDraw{draw, scene.placement_of(object, first_view)});
    else
        commands.push(draw);
    scene.bind_vertices(commands, object);
    for (std::uint32_t layer = 0; layer < layers;) {
        std::uint32_t end = layer;
        while (end < layers && may_meet(scene.views()[first_view + end], range.bounds)) ++end;
        if (end > layer) commands.draw(range.first_index, range.index_count, layer, end - layer);
        layer = end + 1;
    }
}

/// The objects that are asked for, with these programs; those in spaces of their own come last.
template <typename Wanted>
void draw_objects(Commands& commands, const GpuScene& scene, gpu::RasterState state,
                  std::uint32_t first_view, std::uint32_t layers, std::uint32_t mended,
                  Wanted&& wanted) {
    for (const bool own : {false, true}) {
        if (own && !scene.has_own_spaces()) break;
        if (own) state.vertex = "placed.vert";
        commands.use(state);
        for (std::size_t i = 0; i < scene.ranges().size(); ++i)
            if (scene.ranges()[i].own.has_value() == own && wanted(i))
                draw_object(commands, scene, i, first_view, layers, mended);
    }
}

/// Everything that is no mirror, then the mirrors, except where `skip` says so. With `peeled`, the
/// distances of a first layer: only what lies behind them. `store`: how distances are kept, and
/// what else.
template <typename Skip>
void draw_scene(Commands& commands, const GpuScene& scene, std::uint32_t first_view,
                std::uint32_t layers, const Lighting& lighting, const MirrorLook& look,
                const gpu::Constants& store, std::optional<Image> peeled, Skip&& skip) {
    std::string diffuse = lighting.shadow_map ? "diffuse.frag" : "diffuse.frag#unshadowed",
                black = "mirror_black.frag";
    scene.bind(commands);
    if (look.mended) scene.bind_tracing(commands);
    if (lighting.shadow_map) commands.bind("shadow_map", *lighting.shadow_map, Filter::compare);
    if (peeled) {
        diffuse += lighting.shadow_map ? "#peel" : "_peel", black += "#peel";
        commands.bind("first_layer", *peeled);
    }
    const auto draw_diffuse = [&](bool one_sided, gpu::Winding hidden) {
        draw_objects(commands, scene, {"scene.vert", diffuse, store, hidden}, first_view, layers, 0,
                     [&](std::size_t i) {
                         const DrawRange& range = scene.ranges()[i];
                         return !range.mirror && range.one_sided == one_sided && !skip(i);
                     });
    };
    draw_diffuse(false, gpu::Winding::none);
    if (std::ranges::any_of(scene.ranges(), &DrawRange::one_sided))
        draw_diffuse(true, turns_away(scene.views()[first_view]));
    gpu::RasterState mirrors{"scene.vert", black, store};
    const auto is_black = [&](std::size_t object) {
        return first_view == GpuScene::kCameraView && scene.hides_all_from_camera(object);
    };
    if (look.cubes && !look.blank) {
        mirrors.fragment = look.fragment + (peeled                ? "#peel"
                                            : !look.mended        ? ""
                                            : lighting.shadow_map ? "#mend"
                                                                  : "#mend_unshadowed");
        mirrors.constants.insert(mirrors.constants.end(), look.constants.begin(),
                                 look.constants.end());
        commands.bind("colour_cubes", look.cubes->colour, Filter::linear);
        // The shader has the binding either way; without surfaces nothing reads it.
        commands.bind("surface_cubes", look.cubes->surfaces.value_or(look.cubes->colour),
                      Filter::nearest);
        if (look.cubes->distance) {
            commands.bind("distance_cubes", *look.cubes->distance, Filter::linear);
            commands.bind("distance_cubes_nearest", *look.cubes->distance, Filter::nearest);
        }
        for (const auto& [name, image] : look.images) commands.bind(name, image);
        for (const auto& [name, buffer] : look.buffers) commands.bind(name, buffer);
    }
    draw_objects(commands, scene, mirrors, first_view, layers, look.mended, [&](std::size_t i) {
        return scene.ranges()[i].mirror && !skip(i) && !is_black(i);
    });
    const auto is_shut = [&](std::size_t i) { return is_black(i) && !skip(i); };
    for (std::size_t i = 0; i < scene.ranges().size(); ++i)
        if (is_shut(i))
            return draw_objects(commands, scene, {"scene.vert", black, store}, first_view, layers,
                                0, is_shut);
}

void read_surroundings(graph::PassBuilder& pass, const Lighting& lighting, const MirrorLook& look) {
    if (lighting.shadow_map) pass.reads(*lighting.shadow_map, Use::sampled);
    if (!look.cubes) return;
    pass.reads(look.cubes->colour, Use::sampled);
    if (look.cubes->distance) pass.reads(*look.cubes->distance, Use::sampled);
    if (look.cubes->surfaces) pass.reads(*look.cubes->surfaces, Use::sampled);
    for (const auto& [name, image] : look.images) pass.reads(image, Use::sampled);
    for (const auto& [name, buffer] : look.buffers) pass.reads(buffer, Use::storage_read);
}

/// A mirror's six faces; with `peeled`, of what lies behind these distances.
void add_capture(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options,
                 std::uint32_t mirror, const std::string& pass_name, const Cubes& cubes,
                 std::optional<Image> peeled) {
    // "Nothing there" is +infinity; unorm8 has none, so there it is the end of the range.
    const float nothing = options.distance == Format::r8_unorm
                              ? 1.0f
                              : std::numeric_limits<float>::infinity();
    const std::string name = inputs.prefix + pass_name;
    const Image depth = graph.image(
        {name + ".depth", Format::d32f, options.face, options.face, 6, true});
    graph::PassBuilder pass = graph.pass(name, Tag::scene);
    read_surroundings(pass, options.lighting, options.look);
    if (peeled) pass.reads(*peeled, Use::sampled);
    pass.writes(cubes.colour, Use::colour, kBlack);
    if (cubes.distance) pass.writes(*cubes.distance, Use::colour, Clear{nothing, 0, 0, 0});
    if (cubes.surfaces) pass.writes(*cubes.surfaces, Use::colour, Clear{});
    gpu::Constants store{{"distance_scale", 1 / options.stored_unit}};
    if (options.colour == Format::rgba16f && options.saturates)
        store.emplace_back("largest_colour", kLargestHalf);
    if (cubes.surfaces) store.emplace_back("keeps_surface", 1u);
    if (peeled && options.distance == Format::r8_unorm) store.emplace_back("half_step", 0.5f / 255);
    pass.writes(depth, Use::depth, kFarthest)
        .layers(6)
        .record([&scene = inputs.scene, mirror, lighting = options.lighting, look = options.look,
                 store, leaves_out = options.leaves_out_spheres, peeled](Commands& commands) {
            draw_scene(commands, scene, scene.capture_view(mirror), 6, lighting, look, store,
                       peeled, [&](std::size_t object) {
                           const DrawRange& range = scene.ranges()[object];
                           return object == scene.mirror_object(mirror) ||
                                  (leaves_out && range.mirror && range.exact_sphere);
                       });
        });
}

/// The same look with causes of error taken away.
MirrorLook mended(MirrorLook look, const FrameInputs& inputs, const Lighting& lighting) {
    if (!inputs.mended) return look;
    look.mended = inputs.mended;
    inputs.scene.want_tracing();
    for (const auto& [name, value] : {std::pair{"picture_width", inputs.size.x},
                                      {"picture_height", inputs.size.y},
                                      {"max_depth", kReferenceDepth},
                                      {"shadow", lighting.shadow_map ? 1u : 0u},
                                      {"own_spaces", inputs.scene.has_own_spaces() ? 1u : 0u}})
        look.constants.emplace_back(name, value);
    return look;
}

} // namespace

std::optional<Image> add_shadow(graph::Graph& graph, const FrameInputs& inputs,
                                std::uint32_t edge) {
    const GpuScene& scene = inputs.scene;
    if (scene.light_count() == 0) return std::nullopt;
    const std::uint32_t faces = scene.shadow_faces();
    const Image map = graph.image(
        {inputs.prefix + "shadow_map", Format::d32f, edge, edge, faces * scene.light_count()});
    for (std::uint32_t light = 0; light < scene.light_count(); ++light) {
        const std::string name = scene.light_count() == 1 ? "shadow"
                                                          : "shadow/" + std::to_string(light + 1);
        graph.pass(inputs.prefix + name, Tag::scene)
            .writes(map.layers(faces * light, faces), Use::depth, kFarthest)
            .layers(faces)
            .record([&scene, light, faces](Commands& commands) {
                scene.bind(commands);
                draw_objects(commands, scene, {"scene.vert", "", {}}, scene.shadow_view(light),
                             faces, 0,
                             [&](std::size_t i) { return scene.ranges()[i].casts_shadow; });
            });
    }
    return map;
}

Cubes declare_cubes(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options) {
    const std::uint32_t layers = 6 * inputs.scene.mirror_count();
    const std::string name = inputs.prefix + options.name + "/cubes.";
    Cubes cubes;
    cubes.colour = graph.image(
        {name + "colour", options.colour, options.face, options.face, layers, true});
    if (options.distance)
        cubes.distance = graph.image(
            {name + "distance", *options.distance, options.face, options.face, layers, true});
    if (options.surfaces) {
        check(options.distance.has_value(), Failure::internal, "captures '", options.name,
              "' want surfaces, which follow the distance");
        cubes.surfaces = graph.image(
            {name + "surfaces", Format::rgba16f, options.face, options.face, layers, true});
    }
    if (options.second_layer) {
        check(options.distance.has_value(), Failure::internal, "captures '", options.name,
              "' want a second layer, which needs the distance of the first");
        cubes.colour2 = graph.image(
            {name + "colour2", options.colour, options.face, options.face, layers, true});
        cubes.distance2 = graph.image(
            {name + "distance2", *options.distance, options.face, options.face, layers, true});
    }
    return cubes;
}

void add_captures(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options,
                  const Cubes& cubes) {
    for (std::uint32_t mirror = 0; mirror < inputs.scene.mirror_count(); ++mirror) {
        const auto part_of = [&](std::optional<Image> image) {
            return image ? std::optional(image->layers(6 * mirror, 6)) : image;
        };
        const std::string number = "/" + std::to_string(mirror + 1);
        const Cubes first{
            *part_of(cubes.colour), part_of(cubes.distance), {}, {}, part_of(cubes.surfaces)};
        add_capture(graph, inputs, options, mirror, options.name + number, first, {});
        if (cubes.colour2)
            add_capture(graph, inputs, options, mirror, options.name + "2" + number,
                        {*part_of(cubes.colour2), part_of(cubes.distance2), {}, {}, {}},
                        first.distance);
    }
}

View add_view(graph::Graph& graph, const FrameInputs& inputs, const Lighting& lighting,
              const MirrorLook& look, bool with_lookup) {
    const uvec2 size = inputs.size;
    const Image hdr = graph.image({inputs.prefix + "hdr", Format::rgba32f, size.x, size.y});
    const Image depth = graph.image({inputs.prefix + "view.depth", Format::d32f, size.x, size.y});
    graph::PassBuilder pass = graph.pass(inputs.prefix + "view", Tag::scene);
    read_surroundings(pass, lighting, look);
    View view{hdr, {}};
    pass.writes(hdr, Use::colour, kBlack);
    if (with_lookup || inputs.with_lookup) {
        // Attachments have the locations of the shaders: the distance's, which nobody reads here,
        // then the lookup's.
        const Image distance = graph.image(
            {inputs.prefix + "view.distance", Format::r32f, size.x, size.y});
        view.lookup = graph.image({inputs.prefix + "lookup", Format::rgba32f, size.x, size.y});
        pass.writes(distance, Use::colour, Clear{}).writes(*view.lookup, Use::colour, Clear{});
    }
    pass.writes(depth, Use::depth, kFarthest)
        .record([&scene = inputs.scene, lighting,
                 look = mended(look, inputs, lighting)](Commands& commands) {
            draw_scene(commands, scene, GpuScene::kCameraView, 1, lighting, look, {}, {},
                       [&](std::size_t object) { return !scene.ranges()[object].seen_by_camera; });
        });
    return view;
}

Image add_compose(graph::Graph& graph, const FrameInputs& inputs, Image hdr,
                  double exposure_stops) {
    const uvec2 size = inputs.size;
    const Image picture = graph.image({inputs.prefix + "ldr", Format::rgba8_unorm, size.x, size.y});
    graph.pass(inputs.prefix + "compose")
        .reads(hdr, Use::storage_read)
        .writes(picture, Use::storage_write)
        .record([=](Commands& commands) {
            commands.use(gpu::ComputeState{"compose.comp", {}});
            commands.bind("hdr", hdr);
            commands.bind("picture", picture);
            commands.push(static_cast<float>(std::exp2(exposure_stops)));
            commands.dispatch((size.x + 7) / 8, (size.y + 7) / 8);
        });
    return picture;
}

} // namespace catoptric::render
