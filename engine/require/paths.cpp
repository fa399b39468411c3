#include "require/paths.hpp"

#include "bvh/closest_hit.hpp"
#include "bvh/copies.hpp"
#include "scene/capture_centre.hpp"
#include "scene/material_facts.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace catoptric::require {

namespace {

/// The scene's triangles relative to the eye, with the normals of their corners.
class PathTracer {
public:
    explicit PathTracer(const WorkModelInput& input)
        : mirror_numbers_(input.now.objects.size(), 0) {
        const scene::Scene& now = input.now;
        std::uint32_t mirrors = 0;
        for (const std::size_t object : scene::mirrors(now)) mirror_numbers_[object] = ++mirrors;
        for (const dvec3& centre : scene::capture_centres(now))
            centres_.emplace_back(centre - input.camera.eye);
        std::vector<bvh::Triangle> triangles;
        for (std::size_t i = 0; i < now.objects.size(); ++i) add_object(input, i, triangles);
        tree_ = bvh::build(triangles, {}, bvh::CopyScope::across_objects);
    }

    struct TracedPath {
        std::vector<std::uint32_t> mirrors; ///< in the order in which the ray meets them, from 0
        std::vector<bool>
            /// For each mirror on the path, whether its capture does not show what the ray meets
            /// next.
            is_hidden;
        /// Nodes that each ray visits: the ray from the eye, the rays that leave surfaces sharply,
        /// and then those that leave rough surfaces.
        std::vector<std::size_t> nodes;
        std::size_t sharp = 0; ///< rays that leave surfaces sharply
    };
    /// Follows a ray from mirror to mirror, and then through other surfaces that reflect sharply.
    /// Rays that leave rough surfaces are followed if `follows_rough` is true, as if these
    /// reflected sharply.
    TracedPath follow(f32::Ray ray, bool follows_rough) const {
        TracedPath path;
        auto hit = find_hit(ray, bvh::kHiddenFromCameraFlag | bvh::kOneSidedFlag, path);
        while (hit && mirror_numbers_[hit->object] > 0 &&
               path.mirrors.size() < kMaxMirrorsPerPath) {
            const std::uint32_t mirror = mirror_numbers_[hit->object] - 1;
            path.mirrors.push_back(mirror);
            ray = reflect_ray(ray, *hit);
            hit = find_hit(ray, bvh::kOneSidedFlag, path);
            path.is_hidden.push_back(!does_capture_show(mirror, ray, hit));
        }
        path.sharp = path.mirrors.size();
        bool is_sharp = true;
        while (hit && path.nodes.size() <= kMaxMirrorsPerPath) {
            const SurfaceReflection kind = reflections_[hit->object];
            is_sharp = is_sharp && kind == SurfaceReflection::sharp;
            if (kind == SurfaceReflection::none || (!is_sharp && !follows_rough)) break;
            ray = reflect_ray(ray, *hit);
            hit = find_hit(ray, bvh::kOneSidedFlag, path);
            path.sharp += is_sharp ? 1 : 0;
        }
        return path;
    }

private:
    enum class SurfaceReflection : std::uint8_t { none, sharp, rough };

    /// Returns how the ray tracer reflects rays at an object, if lobes are traced. Textures of the
    /// roughness are ignored.
    static SurfaceReflection find_reflection(const scene::Material& material, bool is_mirror) {
        if (!scene::has_specular(material))
            return is_mirror ? SurfaceReflection::sharp : SurfaceReflection::none;
        return material.roughness <= shared::kMaxSharpRoughness ? SurfaceReflection::sharp
                                                                : SurfaceReflection::rough;
    }

    std::optional<bvh::RayHit<float>> find_hit(const f32::Ray& ray, std::uint32_t skipped,
                                               TracedPath& path) const {
        bvh::TraversalCounters steps;
        auto hit = bvh::find_closest_hit<float>(tree_, ray, kUnlimitedDistance, skipped, &steps);
        path.nodes.push_back(steps.nodes);
        return hit;
    }

