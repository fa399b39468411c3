// Checks a scene that was made in memory, as loaders check a file.
#include "scene/check.hpp"

#include "core/text.hpp"
#include "scene/light_kind.hpp"
#include "scene/material_facts.hpp"
#include "scene/motion.hpp"
#include "scene/repair.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace catoptric::scene {

namespace {

constexpr float kUnitLengthTolerance = 1e-3f; ///< far above the rounding of a normalised float
constexpr double kMaxSceneCoordinate = 1e150;

/// Part of a scene for messages. Its text is made only for a message.
class ScenePlace {
public:
    ScenePlace(const Scene& scene, const char* list, std::size_t index, const std::string& name)
        : scene_(scene), list_(list), index_(index), name_(name) {}

    /// Throws `bad_data` with the place and the parts unless `ok`.
    template <typename... Parts>
    void require(bool ok, const Parts&... parts) const {
        if (!ok)
            fail(Failure::bad_data, "scene ", quote(scene_.name), ": ", list_, "[", index_, "] ",
                 quote(name_), ": ", parts...);
    }
    void require_index(std::size_t index, std::size_t count, const char* member,
                       const char* list) const {
        require(index < count, member, ": wanted an index into the ", count, " ", list, ", found ",
                index);
    }
    template <typename Value>
    void require_finite(const Value& value, const char* member) const;

private:
    const Scene& scene_;
    const char* list_;
    std::size_t index_;
    const std::string& name_;
};

bool is_finite_value(double value) { return std::isfinite(value); }
template <int length, typename Number>
bool is_finite_value(const glm::vec<length, Number>& vector) {
    for (int i = 0; i < length; ++i)
        if (!std::isfinite(vector[i])) return false;
    return true;
}
template <int columns, int rows, typename Number>
bool is_finite_value(const glm::mat<columns, rows, Number>& matrix) {
    for (int i = 0; i < columns; ++i)
        if (!is_finite_value(matrix[i])) return false;
    return true;
}

template <typename Value>
void ScenePlace::require_finite(const Value& value, const char* member) const {
    require(is_finite_value(value), member, ": wanted finite numbers, found NaN or infinity");
}

bool is_affine(const dmat4& matrix) {
    return matrix[0][3] == 0 && matrix[1][3] == 0 && matrix[2][3] == 0 && matrix[3][3] == 1;
}

void check_transform(const ScenePlace& place, const dmat4& matrix, const char* member) {
    place.require_finite(matrix, member);
    place.require(is_affine(matrix), member,
                  ": wanted an affine transform, whose last row is 0 0 0 1, found another");
}

template <typename List>
void check_size(const ScenePlace& place, const List& list, std::size_t wanted, const char* member) {
    place.require(list.size() == wanted, member, ": wanted one for each of the ", wanted,
                  " positions, found ", list.size());
}

void check_mesh(const ScenePlace& place, const Mesh& mesh) {
    const std::size_t count = mesh.positions.size();
    check_size(place, mesh.normals, count, "normals");
    for (const auto& uv : mesh.uv)
        if (!uv.empty()) check_size(place, uv, count, "texture coordinates");
    if (!mesh.colours.empty()) check_size(place, mesh.colours, count, "colours");
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int corner = 0; corner < 3; ++corner)
            place.require(mesh.triangles[i][corner] < count, "triangle ", i,
                          ": wanted an index below the ", count, " positions, found ",
                          mesh.triangles[i][corner]);
    for (std::size_t i = 0; i < count; ++i) {
        const dvec3& position = mesh.positions[i];
        place.require(is_finite_value(position) &&
                          all(lessThanEqual(glm::abs(position), dvec3(kMaxSceneCoordinate))),
                      "position ", i, ": wanted finite coordinates up to ", kMaxSceneCoordinate,
                      ", found ", position.x, " ", position.y, " ", position.z);
        const vec3& normal = mesh.normals[i];
        // The comparison is written so that NaN fails.
        place.require(std::abs(glm::length(normal) - 1) <= kUnitLengthTolerance, "normal ", i,
                      ": wanted unit length, found ", normal.x, " ", normal.y, " ", normal.z);
    }
    for (const auto& uv : mesh.uv)
        for (const vec2& coordinates : uv) place.require_finite(coordinates, "texture coordinates");
    for (const vec4& colour : mesh.colours) place.require_finite(colour, "colours");
}

void check_texture(const ScenePlace& place, const std::optional<Texture>& texture,
                   const char* member) {
    if (!texture) return;
    place.require(texture->image != nullptr, member, ": wanted an image, found none");
    const Image& image = *texture->image;
    const std::size_t texels = std::size_t(image.size.x) * image.size.y;
    place.require(texels > 0 && image.texels.size() == texels, member,
                  ": wanted an image of at least 1x1 with a texel for each pixel, found ",
                  image.size.x, "x", image.size.y, " with ", image.texels.size(), " texels");
    place.require_index(texture->uv_set, std::tuple_size_v<decltype(Mesh::uv)>, member,
                        "texture spaces");
    place.require_finite(texture->u_row, member);
    place.require_finite(texture->v_row, member);
}

