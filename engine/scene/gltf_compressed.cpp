// Decodes geometry that a glTF file stores compressed: KHR_draco_mesh_compression and
// EXT_meshopt_compression.
#include "core/draco_module.hpp"
#include "scene/gltf_check.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include <meshoptimizer.h>
#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kDracoExtension = "KHR_draco_mesh_compression";
/// Bytes by which a compressed byte of Draco's data counts against the budget, in addition to the
/// result.
constexpr std::uint64_t kDecodedBytesPerDracoByte = 4;

/// Removes an extension that was decoded, so that it does not count as unread.
void erase_extension(Json& item, std::string_view name) {
    Json& extensions = item["extensions"];
    extensions.erase(std::string(name));
    if (extensions.empty()) item.erase("extensions");
}

/// The bytes of a buffer from an offset on.
struct ByteRange {
    const unsigned char* first;
    std::size_t size;
};

/// Returns the bytes that `part` gives by `buffer`, `byteOffset` and `byteLength`.
ByteRange find_buffer_bytes(const GltfContainer& container, const JsonObject& part) {
    const GltfBuffer& buffer =
        container.buffers[part.needed_index("buffer", container.buffers.size())];
    const std::uint64_t offset = part.whole("byteOffset", 0), length = part.whole("byteLength", 0);
    part.require_condition(
        length >= 1 && offset <= buffer.length && length <= buffer.length - offset, "wanted ",
        length, " bytes, at least 1, from ", offset, " on, found a buffer of ", buffer.length);
    return {container.files[buffer.file].data() + offset, length};
}

/// Adds bytes as a buffer of their own. Returns its index.
std::size_t add_buffer_of_bytes(GltfContainer& container, ByteList bytes) {
    container.buffers.push_back({container.files.size(), bytes.size()});
    container.files.push_back(std::move(bytes));
    return container.buffers.size() - 1;
}

// ---- EXT_meshopt_compression

enum class MeshoptMode : std::uint8_t { attributes, triangles, indices };

/// A filter that is undone after decoding, and the sizes of an element that it allows.
struct MeshoptFilter {
    std::string_view name;
    void (*undo)(void*, std::size_t, std::size_t);
    bool (*fits)(std::uint64_t stride);
};
constexpr std::array<MeshoptFilter, 4> kMeshoptFilters{
    {{"NONE", nullptr, [](std::uint64_t) { return true; }},
     {"OCTAHEDRAL", meshopt_decodeFilterOct,
      [](std::uint64_t stride) { return stride == 4 || stride == 8; }},
     {"QUATERNION", meshopt_decodeFilterQuat, [](std::uint64_t stride) { return stride == 8; }},
     {"EXPONENTIAL", meshopt_decodeFilterExp,
      [](std::uint64_t stride) { return stride % 4 == 0; }}}};

MeshoptMode read_meshopt_mode(const JsonObject& extension) {
    constexpr std::array<std::string_view, 3> kModes{"ATTRIBUTES", "TRIANGLES", "INDICES"};
    const auto* const mode = std::ranges::find(kModes, extension.text("mode"));
    extension.require_condition(
        mode != kModes.end(), "mode: wanted ATTRIBUTES, TRIANGLES or INDICES, found ",
        extension.has_member("mode") ? describe_json_value(*extension.find("mode")) : "none");
    return static_cast<MeshoptMode>(mode - kModes.begin());
}

/// Returns the elements of a compressed view.
ByteList decode_meshopt_view(const GltfContainer& container, const JsonObject& extension,
                             SceneLoadBudgetUsage& account) {
    const ByteRange bytes = find_buffer_bytes(container, extension);
    const MeshoptMode mode = read_meshopt_mode(extension);
    const std::uint64_t count = extension.whole("count", 0),
                        stride = extension.whole("byteStride", 0);
    const bool is_attribute = mode == MeshoptMode::attributes;
    extension.require_condition(
        is_attribute ? stride >= 4 && stride <= 256 && stride % 4 == 0 : stride == 2 || stride == 4,
        "byteStride: wanted ", is_attribute ? "a multiple of 4 from 4 to 256" : "2 or 4",
        ", found ", stride);
    extension.require_condition(count >= 1 && (mode != MeshoptMode::triangles || count % 3 == 0),
                                "count: wanted at least 1",
                                mode == MeshoptMode::triangles ? " and a multiple of 3" : "",
                                ", found ", count);
    const std::string name = extension.text("filter", "NONE");
    const auto* const filter = std::ranges::find(kMeshoptFilters, name, &MeshoptFilter::name);
    extension.require_condition(filter != kMeshoptFilters.end() &&
                                    (filter->undo == nullptr || is_attribute) &&
                                    filter->fits(stride),
                                "filter: wanted NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL that "
                                "fits the mode and a stride of ",
                                stride, ", found ", describe_json_value(Json(name)));
    account.decoded_bytes.add_amount_within_budget(count > ~0ull / stride ? ~0ull : count * stride,
                                                   extension.place());
    ByteList elements(count * stride);
    int failed = 0;
    if (mode == MeshoptMode::attributes)
        failed = meshopt_decodeVertexBuffer(elements.data(), count, stride, bytes.first,
                                            bytes.size);
    else if (mode == MeshoptMode::triangles)
        failed = meshopt_decodeIndexBuffer(elements.data(), count, stride, bytes.first, bytes.size);
    else
        failed = meshopt_decodeIndexSequence(elements.data(), count, stride, bytes.first,
                                             bytes.size);
    extension.require_condition(failed == 0, "wanted ", count, " elements of ", stride,
                                " bytes in meshopt's format, found ", bytes.size,
                                " bytes that do not decode to them");
    if (filter->undo != nullptr) filter->undo(elements.data(), count, stride);
    return elements;
}