    void add_object(const WorkModelInput& input, std::size_t index,
                    std::vector<bvh::Triangle>& triangles) {
        const scene::Object& object = input.now.objects[index];
        const scene::Mesh& mesh = input.now.meshes[object.mesh];
        const scene::Material& material = input.now.materials[object.material];
        const bool is_mirror = mirror_numbers_[index] > 0;
        const SurfaceReflection reflection = find_reflection(material, is_mirror);
        reflections_.push_back(reflection);
        const std::uint32_t flags = (object.seen_by_camera ? 0 : bvh::kHiddenFromCameraFlag) |
                                    (!is_mirror && scene::is_one_sided(material)
                                         ? bvh::kOneSidedFlag
                                         : 0);
        const dmat3 turns = scene::normal_matrix(object.world_from_object);
        const auto place = [&](std::uint32_t i) {
            return vec3(scene::transform_point(object.world_from_object, mesh.positions[i]) -
                        input.camera.eye);
        };
        for (const uvec3& t : mesh.triangles) {
            triangles.push_back(
                {place(t.x), place(t.y), place(t.z), static_cast<std::uint32_t>(index), flags});
            if (reflection == SurfaceReflection::none) continue;
            normals_.resize(3 * triangles.size(), vec3(0));
            for (int k = 0; k < 3; ++k)
                normals_[3 * (triangles.size() - 1) + static_cast<std::size_t>(k)] = vec3(
                    scene::transform_normal(turns, dvec3(mesh.normals[t[k]])));
        }
    }

    f32::Ray reflect_ray(const f32::Ray& ray, const bvh::RayHit<float>& hit) const {
        const vec4* corner = &tree_.triangles[3 * std::size_t{hit.place}];
        const vec3 a(corner[0]), b(corner[1]), c(corner[2]), w = hit.barycentric;
        const vec3* normals = &normals_[3 * std::size_t{hit.triangle}];
        vec3 error;
        const vec3 point = f32::triangle_hit_point(a, b, c, w, error),
                   facet = f32::facet_normal(a, b, c),
                   normal = normalize(w.x * normals[0] + w.y * normals[1] + w.z * normals[2]),
                   direction = f32::reflect_above_facet(ray.direction, normal, facet);
        return {f32::ray_spawn_origin(point, error, facet, direction), direction, hit.triangle + 1};
    }

    /// Returns whether the mirror's capture shows the point that the ray met. Also returns true if
    /// the ray met nothing. A capture does not show its own mirror.
    bool does_capture_show(std::uint32_t mirror, const f32::Ray& ray,
                           const std::optional<bvh::RayHit<float>>& met) const {
        constexpr int kMaxOwnTriangles =
            64; // most of the mirror's own triangles that the ray passes
        constexpr float kShortenedRayFactor = 1 - 0x1p-10f;
        if (met && mirror_numbers_[met->object] == mirror + 1) return false;
        const vec3 centre = centres_[mirror],
                   way = met ? ray.origin + met->t * ray.direction - centre : ray.direction;
        float left = met ? length(way) * kShortenedRayFactor : kUnlimitedDistance;
        f32::Ray from{centre, normalize(way), 0};
        for (int i = 0; i < kMaxOwnTriangles; ++i) {
            const auto hit = bvh::find_closest_hit<float>(tree_, from, left, bvh::kOneSidedFlag);
            if (!hit) return true;
            if (mirror_numbers_[hit->object] != mirror + 1) return false;
            from.origin += hit->t * from.direction;
            from.leaves = hit->triangle + 1;
            if (met) left -= hit->t;
        }
        return false;
    }

    static constexpr float kUnlimitedDistance = std::numeric_limits<float>::max();
    std::vector<vec3> centres_; ///< centres of the mirrors' captures
    std::vector<std::uint32_t>
        mirror_numbers_; ///< mirror number of each object, from 1; 0: no mirror
    std::vector<SurfaceReflection> reflections_;
    std::vector<vec3> normals_; ///< three per triangle, up to the last reflecting triangle
    bvh::Bvh tree_;
};

/// Returns the size of the picture, or of a grid of the same shape with at most kMaxMirrorPaths
/// cells.
uvec2 choose_ray_grid(uvec2 size) {
    const double pixels = 1.0 * size.x * size.y,
                 scale = std::min(1.0, std::sqrt(static_cast<double>(kMaxMirrorPaths) / pixels));
    return max(uvec2(1), uvec2(dvec2(size) * scale));
}

/// Sums up the rays of a picture, of which groups of kLanesOfRays neighbours walk together.
class RaySums {
public:
    /// `step`: pixels from one path to the next. A group then has fewer paths.
    RaySums(PathCounts& paths, double step)
        : paths_(paths),
          group_paths_(static_cast<std::uint32_t>(std::max(1.0, kLanesOfRays / step))) {}