/// Throws unless a number lies in [low, high].
template <typename Number>
void check_range(const ScenePlace& place, Number value, Number low, Number high,
                 const char* member) {
    place.require(value >= low && value <= high, member, ": wanted a number of ", low, " to ", high,
                  ", found ", value);
}

void check_colour(const ScenePlace& place, const vec3& colour, const char* member) {
    for (int i = 0; i < 3; ++i) check_range(place, colour[i], 0.f, 1.f, member);
}

void check_radiance(const ScenePlace& place, const vec3& radiance, const char* member) {
    place.require(is_valid_radiance(radiance), member,
                  ": wanted finite numbers of at least 0, found ", radiance.x, " ", radiance.y, " ",
                  radiance.z);
}

void check_material(const ScenePlace& place, const Material& material) {
    check_colour(place, material.albedo, "albedo");
    check_colour(place, material.reflectance, "reflectance");
    check_radiance(place, material.emission, "emission");
    if (material.light) check_radiance(place, *material.light, "light");
    check_radiance(place, material.dielectric_f0, "dielectric_f0");
    check_radiance(place, material.dielectric_f90, "dielectric_f90");
    place.require(material.absorption.x >= 0 && material.absorption.y >= 0 &&
                      material.absorption.z >= 0,
                  "absorption: wanted numbers of at least 0");
    check_range(place, material.metallic, 0.f, 1.f, "metallic");
    check_range(place, material.roughness, 0.f, 1.f, "roughness");
    check_range(place, material.clearcoat, 0.f, 1.f, "clearcoat");
    check_range(place, material.clearcoat_roughness, 0.f, 1.f, "clearcoat_roughness");
    check_range(place, material.transmission, 0.f, 1.f, "transmission");
    check_range(place, material.alpha, 0.f, 1.f, "alpha");
    place.require_finite(material.alpha_cutoff, "alpha_cutoff");
    place.require_finite(material.normal_scale, "normal_scale");
    place.require(std::isfinite(material.ior) && material.ior > 0,
                  "ior: wanted a finite number above 0, found ", material.ior);
    place.require(std::isfinite(material.dispersion) && material.dispersion >= 0,
                  "dispersion: wanted a finite number of at least 0, found ", material.dispersion);
    check_texture(place, material.albedo_texture, "albedo_texture");
    check_texture(place, material.emission_texture, "emission_texture");
    check_texture(place, material.roughness_texture, "roughness_texture");
    check_texture(place, material.normal_texture, "normal_texture");
}

template <typename Value>
void check_track(const ScenePlace& place, const Track<Value>& track) {
    const std::size_t count = track.times.size();
    const std::size_t tangents = track.interpolation == Interpolation::cubic ? count : 0;
    place.require(track.values.size() == count && track.in_tangents.size() == tangents &&
                      track.out_tangents.size() == tangents,
                  "motion: wanted a value for each of the ", count,
                  " times, and tangents only if the interpolation is cubic, found ",
                  track.values.size(), " values and ", track.in_tangents.size(), " and ",
                  track.out_tangents.size(), " tangents");
    for (std::size_t i = 0; i < count; ++i)
        place.require(std::isfinite(track.times[i]) &&
                          (i == 0 || track.times[i] > track.times[i - 1]),
                      "motion: wanted increasing times, found ", track.times[i], " at key ", i);
    for (const auto* values : {&track.values, &track.in_tangents, &track.out_tangents})
        for (const Value& value : *values) place.require_finite(value, "motion");
}

void check_motion(const ScenePlace& place, const std::monostate&) { static_cast<void>(place); }
void check_motion(const ScenePlace& place, const HarmonicMotion& motion) {
    place.require_finite(motion.amplitude, "motion");
    place.require(std::isfinite(motion.period) && motion.period > 0,
                  "motion: wanted a period above 0 seconds, found ", motion.period);
}
void check_motion(const ScenePlace& place, const Keyframes& motion) {
    if (motion.keys) check_track(place, *motion.keys);
    place.require_finite(motion.world_from_keys, "motion");
    place.require_finite(motion.rest, "motion");
}
void check_motion(const ScenePlace& place, const RigAttachment& motion) {
    if (motion.rig)
        place.require_index(motion.node, motion.rig->nodes.size(), "motion", "nodes of its rig");
    check_transform(place, motion.node_from_object, "motion");
}
void check_motion(const ScenePlace& place, const Motion& motion) {
    std::visit([&](const auto& kind) { check_motion(place, kind); }, motion);
}

