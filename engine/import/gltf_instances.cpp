// Reads EXT_mesh_gpu_instancing: a node that shows its mesh at many places.
#include "import/gltf_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kInstancingExtension = "EXT_mesh_gpu_instancing";

/// An attribute of instances (EXT_mesh_gpu_instancing), and the member of a node that it sets.
struct InstanceAttribute {
    std::string_view name, member, type;
};
constexpr std::array<InstanceAttribute, 3> kInstanceAttributes{
    {{"TRANSLATION", "translation", "VEC3"},
     {"ROTATION", "rotation", "VEC4"},
     {"SCALE", "scale", "VEC3"}}};

template <typename Stored>
double read_stored_number(const unsigned char* from) {
    Stored value;
    std::memcpy(&value, from, sizeof value);
    if constexpr (std::is_floating_point_v<Stored>) return value;
    return std::max(double(value) / std::numeric_limits<Stored>::max(), -1.0);
}

/// Returns the elements of a dense, checked accessor, as a list of numbers each. Throws `bad_data`
/// for components that the extension does not allow, and for numbers that are not finite.
std::vector<Json> read_dense(const Container& container, const JsonObject& root,
                             const JsonObject& accessor, std::string_view type) {
    accessor.require(accessor.text("type") == type, "wanted an accessor of ", type, ", found ",
                     accessor.text("type"));
    const std::uint64_t component = accessor.whole("componentType", 0);
    const bool is_float = component == TINYGLTF_COMPONENT_TYPE_FLOAT,
               is_byte = component == TINYGLTF_COMPONENT_TYPE_BYTE,
               is_short = component == TINYGLTF_COMPONENT_TYPE_SHORT;
    const bool is_whole = (is_byte || is_short) && type == "VEC4" &&
                          accessor.flag("normalized", false);
    accessor.require(is_float || is_whole,
                     "wanted floats, or a rotation of normalized bytes or shorts, found "
                     "component type ",
                     component);
    const std::size_t size = element_bytes(accessor), width = type == "VEC4" ? 4 : 3;
    const JsonObject view = root.at("bufferViews", accessor.whole("bufferView", 0));
    const GltfBuffer& buffer = container.buffers[view.whole("buffer", 0)];
    const std::uint64_t given = view.whole("byteStride", 0), stride = given == 0 ? size : given;
    const unsigned char* const first = container.files[buffer.file].data() +
                                       view.whole("byteOffset", 0) +
                                       accessor.whole("byteOffset", 0);
    std::vector<Json> elements;
    for (std::uint64_t i = 0; i < accessor.whole("count", 0); ++i) {
        Json numbers = Json::array();
        for (std::size_t k = 0; k < width; ++k) {
            const unsigned char* const at = first + i * stride + k * (size / width);
            const double number = is_float  ? read_stored_number<float>(at)
                                  : is_byte ? read_stored_number<std::int8_t>(at)
                                            : read_stored_number<std::int16_t>(at);
            accessor.require(std::isfinite(number), "element ", i,
                             ": wanted finite numbers, found NaN or infinity");
            numbers.push_back(number);
        }
        elements.push_back(std::move(numbers));
    }
    return elements;
}

/// Returns the nodes of the instances of a node, one for each.
std::vector<Json> read_instances(const Container& container, const JsonObject& root,
                                 const JsonObject& node, const JsonObject& extension,
                                 LoadAccount& account, LoaderNotes& notes) {
    const std::optional<JsonObject> attributes = extension.object("attributes");
    extension.require(attributes.has_value(), "wanted attributes, found none");
    std::vector<Json> instances;
    bool is_first = true;
    for (const InstanceAttribute& attribute : kInstanceAttributes) {
        if (!attributes->has(attribute.name)) continue;
        const JsonObject accessor = root.at(
            "accessors", attributes->needed_index(attribute.name, root.size("accessors")));
        const std::uint64_t count = accessor.whole("count", 0);
        if (is_first) {
            account.nodes.add(count, extension.place());
            instances.assign(count, Json::object());
        }
        is_first = false;
        attributes->require(count == instances.size(), attribute.name, ": wanted ",
                            instances.size(), " instances, found ", count);
        std::vector<Json> elements = read_dense(container, root, accessor, attribute.type);
        for (std::size_t i = 0; i < instances.size(); ++i)
            instances[i][std::string(attribute.member)] = std::move(elements[i]);
    }
    extension.require(!is_first, "attributes: wanted TRANSLATION, ROTATION or SCALE, found none");
    for (const auto& [name, value] : attributes->json().items())
        if (std::ranges::find(kInstanceAttributes, name, &InstanceAttribute::name) ==
            kInstanceAttributes.end())
            notes.add("instance attributes that are not read", node.path());
    Json copied = Json::object(); // members that each instance has from its node
    for (const char* member : {"mesh", "weights"})
        if (const Json* value = node.find(member)) copied[member] = *value;
    if (const auto ours = find_extras(node)) copied["extras"]["catoptric"] = ours->json();
    const std::string name = node.name();
    account.json_memory.add(instances.size() * copied.dump().size() * 8, extension.place());
    account.name_bytes.check_fits(instances.size() * name.size(), extension.place());
    for (std::size_t i = 0; i < instances.size(); ++i) {
        instances[i].update(copied);
        if (!name.empty()) instances[i]["name"] = name + " #" + std::to_string(i + 1);
    }
    return instances;
}

} // namespace

void expand_instances(Container& container, const std::string& file, LoadAccount& account,
                      LoaderNotes& notes) {
    const std::size_t nodes = JsonObject(container.document, file).size("nodes");
    for (std::size_t i = 0; i < nodes; ++i) {
        std::vector<Json> instances;
        {
            const JsonObject root(container.document, file);
            const JsonObject node = root.at("nodes", i);
            const auto extension = node.extension(kInstancingExtension);
            if (!extension || !node.has("mesh")) continue;
            if (node.has("skin")) {
                notes.add("instances of a mesh with a skin, left out", node.path());
                continue;
            }
            instances = read_instances(container, root, node, *extension, account, notes);
        }
        Json& list = container.document["nodes"];
        for (Json& instance : instances) {
            list[i]["children"].push_back(list.size());
            list.push_back(std::move(instance));
        }
        list[i].erase("mesh");
        list[i].erase("weights");
        list[i]["extensions"].erase(std::string(kInstancingExtension));
        if (list[i]["extensions"].empty()) list[i].erase("extensions");
    }
}

} // namespace catoptric::scene::gltf
