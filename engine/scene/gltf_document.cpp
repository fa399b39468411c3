#include "scene/gltf_document.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "scene/gltf_accessor.hpp"
#include "scene/repair.hpp"

#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace fs = std::filesystem;

namespace {

struct Reader {
    std::string file; ///< begins every message
    const tinygltf::Model& model;
    Document document;

    template <typename... Parts>
    void require(bool ok, const Parts&... parts) const {
        check(ok, Failure::bad_data, file, ": ", parts...);
    }
    void warn(const std::string& text) { document.warnings.push_back(file + ": " + text); }

    template <typename Item>
    std::optional<std::size_t> index(int value, const std::vector<Item>& list,
                                     const std::string& place) const;
    template <typename Item>
    const Item& item(int value, const std::vector<Item>& list, const std::string& place) const;
    std::vector<double> numbers(int accessor, int type, const std::string& place) const;
    std::vector<dvec3> vectors(int accessor, const std::string& place) const;
    std::vector<double> scalars(int accessor, const std::string& place) const;

    void read_materials();
    void read_meshes();
    Primitive primitive(const tinygltf::Primitive& from, const std::string& place);
    void read_cameras();
    void read_nodes();
    void read_roots();
    void read_animations();
};

/// -1 stands for "none" in tinygltf.
template <typename Item>
std::optional<std::size_t> Reader::index(int value, const std::vector<Item>& list,
                                         const std::string& place) const {
    if (value == -1) return std::nullopt;
    require(value >= 0 && std::size_t(value) < list.size(), place, ": wanted an index below ",
            list.size(), ", found ", value);
    return std::size_t(value);
}

template <typename Item>
const Item& Reader::item(int value, const std::vector<Item>& list, const std::string& place) const {
    const std::optional<std::size_t> at = index(value, list, place);
    require(at.has_value(), place, ": wanted an index, found none");
    return list[*at];
}

std::vector<double> Reader::numbers(int accessor, int type, const std::string& place) const {
    const tinygltf::Accessor& from = item(accessor, model.accessors, place);
    require(from.type == type && !from.sparse.isSparse, place, ": wanted a dense accessor of ",
            type == TINYGLTF_TYPE_VEC3 ? "VEC3" : "SCALAR", ", found another");
    const tinygltf::BufferView& view = item(from.bufferView, model.bufferViews, place);
    return decode({.buffer = item(view.buffer, model.buffers, place).data,
                   .view_offset = view.byteOffset,
                   .view_length = view.byteLength,
                   .stride = view.byteStride,
                   .offset = from.byteOffset,
                   .count = from.count,
                   .width = type == TINYGLTF_TYPE_VEC3 ? 3u : 1u,
                   .component = Component(from.componentType)},
                  file + ": " + place);
}

std::vector<dvec3> Reader::vectors(int accessor, const std::string& place) const {
    const std::vector<double> list = numbers(accessor, TINYGLTF_TYPE_VEC3, place);
    require(model.accessors[std::size_t(accessor)].componentType == int(Component::f32), place,
            ": wanted floats, found integers");
    std::vector<dvec3> vectors;
    for (std::size_t i = 0; i < list.size(); i += 3)
        vectors.emplace_back(list[i], list[i + 1], list[i + 2]);
    return vectors;
}

std::vector<double> Reader::scalars(int accessor, const std::string& place) const {
    return numbers(accessor, TINYGLTF_TYPE_SCALAR, place);
}

dvec3 colour(const std::vector<double>& factor, double otherwise) {
    return factor.size() < 3 ? dvec3(otherwise) : dvec3(factor[0], factor[1], factor[2]);
}

double emissive_strength(const tinygltf::Material& material) {
    const auto at = material.extensions.find("KHR_materials_emissive_strength");
    const bool is_given = at != material.extensions.end() && at->second.Has("emissiveStrength");
    return is_given ? at->second.Get("emissiveStrength").GetNumberAsDouble() : 1;
}

void Reader::read_materials() {
    for (const tinygltf::Material& from : model.materials) {
        const auto& pbr = from.pbrMetallicRoughness;
        Material material{.name = from.name};
        material.mirror = pbr.metallicFactor == 1 && pbr.roughnessFactor == 0;
        const dvec3 base = glm::clamp(colour(pbr.baseColorFactor, 1), 0.0, 1.0);
        (material.mirror ? material.reflectance : material.albedo) = vec3(base);
        material.emission = vec3(emissive_strength(from) * colour(from.emissiveFactor, 0));
        material.two_sided = from.doubleSided && material.emission != vec3(0);
        require(is_radiance(material.emission), "material '", from.name,
                "': wanted an emission of at least 0 that fits a float, found another");
        document.materials.push_back(material);
    }
}

Primitive Reader::primitive(const tinygltf::Primitive& from, const std::string& place) {
    const auto attribute = [&](const char* name) {
        const auto at = from.attributes.find(name);
        return at == from.attributes.end() ? -1 : at->second;
    };
    Primitive to;
    to.mesh.positions = vectors(attribute("POSITION"), place + ": POSITION");
    if (const int normal = attribute("NORMAL"); normal != -1)
        for (const dvec3& n : vectors(normal, place + ": NORMAL")) to.mesh.normals.emplace_back(n);
    std::vector<double> corners(to.mesh.positions.size());
    std::iota(corners.begin(), corners.end(), 0.0);
    if (from.indices != -1) corners = scalars(from.indices, place + ": indices");
    require(corners.size() % 3 == 0, place, ": wanted three corners for each triangle, found ",
            corners.size(), " corners");
    const double most = std::numeric_limits<std::uint32_t>::max();
    for (const double corner : corners) // float indices could be anything
        require(corner >= 0 && corner <= most, place, ": wanted indices, found ", corner);
    for (std::size_t i = 0; i < corners.size(); i += 3)
        to.mesh.triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
    check_mesh(to.mesh, file + ": " + place);

    const auto material = index(from.material, model.materials, place + ": material");
    to.material = material.value_or(document.materials.size());
    if (!material) document.materials.push_back({.name = "default", .albedo = vec3(1)});
    return to;
}

void Reader::read_meshes() {
    for (const tinygltf::Mesh& from : model.meshes) {
        const std::string place = "mesh '" + from.name + "'";
        PrimitiveGroup group{.name = from.name};
        for (const tinygltf::Primitive& part : from.primitives)
            if (part.mode == TINYGLTF_MODE_TRIANGLES || part.mode == -1)
                group.primitives.push_back(primitive(part, place));
            else
                warn(place + ": a primitive that is not made of triangles is left out");
        document.meshes.push_back(std::move(group));
    }
}

void Reader::read_cameras() {
    for (const tinygltf::Camera& from : model.cameras) {
        const double fov = from.type == "perspective" ? from.perspective.yfov : 0;
        require(fov > 0 && fov < std::numbers::pi, "camera '", from.name,
                "': wanted a perspective with yfov between 0 and pi, found ", from.type, " ", fov);
        document.cameras.push_back({.name = from.name, .vertical_fov_degrees = glm::degrees(fov)});
    }
}

void Reader::read_nodes() {
    for (const tinygltf::Node& from : model.nodes) {
        const std::string place = "node " + std::to_string(document.nodes.size()) + " '" +
                                  from.name + "'";
        Node node{.name = from.name,
                  .parent_from_node = matrix_of(from.matrix, from.translation, from.rotation,
                                                from.scale)};
        node.mesh = index(from.mesh, model.meshes, place + ": mesh");
        node.camera = index(from.camera, model.cameras, place + ": camera");
        node.marks = marks(from.extras_json_string, file + ": " + place);
        for (const int child : from.children) {
            const auto at = index(child, model.nodes, place + ": children");
            if (at) node.children.push_back(*at);
        }
        if (from.skin != -1) warn(place + ": its skin is left out");
        document.nodes.push_back(std::move(node));
    }
}

/// The default scene's nodes, or the first one's, or every node that is no child.
void Reader::read_roots() {
    const auto chosen = index(model.defaultScene, model.scenes, "scene");
    if (!model.scenes.empty()) {
        for (const int root : model.scenes[chosen.value_or(0)].nodes)
            if (const auto at = index(root, model.nodes, "scene: nodes"))
                document.roots.push_back(*at);
        return;
    }
    std::vector<bool> is_child(document.nodes.size(), false);
    for (const Node& node : document.nodes)
        for (const std::size_t child : node.children) is_child[child] = true;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i]) document.roots.push_back(i);
}

