#include "render/passes.hpp"

#include "core/half.hpp"
#include "core/stamp.hpp"
#include "render/draw.hpp"
#include "render/face_area.hpp"
#include "render/views.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace catoptric::render {

namespace {

using graph::Clear;
using graph::Commands;
using graph::Image;
using graph::Tag;
using graph::Use;

constexpr Clear kBlack{0, 0, 0, 1};
constexpr Clear kFarthest{0, 0, 0, 0}; // reversed depth

/// Neighbouring faces of a mirror's capture, or of a light's shadow map.
struct Faces {
    std::uint32_t owner = 0, first = 0, count = 6;
};

/// Of all six, or "NAME.FIRST-LAST".
std::string name_of(const std::string& name, const Faces& faces) {
    if (faces.count == 6) return name;
    return name + "." + std::to_string(faces.first + 1) + "-" +
           std::to_string(faces.first + faces.count);
}

/// They are cleared; with an area within it, and keep what is around it.
void write_cubes(graph::PassBuilder& pass, const CaptureOptions& options, const Cubes& cubes,
                 const std::optional<graph::Area>& area = {}) {
    // "Nothing there" is +infinity; unorm8 has none, so there it is the end of the range.
    const float nothing = options.distance == Format::r8_unorm
                              ? 1.0f
                              : std::numeric_limits<float>::infinity();
    const auto write = [&](Image image, const Clear& clear) {
        area ? pass.updates(image, Use::colour, clear) : pass.writes(image, Use::colour, clear);
    };
    write(cubes.colour, kBlack);
    if (cubes.distance) write(*cubes.distance, Clear{nothing, 0, 0, 0});
    if (cubes.surfaces) write(*cubes.surfaces, Clear{});
    if (area) pass.area(*area);
}

/// Whether the part shows some of the object.
bool may_show(const GpuScene& scene, std::uint32_t mirror, std::uint32_t face,
              const require::FacePart& part, std::size_t object) {
    return part.is_whole() ||
           !common(part, part_with(scene.views()[scene.capture_view(mirror) + face],
                                   static_cast<int>(face), scene.ranges()[object].bounds))
                .empty();
}

/// Faces of a mirror; with `peeled`, of what lies behind these distances.
void add_capture(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options,
                 const Faces& faces, const std::string& pass_name, const Cubes& cubes,
                 const std::shared_ptr<const Looks>& looks, std::optional<Image> peeled,
                 const require::FacePart& changing) {
    const std::string name = inputs.prefix + pass_name;
    const Image depth = graph.image(
        {name + ".depth", Format::d32f, options.face, options.face, faces.count, faces.count == 6});
    graph::PassBuilder pass = graph.pass(name, Tag::scene);
    read_surroundings(pass, options.lighting, *looks);
    if (peeled) pass.reads(*peeled, Use::sampled);
    const require::FacePart part = in_texels(changing, options.face);
    write_cubes(pass, options, cubes, area_of(part, options.face));
    Drawing drawing{.first_view = inputs.scene.capture_view(faces.owner) + faces.first,
                    .layers = faces.count,
                    .lighting = options.lighting,
                    .looks = looks,
                    .store = {{"distance_scale", 1 / options.stored_unit}},
                    .peeled = peeled};
    if (options.colour == Format::rgba16f && options.saturates)
        drawing.store.emplace_back("largest_colour", kLargestHalf);
    if (cubes.surfaces) drawing.store.emplace_back("keeps_surface", 1u);
    if (peeled && options.distance == Format::r8_unorm)
        drawing.store.emplace_back("half_step", 0.5f / 255);
    pass.writes(depth, Use::depth, kFarthest)
        .layers(faces.count)
        .record([&scene = inputs.scene, mirror = faces.owner, face = faces.first, part,
                 drawing = std::move(drawing),
                 leaves_out = options.leaves_out_spheres](Commands& commands) {
            draw_scene(commands, scene, drawing, [&](std::size_t object) {
                const DrawRange& range = scene.ranges()[object];
                return object != scene.mirror_object(mirror) &&
                       !(leaves_out && range.mirror && range.exact_sphere && !range.lit) &&
                       may_show(scene, mirror, face, part, object);
            });
            if (!drawing.peeled)
                draw_sky(commands, scene, drawing.first_view, drawing.layers, drawing.store);
        });
}

/// Faces that nobody looks at hold nothing.
void add_clear(graph::Graph& graph, const FrameInputs& inputs, const CaptureOptions& options,
               const Faces& faces, const std::string& name, const Cubes& cubes) {
    graph::PassBuilder pass = graph.pass(inputs.prefix + name_of(name, faces) + ".clear");
    write_cubes(pass, options, cubes);
    if (cubes.colour2)
        write_cubes(pass, options, {cubes.face, *cubes.colour2, cubes.distance2, {}, {}, {}});
    pass.layers(faces.count).record([](Commands&) {});
}

/// Of what a face of a light's shadow map may show, and of the view that it is drawn with.
std::uint64_t shadow_stamp(const GpuScene& scene, const require::Model& model, std::uint32_t light,
                           std::uint32_t face) {
    const require::LightNeeds& needs = model.lights[light];
    Stamp stamp;
    stamp.add(needs.has_map);
    if (!needs.has_map || face >= scene.drawn_shadow_faces(light)) return stamp.value();
    const shared::View& view = scene.views()[scene.shadow_view(light) + face];
    stamp.add(needs.stamp).add(view);
    stamp.add_all(std::span(scene.backdrops(light)));
    for (const require::Caster& caster : model.casters)
        if (may_meet(view, scene.ranges()[caster.object]))
            stamp.add(caster.object).add(caster.stamp);
    return stamp.value();
}

/// Neighbouring faces of a light's shadow map; without a map nothing is nearer than what is lit.
void add_shadow_faces(graph::Graph& graph, const GpuScene& scene, std::uint32_t light,
                      const Faces& faces, bool has_map, const std::string& name, Image part) {
    graph.pass(name, Tag::scene)
        .writes(part, Use::depth, kFarthest)
        .layers(faces.count)
        .record([&scene, light, faces, has_map](Commands& commands) {
            const std::uint32_t drawn = scene.drawn_shadow_faces(light);
            if (!has_map || faces.first >= drawn) return;
            scene.bind(commands);
            for (const bool masked : {false, true})
                draw_fronts(commands, scene, {"", masked ? "masked.frag" : "", {}},
                            scene.shadow_view(light) + faces.first,
                            std::min(faces.count, drawn - faces.first), 0, [&](std::size_t i) {
                                const DrawRange& range = scene.ranges()[i];
                                return range.casts_shadow && range.masked == masked &&
                                       !scene.backdrops(light)[i];
                            });
        });
}

/// The same looks with causes of error taken away.
Looks mended(Looks looks, const FrameInputs& inputs, const Lighting& lighting) {
    if (!inputs.mended) return looks;
    inputs.scene.want_tracing();
    for (MirrorLook& look : looks.looks) {
        if (!look.captures) continue;
        look.mended = inputs.mended;
        for (const auto& [name, value] : {std::pair{"picture_width", inputs.size.x},
                                          {"picture_height", inputs.size.y},
                                          {"max_depth", kReferenceDepth},
                                          {"shadow", lighting.shadow_map ? 1u : 0u}})
            look.constants.emplace_back(name, value);
    }
    return looks;
}

} // namespace