void check_object(const ScenePlace& place, const Scene& scene, const Object& object) {
    place.require_index(object.mesh, scene.meshes.size(), "mesh", "meshes");
    place.require_index(object.material, scene.materials.size(), "material", "materials");
    check_transform(place, object.world_from_object, "world_from_object");
    check_motion(place, object.motion);
    if (!object.sphere) return;
    place.require_finite(object.sphere->centre, "sphere");
    place.require(std::isfinite(object.sphere->radius) && object.sphere->radius >= 0,
                  "sphere: wanted a finite radius of at least 0, found ", object.sphere->radius);
}

void check_light(const ScenePlace& place, const PunctualLight& light) {
    place.require(std::ranges::find(light_kinds(), light.kind, &LightKind::id) !=
                      light_kinds().end(),
                  "kind: wanted one of the ", light_kinds().size(),
                  " kinds of lights, found number ", static_cast<int>(light.kind));
    check_radiance(place, light.intensity, "intensity");
    place.require(light.range > 0, "range: wanted a number above 0, found ", light.range);
    check_range(place, light.cos_inner, -1.0, 1.0, "cos_inner");
    check_range(place, light.cos_outer, -1.0, 1.0, "cos_outer");
    check_transform(place, light.world_from_light, "world_from_light");
    check_motion(place, light.motion);
}

void check_environment(const ScenePlace& place, const Environment& environment) {
    place.require(std::isfinite(environment.scale) && environment.scale >= 0,
                  "scale: wanted a finite number of at least 0, found ", environment.scale);
    place.require_finite(environment.rotation_degrees, "rotation_degrees");
    if (environment.studio) return;
    const std::size_t texels = std::size_t(environment.size.x) * environment.size.y;
    place.require(texels > 0 && environment.texels.size() == texels,
                  "wanted a picture of at least 1x1 with a texel for each pixel, found ",
                  environment.size.x, "x", environment.size.y, " with ", environment.texels.size(),
                  " texels");
    for (const vec3& texel : environment.texels) check_radiance(place, texel, "texels");
}

} // namespace

void check_scene(const Scene& scene) {
    for (std::size_t i = 0; i < scene.meshes.size(); ++i)
        check_mesh({scene, "meshes", i, scene.meshes[i].name}, scene.meshes[i]);
    for (std::size_t i = 0; i < scene.materials.size(); ++i)
        check_material(scene, i, scene.materials[i]);
    for (std::size_t i = 0; i < scene.objects.size(); ++i)
        check_object({scene, "objects", i, scene.objects[i].name}, scene, scene.objects[i]);
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        check_camera(scene.cameras[i],
                     "scene " + quote(scene.name) + ": cameras[" + std::to_string(i) + "]",
                     Failure::bad_data);
    for (std::size_t i = 0; i < scene.punctual.size(); ++i)
        check_light({scene, "punctual", i, scene.punctual[i].name}, scene.punctual[i]);
    if (scene.environment)
        check_environment({scene, "environment", 0, scene.environment->name}, *scene.environment);
    const ScenePlace whole(scene, "settings", 0, scene.name);
    check_range(whole, scene.mirror_max_roughness, 0.f, 1.f, "mirror_max_roughness");
    whole.require(scene.light_samples >= 1, "light_samples: wanted at least 1, found ",
                  scene.light_samples);
    whole.require(scene.environment_shadows >= 0, "environment_shadows: wanted at least 0, found ",
                  scene.environment_shadows);
    if (scene.exposure) whole.require_finite(*scene.exposure, "exposure");
}

void check_material(const Scene& scene, std::size_t index, const Material& material) {
    check_material({scene, "materials", index, material.name}, material);
}

void check_camera(const Camera& camera, const std::string& where, Failure failure) {
    const auto require = [&](bool ok, const char* wanted) {
        check(ok, failure, where, ": camera ", quote(camera.name), ": wanted ", wanted,
              ", found eye ", camera.eye.x, " ", camera.eye.y, " ", camera.eye.z, ", target ",
              camera.target.x, " ", camera.target.y, " ", camera.target.z, ", ",
              camera.vertical_fov_degrees, " degrees, height ", camera.orthographic_height);
    };
    require(is_finite_value(camera.eye) && is_finite_value(camera.target) &&
                is_finite_value(camera.up),
            "finite eye, target and up");
    require(camera.eye != camera.target, "a target away from the eye");
    require(glm::length(glm::cross(camera.target - camera.eye, camera.up)) > 0,
            "an upward direction beside that to the target");
    require(camera.orthographic_height >= 0 && std::isfinite(camera.orthographic_height),
            "a finite height of at least 0");
    require(camera.orthographic_height > 0 ||
                (camera.vertical_fov_degrees > 0 && camera.vertical_fov_degrees < 180),
            "a field of view between 0 and 180 degrees");
}

} // namespace catoptric::scene