void Reader::read_animations() {
    for (const tinygltf::Animation& animation : model.animations)
        for (const tinygltf::AnimationChannel& channel : animation.channels) {
            const std::string place = "animation '" + animation.name + "'";
            const auto target = index(channel.target_node, model.nodes, place + ": target");
            if (!target) continue;
            if (channel.target_path != "translation") {
                warn(place + ": its " + channel.target_path + " channel is left out");
                continue;
            }
            const tinygltf::AnimationSampler& from = item(channel.sampler, animation.samplers,
                                                          place);
            document.nodes[*target].motion = keyframes(
                from.interpolation, scalars(from.input, place + ": input"),
                vectors(from.output, place + ": output"), file + ": " + place);
        }
}

bool ignore_image(tinygltf::Image*, int, std::string*, std::string*, int, int, const unsigned char*,
                  int, void*) {
    return true;
}

/// tinygltf's only way to the disk: files of the folder that `folder` points to (preflight has
/// looked at their names), and nothing else.
tinygltf::FsCallbacks files_of(fs::path& folder) {
    return {
        .FileExists =
            [](const std::string& name, void* its_folder) {
                std::error_code ignored;
                const fs::path inside = fs::path(name).lexically_relative(
                    *static_cast<fs::path*>(its_folder));
                return !inside.empty() && *inside.begin() != ".." &&
                       fs::is_regular_file(name, ignored);
            },
        .ExpandFilePath = [](const std::string& name, void*) { return name; },
        .ReadWholeFile =
            [](std::vector<unsigned char>* bytes, std::string*, const std::string& name, void*) {
                const std::string content = read_file(name);
                bytes->assign(content.begin(), content.end());
                return true;
            },
        .WriteWholeFile = nullptr,
        .user_data = &folder};
}

