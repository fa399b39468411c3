#include "core/error.hpp"
#include "core/knob.hpp"
#include "scene/load.hpp"
#include "scene/obj_text.hpp"
#include "scene/repair.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include <tiny_obj_loader.h>

namespace catoptric::scene {

namespace {

/// Groups and triangles. tinyobjloader reads only checked statements, with materials as numbers.
std::vector<tinyobj::shape_t> parse(const obj::Text& text, const std::string& file) {
    std::string library;
    for (std::size_t i = 0; i < text.materials.size(); ++i)
        library += "newmtl " + std::to_string(i) + "\n";
    const std::string prefix = library.empty() ? "" : "mtllib all\n";
    tinyobj::ObjReaderConfig config;
    config.vertex_color = false;
    tinyobj::ObjReader reader;
    const bool read = reader.ParseFromString(prefix + text.statements, library, config);
    check(read, Failure::bad_data, file, ": ", reader.Error());
    return reader.GetShapes();
}

/// One vertex for each pair of position and normal, in the order of the file; -1: no normal.
using Pair = std::pair<int, int>;

Mesh mesh_of(const obj::Text& text, const std::vector<tinyobj::index_t>& corners) {
    std::map<Pair, std::uint32_t> vertices;
    for (const tinyobj::index_t& i : corners) vertices[{i.vertex_index, i.normal_index}] = 0;
    Mesh mesh;
    for (auto& [pair, vertex] : vertices) {
        vertex = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.push_back(text.positions.at(std::size_t(pair.first)));
        mesh.normals.push_back(
            pair.second < 0 ? vec3(0)
                            : vec3(normalized_or_zero(text.normals.at(std::size_t(pair.second)))));
    }
    const auto vertex = [&](std::size_t i) {
        return vertices.at({corners[i].vertex_index, corners[i].normal_index});
    };
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
        mesh.triangles.emplace_back(vertex(i), vertex(i + 1), vertex(i + 2));
    return mesh;
}

/// The shape's corners by material (-1: none), in order of first use.
using Part = std::pair<int, std::vector<tinyobj::index_t>>;

std::vector<Part> by_material(const tinyobj::mesh_t& mesh) {
    std::vector<Part> parts;
    for (std::size_t face = 0; 3 * face + 2 < mesh.indices.size(); ++face) {
        const int material = mesh.material_ids.at(face);
        auto part = std::ranges::find(parts, material, &Part::first);
        if (part == parts.end()) part = parts.insert(parts.end(), {material, {}});
        const auto corners = mesh.indices.begin() + std::ptrdiff_t(3 * face);
        part->second.insert(part->second.end(), corners, corners + 3);
    }
    return parts;
}

std::size_t material_index(Scene& scene, int material) {
    if (material >= 0) return std::size_t(material);
    const auto found = std::ranges::find(scene.materials, "default", &Material::name);
    const auto index = static_cast<std::size_t>(found - scene.materials.begin());
    if (found == scene.materials.end())
        scene.materials.push_back({.name = "default", .albedo = vec3(0.8f)});
    return index;
}

void apply_remarks(const obj::Remarks& remarks, const std::string& group, Object& object) {
    if (const auto at = remarks.motions.find(group); at != remarks.motions.end())
        object.motion = at->second;
    if (const auto at = remarks.spheres.find(group); at != remarks.spheres.end())
        object.sphere = at->second;
    object.seen_by_camera = !remarks.hidden.contains(group);
}

void add_shape(Scene& scene, const obj::Text& text, const tinyobj::shape_t& shape,
               const std::string& file) {
    const auto parts = by_material(shape.mesh);
    for (const auto& [material, corners] : parts) {
        Object object{.name = shape.name, .mesh = scene.meshes.size()};
        object.material = material_index(scene, material);
        if (parts.size() > 1) object.name += "/" + scene.materials[object.material].name;
        apply_remarks(text.remarks, shape.name, object);

        Mesh mesh = mesh_of(text, corners);
        mesh.name = object.name;
        if (const std::size_t dropped = repair(mesh); dropped > 0)
            scene.warnings.push_back(file + ": object '" + object.name + "': " +
                                     std::to_string(dropped) + " triangles without area left out");
        scene.meshes.push_back(std::move(mesh));
        scene.objects.push_back(std::move(object));
    }
}

void check_names(const obj::Remarks& remarks, const std::vector<tinyobj::shape_t>& shapes) {
    std::vector<std::string> names;
    for (const tinyobj::shape_t& shape : shapes) names.push_back(shape.name);
    for (const auto& [name, where] : remarks.named_at)
        check(std::ranges::find(names, name) != names.end(), Failure::bad_data, where,
              ": wanted the name of an object with faces, found '", name, "'",
              did_you_mean(name, names));
}

} // namespace

Scene load_obj(const std::filesystem::path& path) {
    const std::string file = path.string();
    const obj::Text text = obj::read_text(path);
    const std::vector<tinyobj::shape_t> shapes = parse(text, file);
    check_names(text.remarks, shapes);
    Scene scene{
        .name = path.stem().string(), .materials = text.materials, .cameras = text.remarks.cameras};
    for (const tinyobj::shape_t& shape : shapes) add_shape(scene, text, shape, file);
    finish(scene, file);
    return scene;
}

} // namespace catoptric::scene
