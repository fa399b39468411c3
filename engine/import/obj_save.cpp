// Writes a scene as .obj. A mirror is illum 3 with Ks, glass is illum 7, and a light is Ke. Camera,
// motion and exact spheres are comments that begin with `# catoptric` (obj_text.hpp).
#include "core/file.hpp"
#include "import/load.hpp"
#include "scene/material_facts.hpp"
#include "scene/motion.hpp"
#include "scene/number.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <set>

namespace catoptric::scene {

namespace {

std::string format_vector(const vec3& v) {
    return format_number(v.x) + " " + format_number(v.y) + " " + format_number(v.z);
}
std::string format_vector(const dvec3& v) {
    return format_number(v.x) + " " + format_number(v.y) + " " + format_number(v.z);
}

/// Returns a unique word for a name. Spaces become '_', an empty name becomes `fallback`, and a
/// second "x" becomes "x-2".
std::string unique_word(std::string name, const std::string& fallback,
                        std::set<std::string>& taken) {
    std::ranges::replace_if(
        name, [](unsigned char c) { return c <= ' ' || c == '#' || c == '\\'; }, '_');
    if (name.empty()) name = fallback;
    std::string word = name;
    for (int n = 2; !taken.insert(word).second; ++n) word = name + "-" + std::to_string(n);
    return word;
}

template <typename Item>
std::vector<std::string> unique_words(const std::vector<Item>& items, const std::string& fallback) {
    std::set<std::string> taken;
    std::vector<std::string> names;
    for (const Item& item : items) names.push_back(unique_word(item.name, fallback, taken));
    return names;
}

std::string motion_comment(const std::monostate&) { return {}; }

/// Returns no motion. .obj has no nodes, so an object that follows one keeps its place at time 0.
std::string motion_comment(const RigAttachment&) { return {}; }

std::string motion_comment(const HarmonicMotion& motion) {
    return "harmonic " + format_vector(motion.amplitude) + " " + format_number(motion.period);
}

std::string motion_comment(const Keyframes& frames) {
    using enum TranslationTrack::Interpolation;
    const TranslationTrack keys = keys_in_world(frames);
    const bool is_cubic = keys.interpolation == cubic;
    std::string text = is_cubic ? "cubic " : keys.interpolation == linear ? "linear " : "step ";
    text += std::to_string(keys.times.size());
    for (std::size_t i = 0; i < keys.times.size(); ++i) {
        text += " " + format_number(keys.times[i]);
        if (is_cubic) text += " " + format_vector(keys.in_tangents[i]);
        text += " " + format_vector(keys.values[i]);
        if (is_cubic) text += " " + format_vector(keys.out_tangents[i]);
    }
    return text;
}

std::string object_comments(const Object& object, const std::string& name) {
    std::string text;
    const std::string motion = std::visit([](const auto& its) { return motion_comment(its); },
                                          object.motion);
    if (!motion.empty()) text += "# catoptric motion " + name + " " + motion + "\n";
    if (object.sphere)
        text += "# catoptric sphere " + name + " " + format_vector(object.sphere->centre) + " " +
                format_number(object.sphere->radius) + "\n";
    if (!object.seen_by_camera) text += "# catoptric hidden " + name + "\n";
    return text;
}

std::string camera_comment(const Camera& camera, const std::string& name) {
    return "# catoptric camera " + name + " " + format_vector(camera.eye) + " " +
           format_vector(camera.target) + " " + format_vector(camera.up) + " " +
           format_number(camera.vertical_fov_degrees) +
           (camera.orthographic_height > 0 ? " " + format_number(camera.orthographic_height) : "") +
           "\n";
}

/// Returns the vertices, in world space, and the faces of a mesh. `first` counts the vertices
/// written so far.
std::string format_geometry(const Mesh& mesh, const dmat4& world_from_object, std::size_t& first) {
    std::string text;
    for (const dvec3& position : mesh.positions)
        text += "v " + format_vector(transform_point(world_from_object, position)) + "\n";
    const dmat3 normal_to_world = normal_matrix(world_from_object);
    for (const vec3& normal : mesh.normals)
        text += "vn " + format_vector(vec3(normalized_or_zero(normal_to_world * dvec3(normal)))) +
                "\n";
    for (const uvec3& triangle : mesh.triangles) {
        text += "f";
        for (int corner = 0; corner < 3; ++corner) {
            const std::string index = std::to_string(first + triangle[corner] + 1);
            text += " " + index + "//" + index;
        }
        text += "\n";
    }
    first += mesh.positions.size();
    return text;
}

std::string format_library(const std::vector<Material>& materials,
                           const std::vector<std::string>& names) {
    std::string text = "# written by catoptric\n";
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const Material& material = materials[i];
        text += "\nnewmtl " + names[i] + "\nKd " + format_vector(material.albedo) + "\n";
        if (material.mirror) text += "Ks " + format_vector(material.reflectance) + "\n";
        if (material.emission != vec3(0)) text += "Ke " + format_vector(material.emission) + "\n";
        if (material.blended && !is_glass(material))
            text += "d " + format_number(material.alpha) + "\n";
        if (has_clear_coat(material))
            text += "Pc " + format_number(material.clearcoat) + "\nPcr " +
                    format_number(material.clearcoat_roughness) + "\n";
        if (is_glass(material)) text += "Ni " + format_number(material.ior) + "\n";
        text += material.mirror ? "illum 3\n" : is_glass(material) ? "illum 7\n" : "illum 1\n";
        const bool is_lamp = material.emission != vec3(0);
        if (is_lamp && material.two_sided) text += "# catoptric two_sided\n";
        if (!is_lamp && !material.two_sided) text += "# catoptric fixed_normals\n";
    }
    return text;
}

} // namespace

void save_obj(const Scene& scene, const std::filesystem::path& path) {
    check_scene(scene);
    const std::vector<std::string> object_names = unique_words(scene.objects, "object");
    const std::vector<std::string> material_names = unique_words(scene.materials, "material");
    const std::vector<std::string> camera_names = unique_words(scene.cameras, "camera");
    std::filesystem::path library = path;
    library.replace_extension(".mtl");

    std::string text = "# catoptric's comment lines hold what .obj has no word for\nmtllib " +
                       library.filename().string() + "\n";
    if (scene.exposure) text += "# catoptric exposure " + format_number(*scene.exposure) + "\n";
    for (std::size_t i = 0; i < scene.cameras.size(); ++i)
        text += camera_comment(scene.cameras[i], camera_names[i]);
    std::size_t first = 0;
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const Object& object = scene.objects[i];
        text += "\no " + object_names[i] + "\nusemtl " + material_names[object.material] + "\n" +
                object_comments(object, object_names[i]) +
                format_geometry(scene.meshes[object.mesh], object.world_from_object, first);
    }
    // The library is written first, because the .obj needs it.
    write_file(library, format_library(scene.materials, material_names));
    write_file(path, text);
}

} // namespace catoptric::scene