tinygltf::Model parse(const fs::path& path, const std::string& bytes) {
    fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    tinygltf::TinyGLTF parser;
    parser.SetImageLoader(ignore_image, nullptr);
    parser.SetFsCallbacks(files_of(folder));
    parser.SetStoreOriginalJSONForExtrasAndExtensions(true);
    check(bytes.size() < std::numeric_limits<unsigned>::max(), Failure::bad_data, path.string(),
          ": wanted less than 4 GiB, found ", bytes.size(), " bytes");
    const auto length = static_cast<unsigned>(bytes.size());
    tinygltf::Model model;
    std::string error, warning;
    const bool read = is_binary(bytes)
                          ? parser.LoadBinaryFromMemory(
                                &model, &error, &warning,
                                reinterpret_cast<const unsigned char*>(bytes.data()), length,
                                folder.string())
                          : parser.LoadASCIIFromString(&model, &error, &warning, bytes.data(),
                                                       length, folder.string());
    while (error.ends_with('\n')) error.pop_back();
    check(read, Failure::bad_data, path.string(), ": ", error);
    return model;
}

} // namespace

Document read(const fs::path& path) {
    const std::string bytes = read_file(path);
    preflight(path, bytes);
    try {
        const tinygltf::Model model = parse(path, bytes);
        Reader reader{.file = path.string(), .model = model};
        if (!model.images.empty()) reader.warn("its images are left out");
        reader.read_materials();
        reader.read_meshes();
        reader.read_cameras();
        reader.read_nodes();
        reader.read_roots();
        reader.read_animations();
        return std::move(reader.document);
    } catch (const Error&) {
        throw;
    } catch (const std::exception& error) { // of the parser: sizes that cannot be
        fail(Failure::bad_data, path.string(), ": cannot be read: ", error.what());
    }
}

} // namespace catoptric::scene::gltf