std::optional<Image> add_shadow(graph::Graph& graph, const FrameInputs& inputs, std::uint32_t edge,
                                const require::Model& model, const std::string& suffix) {
    const GpuScene& scene = inputs.scene;
    if (scene.light_count() == 0) return std::nullopt;
    const std::uint32_t faces = scene.shadow_faces();
    const graph::ImageDesc desc{inputs.prefix + "shadow_map" + suffix, Format::d32f, edge, edge,
                                faces * scene.light_count()};
    const Image map = model.is_everything ? graph.image(desc) : graph.kept(desc);
    for (std::uint32_t light = 0; light < scene.light_count(); ++light) {
        const bool has_map = model.is_everything || model.lights[light].has_map;
        const std::string name = scene.light_count() == 1 ? "shadow"
                                                          : "shadow/" + std::to_string(light + 1);
        const auto part = [&](std::uint32_t first, std::uint32_t count) {
            return map.layers(faces * light + first, count);
        };
        std::array<std::uint64_t, 6> stamps{};
        for (std::uint32_t face = 0; face < faces && !model.is_everything; ++face)
            stamps[face] = shadow_stamp(scene, model, light, face);
        const auto is_drawn = [&](std::uint32_t face) {
            return face < faces &&
                   (model.is_everything || !graph.holds(part(face, 1), stamps[face]));
        };
        for_each_run(is_drawn, [&](std::uint32_t first, std::uint32_t end) {
            const Faces run{light, first, end - first};
            for (std::uint32_t face = first; face < end && !model.is_everything; ++face)
                graph.made_from(part(face, 1), stamps[face]);
            const std::string text = run.count == faces ? name : name_of(name, run);
            add_shadow_faces(graph, scene, light, run, has_map, inputs.prefix + text + suffix,
                             part(first, run.count));
        });
    }
    return map;
}

