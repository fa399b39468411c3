// Measures pictures of a scene: whether raster and ray tracing agree, how much textures change, and
// how much luminance follows normals. Prints one line of JSON per camera of the scene.
//   catoptric_scenes SCENE [DIR]     DIR: also writes raster-N.png, rays-N.png and judged-N.png
// Called by ./dev scenes, which writes docs/scenes.md.
#include "core/error.hpp"
#include "measure/display.hpp"
#include "measure/picture_file.hpp"
#include "scene/material_facts.hpp"
#include "session/exposure.hpp"
#include "session/folders.hpp"
#include "session/resolved_scene.hpp"
#include "sight.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <limits>
#include <map>
#include <optional>

namespace {

using namespace catoptric;
using nlohmann::json;

constexpr uvec2 kJudgedPictureSize{128, 128};
constexpr float kOffPixelThreshold = .02f;
constexpr int kMinJudgedPixels = 32; // size of the smallest object judged on its own

session::Request make_camera_request(session::ResolvedScene& wanted, std::size_t camera) {
    session::Request request;
    request.size = kJudgedPictureSize;
    request.camera = camera < wanted.scene.cameras.size() ? wanted.scene.cameras[camera]
                                                          : session::choose_camera(wanted, 1);
    request.ambient = session::choose_ambient(wanted);
    const std::optional<double> exposure = session::find_exposure(wanted);
    request.exposure = exposure.value_or(0);
    request.auto_exposure = !exposure;
    request.scene = wanted.scene;
    return request;
}

measure::Picture render_picture(session::Session& session, const session::Request& request,
                                const std::string& technique) {
    session::FrameSpec spec = request;
    spec.techniques = {technique};
    return measure::apply_exposure(session.frame(spec).hdr(), request.exposure);
}

float largest_channel_difference(const vec3& a, const vec3& b) {
    return f32::largest_vector_component(abs(clamp(a, 0.0f, 1.0f) - clamp(b, 0.0f, 1.0f)));
}

/// Surfaces that the camera sees, at kRaysAlongPixelEdge x kRaysAlongPixelEdge places per pixel.
struct SurfacesSeenByCamera {
    uvec2 size;
    std::vector<scenes::SeenSurface> seen;
    const scenes::SeenSurface& surface_at(int x, int y) const {
        const ivec2 fine(size * scenes::kRaysAlongPixelEdge);
        return seen[std::size_t(std::clamp(y, 0, fine.y - 1)) * std::size_t(fine.x) +
                    std::size_t(std::clamp(x, 0, fine.x - 1))];
    }
    const scenes::SeenSurface& surface_at_pixel_centre(std::size_t pixel) const {
        return surface_at(
            int(pixel % size.x * scenes::kRaysAlongPixelEdge + scenes::kRaysAlongPixelEdge / 2),
            int(pixel / size.x * scenes::kRaysAlongPixelEdge + scenes::kRaysAlongPixelEdge / 2));
    }
};

/// Why a pixel is left out of the comparison of raster and ray tracing.
enum class PixelLeftOutReason { not_at_all, mirror, sharp, edge };

bool do_surfaces_differ(const scenes::SeenSurface& a, const scenes::SeenSurface& b, float pixel) {
    if (a.object != b.object || a.cut != b.cut || a.shadowed != b.shadowed ||
        a.texels != b.texels || a.sharp != b.sharp)
        return true;
    // Two places of one object count as different if neither lies near the plane of the other's
    // triangle. The object then has an outline between the places.
    return a.object >= 0 && std::min(std::abs(dot(a.facet, b.place - a.place)),
                                     std::abs(dot(b.facet, a.place - b.place))) > 2 * pixel;
}

PixelLeftOutReason find_left_out_reason(const SurfacesSeenByCamera& looked,
                                        const scenes::SceneSurfaceCaster& sight,
                                        const scene::Scene& scene, std::size_t pixel,
                                        bool leaves_sharp) {
    const scenes::SeenSurface& seen = looked.surface_at_pixel_centre(pixel);
    if (seen.object >= 0 && scene::is_mirror(scene, scene.objects[std::size_t(seen.object)]))
        return PixelLeftOutReason::mirror;
    if (leaves_sharp && seen.sharp) return PixelLeftOutReason::sharp;
    const int fine = int(scenes::kRaysAlongPixelEdge),
              x = int(pixel % looked.size.x) * fine + fine / 2,
              y = int(pixel / looked.size.x) * fine + fine / 2;
    const float width = sight.pixel_at(seen.distance);
    for (int down = -fine; down <= fine; ++down)
        for (int right = -fine; right <= fine; ++right)
            if (do_surfaces_differ(seen, looked.surface_at(x + right, y + down), width))
                return PixelLeftOutReason::edge;
    return PixelLeftOutReason::not_at_all;
}

/// Compares raster and ray tracing. Returns how many pixels show a surface, how many are left out
/// and why, and how many of the rest are off. `judged`, if given, becomes a picture: left-out
/// pixels grey, pixels that are off red, others black.
json measure_raster_agreement(const session::Request& request, const SurfacesSeenByCamera& looked,
                              const scenes::SceneSurfaceCaster& sight,
                              const measure::Picture& raster, const measure::Picture& rays,
                              bool leaves_sharp, measure::Picture* judged) {
    std::map<PixelLeftOutReason, int> counts;
    int off = 0, shown = 0, background_off = 0, edge_off = 0;
    for (std::size_t i = 0; i < rays.pixels.size(); ++i) {
        const bool is_surface = looked.surface_at_pixel_centre(i).object >= 0;
        const PixelLeftOutReason why = find_left_out_reason(looked, sight, request.scene, i,
                                                            leaves_sharp);
        shown += is_surface;
        counts[why] += is_surface;
        const bool differs = !(largest_channel_difference(raster.pixels[i], rays.pixels[i]) <=
                               kOffPixelThreshold),
                   is_off = differs && why == PixelLeftOutReason::not_at_all;
        edge_off += differs && is_surface && why == PixelLeftOutReason::edge;
        off += is_off && is_surface;
        background_off += is_off && !is_surface;
        if (judged)
            judged->pixels[i] = is_off ? vec3(1, 0, 0)
                                       : vec3(why == PixelLeftOutReason::not_at_all ? 0 : .3f);
    }
    return {{"shown", shown},
            {"judged", counts[PixelLeftOutReason::not_at_all]},
            {"mirror", counts[PixelLeftOutReason::mirror]},
            {"sharp", counts[PixelLeftOutReason::sharp]},
            {"edge", counts[PixelLeftOutReason::edge]},
            {"edge_off", edge_off},
            {"off", off},
            {"background_off", background_off}};
}

/// Returns the pixels of each object that covers at least kMinJudgedPixels pixels.
std::map<int, std::vector<std::size_t>> list_pixels_of_objects(const SurfacesSeenByCamera& looked) {
    std::map<int, std::vector<std::size_t>> pixels;
    for (std::size_t i = 0; i < std::size_t{looked.size.x} * looked.size.y; ++i)
        if (looked.surface_at_pixel_centre(i).object >= 0)
            pixels[looked.surface_at_pixel_centre(i).object].push_back(i);
    std::erase_if(pixels, [](const auto& entry) { return entry.second.size() < kMinJudgedPixels; });
    return pixels;
}

/// Returns the standard deviation of the visible texels of a texture, 0 to 1, of the channel that
/// varies most.
float deviation_of_texels(const SurfacesSeenByCamera& looked,
                          const std::vector<std::size_t>& pixels) {
    dvec3 sum(0), squares(0);
    for (const std::size_t i : pixels) {
        const dvec3 texel(looked.surface_at_pixel_centre(i).texel);
        sum += texel, squares += texel * texel;
    }
    const double n = double(pixels.size());
    const dvec3 variance = squares / n - sum / n * (sum / n);
    return float(std::sqrt(std::max({0.0, variance.x, variance.y, variance.z})));
}

/// Returns the scene with each base-colour texture replaced by its mean colour. Alpha stays.
scene::Scene replace_textures_by_mean(scene::Scene scene) {
    for (scene::Material& material : scene.materials) {
        if (!material.albedo_texture) continue;
        scene::Image image = *material.albedo_texture->image;
        std::uint64_t sum[3] = {};
        for (const std::uint32_t texel : image.texels)
            for (int k = 0; k < 3; ++k) sum[k] += texel >> 8 * k & 255;
        std::uint32_t mean = 0;
        for (int k = 0; k < 3; ++k)
            mean |= std::uint32_t((sum[k] + image.texels.size() / 2) / image.texels.size())
                    << 8 * k;
        for (std::uint32_t& texel : image.texels) texel = (texel & 0xff000000) | mean;
        material.albedo_texture->image = std::make_shared<scene::Image>(std::move(image));
    }
    return scene;
}

float luminance_of_colour(const vec3& colour) { return dot(colour, vec3(.2126f, .7152f, .0722f)); }

/// Returns how far luminance varies over an object's normals: (most - least) / most, of means over
/// similar normals. Returns nothing if no two normals are 30 degrees apart or if the object is
/// black.
std::optional<float> variation_over_normals(const measure::Picture& picture,
                                            const SurfacesSeenByCamera& looked,
                                            const std::vector<std::size_t>& pixels) {
    struct RunningMean {
        vec3 normal{0};
        float luminance = 0, count = 0;
    };
    std::map<std::array<int, 3>, RunningMean> directions;
    for (const std::size_t i : pixels) {
        const vec3 n = looked.surface_at_pixel_centre(i).normal, rounded = glm::round(n * 4.0f);
        RunningMean& sum = directions[{int(rounded.x), int(rounded.y), int(rounded.z)}];
        sum.normal += n, sum.luminance += luminance_of_colour(picture.pixels[i]), sum.count += 1;
    }
    constexpr float kMinFacingCosine = .866f;
    std::erase_if(directions, [](const auto& entry) { return entry.second.count < 4; });
    float least = std::numeric_limits<float>::infinity(), most = 0, nearest = 1;
    for (const auto& entry : directions) {
        const RunningMean& sum = entry.second;
        least = std::min(least, sum.luminance / sum.count);
        most = std::max(most, sum.luminance / sum.count);
        for (const auto& other : directions)
            nearest = std::min(nearest, dot(normalize(sum.normal), normalize(other.second.normal)));
    }
    constexpr float kBlackThreshold = 1.0f / 255;
    if (nearest > kMinFacingCosine || most < kBlackThreshold) return {};
    return (most - least) / most;
}

/// Returns two figures for each object: the share of pixels that its texture changes, and how far
/// luminance varies over its normals.
json measure_object_surfaces(const session::Request& request, const SurfacesSeenByCamera& looked,
                             const measure::Picture& rays, const measure::Picture& plain_rays) {
    json textures = json::array(), lit = json::array();
    for (const auto& [number, pixels] : list_pixels_of_objects(looked)) {
        const scene::Object& object = request.scene.objects[std::size_t(number)];
        const scene::Material& material = request.scene.materials[object.material];
        if (scene::is_mirror(request.scene, object)) continue;
        const float varies = material.albedo_texture ? deviation_of_texels(looked, pixels) : 0;
        if (varies > 8.0f / 255) {
            const auto changed = std::ranges::count_if(pixels, [&](std::size_t i) {
                return largest_channel_difference(rays.pixels[i], plain_rays.pixels[i]) >
                       1.0f / 255;
            });
            textures.push_back({{"object", object.name},
                                {"pixels", pixels.size()},
                                {"deviation", varies * 255},
                                {"changed", double(changed) / double(pixels.size())}});
        }
        const auto over_normals = variation_over_normals(plain_rays, looked, pixels);
        if (!material.unlit && !scene::is_visibly_emissive(material) && over_normals)
            lit.push_back(
                {{"object", object.name}, {"pixels", pixels.size()}, {"variation", *over_normals}});
    }
    return {{"textures", textures}, {"lit", lit}};
}

/// Returns the scene without vertex colours. After `replace_textures_by_mean`, each surface then
/// has one colour.
scene::Scene remove_vertex_colours(scene::Scene scene) {
    for (scene::Mesh& mesh : scene.meshes) mesh.colours.clear();
    return scene;
}

void write_picture(const measure::Picture& picture, const std::string& folder, const char* name,
                   std::size_t camera) {
    if (folder.empty()) return;
    measure::write_png(measure::to_display(picture),
                       folder + "/" + name + "-" + std::to_string(camera) + ".png");
}

constexpr const char* kRasterTechnique = "naive:bounces=0";
constexpr const char* kRayTracingTechnique = "raytrace";

json measure_view_of_camera(session::Engine& engine, const std::string& name, std::size_t camera,
                            const std::string& folder) {
    session::ResolvedScene wanted = session::resolve_scene(name, {});
    session::Request request = make_camera_request(wanted, camera);
    session::Session session(engine, request.scene);
    session::resolve_exposure(session, request);
    const measure::Picture raster = render_picture(session, request, kRasterTechnique),
                           rays = render_picture(session, request, kRayTracingTechnique);
    const scenes::SceneSurfaceCaster sight(request);
    const SurfacesSeenByCamera looked{request.size, sight.find_surfaces_seen_by_camera()};
    measure::Picture judged(int(kJudgedPictureSize.x), int(kJudgedPictureSize.y));
    json line = {{"scene", name}, {"camera", request.camera.name}, {"exposure", request.exposure}};
    line["agreement"] = measure_raster_agreement(request, looked, sight, raster, rays, true,
                                                 &judged);
    write_picture(raster, folder, "raster", camera), write_picture(rays, folder, "rays", camera);
    write_picture(judged, folder, "judged", camera);

    session::Request flat = request;
    flat.scene = remove_vertex_colours(replace_textures_by_mean(request.scene));
    session::Session flat_session(engine, flat.scene);
    line.update(measure_object_surfaces(request, looked, rays,
                                        render_picture(flat_session, flat, kRayTracingTechnique)));

    session::ResolvedScene smooth = session::resolve_scene(
        name, {.overrides = {.dielectric_mirrors = true}});
    session::Request with = make_camera_request(smooth, camera);
    with.exposure = request.exposure;
    session::Session with_session(engine, with.scene);
    const scenes::SceneSurfaceCaster with_sight(with);
    line["agreement_dielectric_mirrors"] = measure_raster_agreement(
        with, {with.size, with_sight.find_surfaces_seen_by_camera()}, with_sight,
        render_picture(with_session, with, kRasterTechnique),
        render_picture(with_session, with, kRayTracingTechnique), false, nullptr);
    return line;
}

} // namespace

int main(int argc, char** argv) try {
    if (argc < 2) fail(Failure::usage, "catoptric_scenes SCENE [DIR]");
    session::Engine engine({.cache = session::find_cache_folder()});
    const std::string folder = argc > 2 ? argv[2] : "";
    const std::size_t cameras = std::max<std::size_t>(
        1, session::resolve_scene(argv[1], {}).scene.cameras.size());
    for (std::size_t i = 0; i < cameras; ++i)
        std::puts(measure_view_of_camera(engine, argv[1], i, folder).dump().c_str());
    return 0;
} catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return int(error.failure);
}
