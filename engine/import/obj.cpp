#include "core/knob.hpp"
#include "core/text.hpp"
#include "import/file_options.hpp"
#include "import/load.hpp"
#include "import/obj_text.hpp"
#include "scene/repair.hpp"
#include "scene/transform.hpp"

#include <algorithm>
#include <compare>
#include <cstdint>
#include <sstream>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace catoptric::scene {

namespace {

/// Indices of a vertex's position, normal and texture coordinates; -1 if absent.
struct CornerIndices {
    int position, normal, uv;
    auto operator<=>(const CornerIndices&) const = default;
};

CornerIndices to_corner_indices(const tinyobj::index_t& corner) {
    return {corner.vertex_index, corner.normal_index, corner.texcoord_index};
}

void add_vertex(Mesh& mesh, const CornerIndices& vertex, const obj::RewrittenText& text,
                bool has_uv) {
    const auto& [position, normal, uv] = vertex;
    mesh.positions.push_back(text.positions[std::size_t(position)]);
    mesh.normals.push_back(
        normal < 0 ? vec3(0) : vec3(normalized_or_zero(text.normals[std::size_t(normal)])));
    if (!text.colours.empty()) mesh.colours.emplace_back(text.colours[std::size_t(position)], 1);
    if (!has_uv) return;
    const vec2 upwards = uv < 0 ? vec2(0, 1) : text.uv[std::size_t(uv)];
    mesh.uv[0].emplace_back(upwards.x, 1 - upwards.y);
}

/// Builds a mesh with one vertex for each distinct triple among the corners. Each three corners are
/// a triangle. Vertices are sorted by the index of position, then normal, then texture coordinates.
Mesh build_mesh(const obj::RewrittenText& text, const std::vector<tinyobj::index_t>& corners,
                std::string name, LimitedSum& vertices, const std::string& place) {
    struct MeshCornerUse {
        CornerIndices triple;
        std::uint32_t corner;
        auto operator<=>(const MeshCornerUse&) const = default;
    };
    std::vector<MeshCornerUse> uses;
    uses.reserve(corners.size());
    for (const tinyobj::index_t& corner : corners)
        uses.push_back({to_corner_indices(corner), static_cast<std::uint32_t>(uses.size())});
    std::ranges::sort(uses);
    const auto is_first = [&](std::size_t i) {
        return i == 0 || uses[i].triple != uses[i - 1].triple;
    };
    std::size_t count = 0;
    for (std::size_t i = 0; i < uses.size(); ++i) count += is_first(i);
    vertices.add(count, place);
    Mesh mesh{.name = std::move(name)};
    const bool has_uv = std::ranges::any_of(
        corners, [](const tinyobj::index_t& corner) { return corner.texcoord_index >= 0; });
    mesh.positions.reserve(count), mesh.normals.reserve(count);
    if (has_uv) mesh.uv[0].reserve(count);
    mesh.triangles.resize(corners.size() / 3);
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const std::uint32_t corner = uses[i].corner;
        if (is_first(i)) add_vertex(mesh, uses[i].triple, text, has_uv);
        mesh.triangles[corner / 3][static_cast<int>(corner % 3)] = static_cast<std::uint32_t>(
            mesh.positions.size() - 1);
    }
    return mesh;
}

struct ObjBuilder {
    const std::string& file;
    const obj::RewrittenText& text;
    obj::ReadContext& context;
    Scene scene;
    /// Material of faces without one. Set on first use.
    std::optional<std::size_t> without_material;

    /// The triangles of a shape with the same material.
    struct ShapePart {
        int material; ///< -1 if there is none
        std::vector<tinyobj::index_t> corners;
    };
    static std::vector<ShapePart> split_by_material(const tinyobj::mesh_t& mesh);
    void add_shape(const tinyobj::shape_t& shape);
    void add_object(const std::string& shape, ShapePart part, bool is_only);
    std::size_t material_index(int material);
};

/// Returns the parts of a shape, in the order of first use of their materials.
std::vector<ObjBuilder::ShapePart> ObjBuilder::split_by_material(const tinyobj::mesh_t& mesh) {
    std::vector<ShapePart> parts;
    std::unordered_map<int, std::size_t> part_of;
    for (std::size_t i = 0; i < mesh.material_ids.size(); ++i) {
        const auto [entry, is_new] = part_of.try_emplace(mesh.material_ids[i], parts.size());
        if (is_new) parts.push_back({.material = mesh.material_ids[i]});
        const auto first = mesh.indices.begin() + std::ptrdiff_t(3 * i);
        std::vector<tinyobj::index_t>& corners = parts[entry->second].corners;
        corners.insert(corners.end(), first, first + 3);
    }
    return parts;
}