    /// Adds the rays of the next pixel: the camera's, those that leave surfaces sharply, and those
    /// that leave rough surfaces, which stand for kRowsPerRoughRow rows.
    void add_path(const std::vector<std::size_t>& nodes, std::size_t sharp) {
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            const bool is_rough = i > sharp;
            WalkedRays& counts = is_rough ? paths_.rough : i > 0 ? paths_.sharp : paths_.camera;
            const double weight = is_rough ? kRowsPerRoughRow : 1;
            counts.rays += weight;
            counts.nodes += weight * static_cast<double>(nodes[i]);
            if (!is_rough) most_nodes_.at(i) = std::max(most_nodes_.at(i), nodes[i]);
        }
        if (++count_ == group_paths_) end_group();
    }
    void end_group() {
        const double groups = 1.0 * group_paths_ / kLanesOfRays; // that this group stands for
        for (std::size_t i = 0; i < most_nodes_.size(); ++i)
            (i > 0 ? paths_.sharp : paths_.camera).node_lanes += groups * static_cast<double>(
                                                                              most_nodes_[i]);
        most_nodes_ = {};
        count_ = 0;
    }

private:
    PathCounts& paths_;
    std::array<std::size_t, kMaxMirrorsPerPath + 1> most_nodes_{}; ///< of each ray in the group
    std::uint32_t group_paths_ = kLanesOfRays, count_ = 0;
};

} // namespace

std::size_t PathCounts::on_mirrors() const {
    return std::accumulate(first.begin(), first.end(), std::size_t{0});
}

PathCounts trace_paths(const WorkModelInput& input) {
    const scene::Camera& camera = input.camera;
    const std::size_t mirrors = scene::mirrors(input.now).size();
    const PathTracer stage(input);
    const uvec2 grid = choose_ray_grid(input.size);
    const dvec3 forward = normalize(camera.target - camera.eye),
                right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const bool is_parallel = camera.orthographic_height > 0;
    const double half = is_parallel ? camera.orthographic_height / 2
                                    : std::tan(glm::radians(camera.vertical_fov_degrees) / 2),
                 aspect = 1.0 * input.size.x / input.size.y;
    PathCounts paths{.first = std::vector<std::size_t>(mirrors),
                     .reached = std::vector<std::size_t>(mirrors),
                     .hidden = std::vector<std::size_t>(mirrors)};
    RaySums sums(paths, 1.0 * input.size.x / grid.x);
    for (std::uint32_t y = 0; y < grid.y; ++y) {
        for (std::uint32_t x = 0; x < grid.x; ++x, ++paths.count) {
            const dvec2 at = (dvec2(x, y) + .5) / dvec2(grid) * 2.0 - 1.0;
            const dvec3 aside = half * (aspect * at.x * right - at.y * up);
            const f32::Ray ray = is_parallel
                                     ? f32::Ray{vec3(aside), vec3(forward), 0}
                                     : f32::Ray{vec3(0), vec3(normalize(forward + aside)), 0};
            auto [met, is_hidden, nodes, sharp] = stage.follow(ray, y % kRowsPerRoughRow == 0);
            sums.add_path(nodes, sharp);
            if (met.empty()) continue;
            ++paths.first[met.front()];
            paths.hidden[met.front()] += std::ranges::find(is_hidden, true) != is_hidden.end();
            for (std::vector<std::uint32_t> begin = met; !begin.empty(); begin.pop_back()) {
                ++paths.through[begin];
                if (is_hidden[begin.size() - 1]) ++paths.hidden_after[begin];
            }
            std::ranges::sort(met);
            met.erase(std::ranges::unique(met).begin(), met.end());
            for (const std::uint32_t mirror : met) ++paths.reached[mirror];
        }
        sums.end_group();
    }
    return paths;
}

} // namespace catoptric::require
