#include "require/world.hpp"

#include "require/reach.hpp"
#include "require/world_content_hashes.hpp"
#include "scene/light.hpp"
#include "scene/light_kind.hpp"
#include "scene/material_facts.hpp"
#include "scene/rough_reflectors.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::require {

namespace {

MeshShape make_mesh_shape(const scene::Mesh& mesh) {
    MeshShape facts;
    for (const uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; ++i) facts.box.add(mesh.positions[triangle[i]]);
    const dvec3 middle = facts.box.centre();
    for (const uvec3& triangle : mesh.triangles)
        for (int i = 0; i < 3; ++i)
            facts.radius = std::max(facts.radius, length(mesh.positions[triangle[i]] - middle));
    facts.content_hash = hash_mesh(mesh);
    facts.quads = find_convex_quads(mesh);
    facts.flat_normal = find_flat_normal(mesh);
    return facts;
}

Bounds<double> transform_bounds(const Bounds<double>& box, const dmat4& place) {
    Bounds<double> result;
    if (!box.empty())
        for (const dvec3& corner : box_corners(box))
            result.add(scene::transform_point(place, corner));
    return result;
}

/// Returns a bound on how much the matrix stretches lengths. The spectral norm is at most the root
/// of the largest row sum of M^T M.
double max_stretch(const dmat3& m) {
    const dmat3 square = transpose(m) * m;
    double most = 0;
    for (int i = 0; i < 3; ++i)
        most = std::max(most,
                        std::abs(square[i].x) + std::abs(square[i].y) + std::abs(square[i].z));
    return std::sqrt(most);
}

Bounds<double> translate_bounds(const Bounds<double>& box, const dvec3& offset) {
    return {box.lo + offset, box.hi + offset};
}

bool are_equal_spheres(const std::optional<scene::Sphere>& a,
                       const std::optional<scene::Sphere>& b) {
    if (a.has_value() != b.has_value()) return false;
    return !a || (a->centre == b->centre && a->radius == b->radius);
}

bool can_be_wall(const scene::Material& material, bool is_mirror) {
    // A lamp is invisible from behind, but the order of its triangles' corners does not tell which
    // side is behind. A lamp is therefore no wall.
    return !scene::has_alpha_mask(material) && !scene::is_glass(material) &&
           (is_mirror || material.front_only || !scene::is_one_sided(material)) &&
           scene::emitted_radiance(material) == vec3(0);
}

} // namespace

VisibilityScene::VisibilityScene(const scene::Scene& rest) {
    for (const scene::Mesh& mesh : rest.meshes) meshes_.push_back(make_mesh_shape(mesh));
    things_.resize(rest.objects.size());
    for (std::size_t i = 0; i < things_.size(); ++i)
        things_[i].is_mover = !std::holds_alternative<std::monostate>(rest.objects[i].motion);
    set_layout(rest);
}

void VisibilityScene::set_layout(const scene::Scene& now) {
    ++layout_version_;
    materials_ = now.materials, environment_ = now.environment, punctual_ = now.punctual;
    materials_stamp_ = hash_materials(now.materials);
    environment_stamp_ = hash_environment(now.environment.get());
    things_.resize(now.objects.size());
    mirrors_ = scene::mirrors(now), movers_.clear(), still_ = {};
    for (std::size_t i = 0; i < things_.size(); ++i) {
        const scene::Object& object = now.objects[i];
        VisibilityObject& thing = things_[i];
        thing.mesh = object.mesh, thing.material = object.material;
        thing.rest = object.world_from_object;
        thing.seen_by_camera = object.seen_by_camera;
        thing.is_mirror = scene::is_mirror(now, object);
        thing.is_glass = scene::is_glass(now.materials[object.material]);
        thing.has_lobe = thing.is_mirror && scene::may_reflect_by_lobe(now, object);
        thing.casts_shadow = scene::emitted_radiance(now.materials[object.material]) == vec3(0) &&
                             (!thing.is_glass || now.tints_glass_shadows);
        thing.tight_rest = scene::bounds(now, object);
        if (thing.is_mover)
            movers_.push_back(i);
        else
            still_.add(thing.tight_rest);
    }
    const Bounds<double> around = still_.empty() ? scene::bounds(now) : still_;
    const dvec3 extent = around.empty() ? dvec3(0) : around.extent();
    middle_ = around.empty() ? dvec3(0) : around.centre();
    rounding_ = kPositionRoundingError * std::max({extent.x, extent.y, extent.z});
    for (std::size_t i = 0; i < things_.size(); ++i) move_object(now, i);
    lights_ = scene::list_lights(now);
    find_walls();
    update_static_hash();
}