void decode_meshopt_views(GltfContainer& container, const std::string& file,
                          SceneLoadBudgetUsage& account) {
    const std::size_t views = JsonObject(container.document, file).size("bufferViews");
    for (std::size_t i = 0; i < views; ++i) {
        ByteList elements;
        {
            const JsonObject root(container.document, file);
            const auto extension = root.at("bufferViews", i).read_extension(kMeshoptExtension);
            if (!extension) continue;
            elements = decode_meshopt_view(container, *extension, account);
        }
        Json& view = container.document["bufferViews"][i];
        view["byteOffset"] = 0u;
        view["byteLength"] = elements.size();
        view["buffer"] = add_buffer_of_bytes(container, std::move(elements));
        erase_extension(view, kMeshoptExtension);
    }
}

// ---- KHR_draco_mesh_compression

DracoType read_draco_component_type(const JsonObject& accessor) {
    switch (accessor.whole("componentType", 0)) {
    case TINYGLTF_COMPONENT_TYPE_BYTE: return DracoType::int8;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return DracoType::uint8;
    case TINYGLTF_COMPONENT_TYPE_SHORT: return DracoType::int16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return DracoType::uint16;
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT: return DracoType::uint32;
    default: return DracoType::float32;
    }
}

/// Returns the components of an element of VEC4, for example 4. Throws `bad_data` for a matrix,
/// which no vertex attribute is.
std::size_t read_draco_component_count(const JsonObject& accessor) {
    constexpr std::array<std::string_view, 4> kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto* const type = std::ranges::find(kTypes, accessor.text("type"));
    accessor.require_condition(
        type != kTypes.end(), "type: wanted SCALAR or VEC2 .. VEC4, found ",
        accessor.has_member("type") ? describe_json_value(*accessor.find("type")) : "none");
    return static_cast<std::size_t>(type - kTypes.begin()) + 1;
}

/// Elements that take the place of an accessor's.
struct DecodedAccessor {
    std::string attribute; ///< name of the attribute; empty: the indices
    Json accessor;
    ByteList bytes;
};

/// Gives the primitive new accessors with decoded data. The old accessors stay, because other
/// primitives may use them.
void set_decoded_accessors(GltfContainer& container, std::vector<DecodedAccessor> decoded,
                           std::size_t mesh, std::size_t primitive) {
    Json& document = container.document;
    for (DecodedAccessor& one : decoded) {
        const std::size_t length = one.bytes.size();
        document["bufferViews"].push_back(
            {{"buffer", add_buffer_of_bytes(container, std::move(one.bytes))},
             {"byteLength", length}});
        one.accessor["bufferView"] = document["bufferViews"].size() - 1;
        one.accessor["byteOffset"] = 0u;
        one.accessor.erase("sparse");
        document["accessors"].push_back(std::move(one.accessor));
        Json& to = document["meshes"][mesh]["primitives"][primitive];
        (one.attribute.empty()
             ? to["indices"]
             : to["attributes"][one.attribute]) = document["accessors"].size() - 1;
    }
    Json& to = document["meshes"][mesh]["primitives"][primitive];
    to["mode"] = unsigned{TINYGLTF_MODE_TRIANGLES}; // decoding gives a list of triangles
    erase_extension(to, kDracoExtension);
}

/// Makes accessors that only described Draco's data as small as possible. Without this, they would
/// be filled with zeros of full length.
void shrink_accessors_without_data(Json& document, const std::vector<std::size_t>& accessors) {
    for (const std::size_t index : accessors) {
        Json& accessor = document["accessors"][index];
        if (!accessor.contains("bufferView") && !accessor.contains("sparse"))
            accessor["count"] = 1u;
    }
}