void add_captures(graph::Graph& graph, const FrameInputs& inputs, const Captures& captures,
                  Looks looks, const CaptureWork& work) {
    const auto shared = std::make_shared<const Looks>(std::move(looks));
    for (std::uint32_t mirror = 0; mirror < captures.options.size(); ++mirror) {
        if (!captures.places[mirror].exists()) continue;
        const auto& [array, cube] = captures.places[mirror];
        const CaptureOptions& options = captures.options[mirror];
        const std::string number = "/" + std::to_string(mirror + 1);
        const auto draw = [&, first_layer = 6 * cube, &cubes = captures.arrays[array]](
                              std::uint32_t first, std::uint32_t end) {
            const Faces faces{mirror, first, end - first};
            const require::FacePart changing = work.part(mirror, first);
            const Cubes part = part_of(cubes, first_layer + first, faces.count);
            const Cubes front{part.face, part.colour, part.distance, {}, {}, part.surfaces};
            add_capture(graph, inputs, options, faces, name_of(captures.name + number, faces),
                        front, shared, {}, changing);
            if (part.colour2)
                add_capture(
                    graph, inputs, options, faces, name_of(captures.name + "2" + number, faces),
                    {part.face, *part.colour2, part.distance2, {}, {}, {}}, shared, part.distance,
                    changing);
        };
        const auto clear = [&, first_layer = 6 * cube, &cubes = captures.arrays[array]](
                               std::uint32_t first, std::uint32_t end) {
            add_clear(graph, inputs, options, {mirror, first, end - first}, captures.name + number,
                      part_of(cubes, first_layer + first, end - first));
        };
        for_each_run(
            [&](std::uint32_t face) {
                return work.is_drawn(mirror, face) && work.part(mirror, face).is_whole();
            },
            draw);
        for (std::uint32_t face = 0; face < 6; ++face)
            if (!work.part(mirror, face).is_whole()) draw(face, face + 1);
        for_each_run([&](std::uint32_t face) { return work.of(mirror, face) == FaceWork::clear; },
                     clear);
    }
}

View add_view(graph::Graph& graph, const FrameInputs& inputs, const Lighting& lighting, Looks looks,
              bool is_traced) {
    const uvec2 size = inputs.size;
    const Image hdr = graph.image({inputs.prefix + "hdr", Format::rgba32f, size.x, size.y});
    const Image depth = graph.image({inputs.prefix + "view.depth", Format::d32f, size.x, size.y});
    graph::PassBuilder pass = graph.pass(inputs.prefix + "view", Tag::scene);
    read_surroundings(pass, lighting, looks);
    View view{hdr, {}, {}};
    pass.writes(hdr, Use::colour, kBlack);
    if (is_traced || inputs.with_lookup) {
        // Attachments have the locations of the shaders: the distance's, where views keep who
        // traces, then the lookup's.
        view.tracers = graph.image({inputs.prefix + "view.tracers", Format::r32f, size.x, size.y});
        view.lookup = graph.image({inputs.prefix + "lookup", Format::rgba32f, size.x, size.y});
        pass.writes(*view.tracers, Use::colour, Clear{}).writes(*view.lookup, Use::colour, Clear{});
    }
    Drawing drawing{
        .first_view = GpuScene::kCameraView,
        .layers = 1,
        .lighting = lighting,
        .looks = std::make_shared<const Looks>(mended(std::move(looks), inputs, lighting)),
        .store = {},
        .peeled = {}};
    if (is_traced) drawing.store.emplace_back("distance_scale", 0.0f);
    pass.writes(depth, Use::depth, kFarthest)
        .record([&scene = inputs.scene, drawing = std::move(drawing)](Commands& commands) {
            draw_scene(commands, scene, drawing,
                       [&](std::size_t object) { return scene.ranges()[object].seen_by_camera; });
            draw_sky(commands, scene, drawing.first_view, drawing.layers, drawing.store);
        });
    return view;
}

Image add_mirrored_view(graph::Graph& graph, const FrameInputs& inputs, const std::string& name,
                        const MirroredView& view, std::uint32_t number, const Lighting& lighting,
                        Looks looks) {
    const uvec2 size = inputs.size;
    const Image hdr = graph.image({inputs.prefix + name, Format::rgba32f, size.x, size.y});
    const Image depth = graph.image(
        {inputs.prefix + name + ".depth", Format::d32f, size.x, size.y});
    graph::PassBuilder pass = graph.pass(inputs.prefix + name, Tag::scene);
    read_surroundings(pass, lighting, looks);
    const Drawing drawing{.first_view = number,
                          .layers = 1,
                          .lighting = lighting,
                          .looks = std::make_shared<const Looks>(std::move(looks)),
                          .store = {},
                          .peeled = {}};
    pass.writes(hdr, Use::colour, kBlack)
        .writes(depth, Use::depth, kFarthest)
        .area(view.area)
        .record([&scene = inputs.scene, drawing, view, size](Commands& commands) {
            const std::size_t mirror = scene.mirror_object(view.mirror);
            draw_scene(commands, scene, drawing, [&](std::size_t object) {
                return object != mirror && may_meet(view, size, scene.ranges()[object].bounds);
            });
            draw_sky(commands, scene, drawing.first_view, drawing.layers, drawing.store);
        });
    return hdr;
}

Image add_compose(graph::Graph& graph, const FrameInputs& inputs, Image hdr,
                  double exposure_stops) {
    const uvec2 size = inputs.size;
    const Image picture = graph.image({inputs.prefix + "ldr", Format::rgba8_unorm, size.x, size.y});
    graph.pass(inputs.prefix + "compose")
        .reads(hdr, Use::sampled)
        .writes(picture, Use::colour, kBlack)
        .record([=](Commands& commands) {
            commands.use(gpu::RasterState{"screen.vert", "compose.frag", {}});
            commands.bind("hdr", hdr);
            commands.push(static_cast<float>(std::exp2(exposure_stops)));
            commands.cover();
        });
    return picture;
}

} // namespace catoptric::render