/// Returns whether the scene is the one that was laid out, except for where movers are.
bool VisibilityScene::has_same_layout(const scene::Scene& now) const {
    if (now.objects.size() != things_.size() || now.environment != environment_ ||
        now.materials != materials_ || now.punctual.size() != punctual_.size())
        return false;
    for (std::size_t i = 0; i < things_.size(); ++i) {
        const scene::Object& object = now.objects[i];
        const VisibilityObject& thing = things_[i];
        if (object.mesh != thing.mesh || object.material != thing.material ||
            object.seen_by_camera != thing.seen_by_camera ||
            scene::is_mirror(now, object) != thing.is_mirror ||
            (!thing.is_mover && object.world_from_object != thing.rest))
            return false;
    }
    return true;
}

void VisibilityScene::move_object(const scene::Scene& now, std::size_t index) {
    const scene::Object& object = now.objects[index];
    VisibilityObject& thing = things_[index];
    thing.place = object.world_from_object, thing.sphere = object.sphere;
    const bool is_shifted = dmat3(thing.place) == dmat3(thing.rest);
    thing.tight = is_shifted        ? translate_bounds(thing.tight_rest,
                                                       dvec3(thing.place[3]) - dvec3(thing.rest[3]))
                  : thing.is_mirror ? scene::bounds(now, object) // the capture's centre is the
                                                                 // centre of the mirror's bounds
                                    : transform_bounds(meshes_[thing.mesh].box, thing.place);
    // The device stores positions as floats relative to the middle of the scene.
    const dvec3 away = thing.tight.empty() ? dvec3(0) : abs(thing.tight.centre() - middle_);
    const double room = rounding_ + kPositionRoundingError * std::max({away.x, away.y, away.z});
    thing.box = {thing.tight.lo - room, thing.tight.hi + room};
    const MeshShape& mesh = meshes_[thing.mesh];
    if (!mesh.box.empty()) thing.middle = scene::transform_point(thing.place, mesh.box.centre());
    thing.radius = mesh.radius * max_stretch(dmat3(thing.place)) + 2 * room;
    ContentHash content_hash;
    content_hash.add(index)
        .add(meshes_[thing.mesh].content_hash)
        .add(thing.material)
        .add(thing.place);
    if (thing.sphere) content_hash.add(thing.sphere->centre).add(thing.sphere->radius);
    thing.content_hash = content_hash.sum();
}

void VisibilityScene::update(const scene::Scene& now) {
    has_changed_ = false;
    if (!has_same_layout(now)) {
        for (std::size_t i = 0; i < std::min(things_.size(), now.objects.size()); ++i)
            if (now.objects[i].world_from_object != things_[i].rest) things_[i].is_mover = true;
        set_layout(now);
        for (VisibilityObject& thing : things_) thing.has_moved = thing.is_mover;
        has_changed_ = true;
        return;
    }
    bool lights_moved = !std::ranges::equal(punctual_, now.punctual, scene::have_equal_emission);
    for (const std::size_t mover : movers_) {
        VisibilityObject& thing = things_[mover];
        const scene::Object& object = now.objects[mover];
        thing.has_moved = object.world_from_object != thing.place ||
                          !are_equal_spheres(object.sphere, thing.sphere);
        if (!thing.has_moved) continue;
        move_object(now, mover);
        has_changed_ = true;
        lights_moved = lights_moved || !thing.casts_shadow;
    }
    if (!lights_moved) return;
    punctual_ = now.punctual;
    lights_ = scene::list_lights(now);
    update_static_hash();
    has_changed_ = true;
}

void VisibilityScene::find_walls() {
    walls_.clear();
    const auto keep_largest = [&] { // keeps the first of equal walls
        std::ranges::stable_sort(walls_, std::ranges::greater(), &Wall::area);
        if (walls_.size() > kMaxWalls) walls_.resize(kMaxWalls);
    };
    const double extent = rounding_ / kPositionRoundingError,
                 least = kMinWallAreaShare * extent * extent;
    for (std::size_t i = 0; i < things_.size(); ++i) {
        const VisibilityObject& thing = things_[i];
        const scene::Material& material = materials_[thing.material];
        if (thing.is_mover || !can_be_wall(material, thing.is_mirror)) continue;
        for (QuadCorners quad : meshes_[thing.mesh].quads) {
            for (dvec3& corner : quad) corner = scene::transform_point(thing.rest, corner);
            Wall wall = make_wall(quad, i);
            wall.front_only = material.front_only && !thing.is_mirror;
            wall.seen_by_camera = thing.seen_by_camera;
            if (wall.area > 0 && wall.area >= least) walls_.push_back(wall);
        }
        if (walls_.size() >= 8 * kMaxWalls) keep_largest();
    }
    keep_largest();
}

void VisibilityScene::update_static_hash() {
    ContentHash content_hash;
    content_hash.add(materials_stamp_).add(environment_stamp_).add(things_.size());
    for (const VisibilityObject& thing : things_)
        content_hash.add(thing.is_mover ? 0 : thing.content_hash);
    for (const scene::PointLight& light : lights_) content_hash.add(hash_point_light(light));
    static_hash_ = content_hash.sum();
}

} // namespace catoptric::require