/// Returns the index of a material. Faces without a material get the first material named
/// "default", or a new grey material.
std::size_t ObjBuilder::material_index(int material) {
    if (material >= 0) return std::size_t(material);
    if (without_material) return *without_material;
    const auto found = std::ranges::find(scene.materials, "default", &Material::name);
    without_material = static_cast<std::size_t>(found - scene.materials.begin());
    if (found == scene.materials.end())
        scene.materials.push_back({.name = "default", .albedo = vec3(0.8f), .two_sided = true});
    return *without_material;
}

void apply_comments(const obj::CatoptricComments& remarks, const std::string& group,
                    Object& object) {
    if (const auto at = remarks.motions.find(group); at != remarks.motions.end())
        object.motion = at->second;
    if (const auto at = remarks.spheres.find(group); at != remarks.spheres.end())
        object.sphere = at->second;
    object.seen_by_camera = !remarks.hidden.contains(group);
}

void ObjBuilder::add_object(const std::string& shape, ShapePart part, bool is_only) {
    LoadAccount& account = context.account;
    account.objects.add(1, file, ": object ", quote(shape));
    Object object{
        .name = shape, .mesh = scene.meshes.size(), .material = material_index(part.material)};
    const std::string& material = scene.materials[object.material].name;
    account.name_bytes.add(2 * (shape.size() + 1 + material.size()), file, ": object ",
                           quote(shape));
    if (!is_only) object.name += "/" + material;
    apply_comments(text.remarks, shape, object);

    Mesh mesh = build_mesh(text, part.corners, object.name, account.mesh_vertices, file);
    part.corners = {};
    account.mesh_vertices.add(count_missing_normals(mesh), file, ": object ", quote(shape));
    const std::size_t dropped = repair_mesh(mesh);
    context.notes.add("triangles without area, left out", "in " + quote(object.name), dropped);
    scene.meshes.push_back(std::move(mesh));
    scene.objects.push_back(std::move(object));
}

void ObjBuilder::add_shape(const tinyobj::shape_t& shape) {
    std::vector<ShapePart> parts = split_by_material(shape.mesh);
    for (ShapePart& part : parts)
        add_object(text.names[std::stoul(shape.name)], std::move(part), parts.size() == 1);
}

void check_object_names(const obj::RewrittenText& text) {
    const std::unordered_set<std::string> known(text.names.begin(), text.names.end());
    for (const auto& [name, where] : text.remarks.named_at)
        if (!known.contains(name))
            fail(Failure::bad_data, where, ": wanted the name of an object with faces, found ",
                 quote(name), suggest_name(name, text.names));
}

/// Returns a material library for tinyobjloader, in which each material is only named by its
/// number.
std::string library_of_names(const obj::MtlLibrary& library) {
    std::string text;
    for (std::size_t i = 0; i < library.drafts.size(); ++i)
        text += "newmtl " + std::to_string(i) + "\n";
    return text;
}

/// Parses the statements with tinyobjloader. Moves them out of `text`, because they may be long.
struct ParsedObj {
    ParsedObj(obj::RewrittenText& text, const std::string& file) {
        std::istringstream statements(std::move(text.statements)),
            library(library_of_names(text.library));
        tinyobj::MaterialStreamReader libraries(library);
        tinyobj::attrib_t attributes;
        std::vector<tinyobj::material_t> materials;
        std::string error;
        const bool is_read = tinyobj::LoadObj(&attributes, &shapes, &materials, nullptr, &error,
                                              &statements, &libraries, false, false);
        check(is_read, Failure::bad_data, file, ": cannot be read: ", escape(error));
    }
    std::vector<tinyobj::shape_t> shapes;
};

} // namespace

Scene load_obj(const std::filesystem::path& path, const FileOptions& options) {
    const std::string file = path.string();
    LoadAccount account(options.budget);
    FileOpener files(path, options.root, account);
    LoaderNotes notes;
    std::vector<UnsupportedFeature> unsupported;
    obj::ReadContext context{files, account, notes, unsupported};
    obj::RewrittenText text = obj::read_obj_text(file, context);
    check_object_names(text);
    const ParsedObj parsed(text, file);
    ObjBuilder builder{.file = file, .text = text, .context = context};
    builder.scene = {.name = path.stem().string(),
                     .materials = make_materials(text.library, context),
                     .cameras = text.remarks.cameras,
                     .exposure = text.remarks.exposure,
                     .files = files.found()};
    for (const tinyobj::shape_t& shape : parsed.shapes) builder.add_shape(shape);
    finish_scene(builder.scene, file, notes, std::move(unsupported));
    return std::move(builder.scene);
}

} // namespace catoptric::scene