std::vector<DecodedAccessor> decode_draco_primitive(const GltfContainer& container,
                                                    const JsonObject& root,
                                                    const JsonObject& primitive,
                                                    const JsonObject& extension,
                                                    SceneLoadBudgetUsage& account) {
    const JsonObject view = root.at("bufferViews",
                                    extension.needed_index("bufferView", root.size("bufferViews")));
    const ByteRange bytes = find_buffer_bytes(container, view);
    const std::optional<JsonObject> compressed = extension.read_object_member("attributes"),
                                    attributes = primitive.read_object_member("attributes");
    extension.require_condition(compressed && attributes, "wanted attributes, found none");
    const std::uint64_t mode = primitive.whole("mode", TINYGLTF_MODE_TRIANGLES);
    primitive.require_condition(mode == TINYGLTF_MODE_TRIANGLES ||
                                    mode == TINYGLTF_MODE_TRIANGLE_STRIP,
                                "mode: wanted 4 or 5 beside ", kDracoExtension, ", found ", mode);
    std::vector<DecodedAccessor> decoded;
    std::vector<DracoAttribute> wanted;
    for (const auto& [name, value] : compressed->json_value().items()) {
        const JsonObject accessor = root.at("accessors",
                                            attributes->needed_index(name, root.size("accessors")));
        decoded.push_back({name, accessor.json_value(), {}});
        wanted.push_back({.id = static_cast<std::uint32_t>(
                              std::min(compressed->whole(name, 0), std::uint64_t{~0u})),
                          .type = read_draco_component_type(accessor),
                          .width = read_draco_component_count(accessor)});
    }
    // Decoding takes time in proportion to the compressed bytes. They count once for each
    // primitive, even if many primitives name the same bytes.
    account.decoded_bytes.add_amount_within_budget(bytes.size * kDecodedBytesPerDracoByte,
                                                   extension.place());
    const DracoCodec& codec = draco_codec();
    DracoCounts counts;
    std::string wrong = codec.read_counts({bytes.first, bytes.size}, counts);
    extension.require_condition(wrong.empty(), wrong);
    account.mesh_triangles.check_amount_fits_budget(counts.triangles, extension.place());
    account.positions.check_amount_fits_budget(counts.points, extension.place());
    extension.require_condition(counts.points <= std::uint64_t{3} * counts.triangles,
                                "wanted at most three points for each of ", counts.triangles,
                                " triangles, found ", counts.points);
    std::vector<std::uint32_t> corners;
    wrong = codec.decode({bytes.first, bytes.size}, wanted, corners);
    extension.require_condition(wrong.empty(), wrong);

    for (std::size_t i = 0; i < wanted.size(); ++i) {
        decoded[i].bytes = std::move(wanted[i].values);
        const std::size_t element = accessor_element_bytes(root.at(
            "accessors", attributes->needed_index(decoded[i].attribute, root.size("accessors"))));
        decoded[i].accessor["count"] = decoded[i].bytes.size() / element;
    }
    const auto* const first = reinterpret_cast<const unsigned char*>(corners.data());
    decoded.push_back({"",
                       {{"componentType", unsigned{TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT}},
                        {"count", corners.size()},
                        {"type", "SCALAR"}},
                       ByteList(first, first + corners.size() * sizeof(std::uint32_t))});
    for (const DecodedAccessor& one : decoded)
        account.decoded_bytes.add_amount_within_budget(one.bytes.size(), extension.place());
    return decoded;
}

void decode_draco_primitives(GltfContainer& container, const std::string& file,
                             SceneLoadBudgetUsage& account) {
    std::vector<std::size_t> described; // accessors that describe Draco's data
    const std::size_t meshes = JsonObject(container.document, file).size("meshes");
    for (std::size_t i = 0; i < meshes; ++i) {
        const std::size_t primitives =
            JsonObject(container.document, file).at("meshes", i).size("primitives");
        for (std::size_t k = 0; k < primitives; ++k) {
            std::vector<DecodedAccessor> decoded;
            {
                const JsonObject root(container.document, file);
                const JsonObject primitive = root.at("meshes", i).at("primitives", k);
                const auto extension = primitive.read_extension(kDracoExtension);
                if (!extension) continue;
                decoded = decode_draco_primitive(container, root, primitive, *extension, account);
                const std::size_t count = root.size("accessors");
                if (const auto indices = primitive.index("indices", count))
                    described.push_back(*indices);
                const JsonObject attributes = *primitive.read_object_member("attributes");
                for (const DecodedAccessor& one : decoded)
                    if (!one.attribute.empty())
                        described.push_back(attributes.needed_index(one.attribute, count));
            }
            set_decoded_accessors(container, std::move(decoded), i, k);
        }
    }
    shrink_accessors_without_data(container.document, described);
}

} // namespace

void decode_compressed_geometry(GltfContainer& container, const std::string& file,
                                SceneLoadBudgetUsage& account) {
    decode_meshopt_views(container, file, account);
    decode_draco_primitives(container, file, account);
}

} // namespace catoptric::scene::gltf
