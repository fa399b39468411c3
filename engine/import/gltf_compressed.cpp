// Decodes geometry that a glTF file stores compressed: KHR_draco_mesh_compression and
// EXT_meshopt_compression.
#include "core/draco_module.hpp"
#include "import/gltf_check.hpp"

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
constexpr std::uint64_t kMaxDracoRatio = 4;

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
ByteRange find_buffer_bytes(const Container& container, const JsonObject& part) {
    const GltfBuffer& buffer =
        container.buffers[part.needed_index("buffer", container.buffers.size())];
    const std::uint64_t offset = part.whole("byteOffset", 0), length = part.whole("byteLength", 0);
    part.require(length >= 1 && offset <= buffer.length && length <= buffer.length - offset,
                 "wanted ", length, " bytes, at least 1, from ", offset, " on, found a buffer of ",
                 buffer.length);
    return {container.files[buffer.file].data() + offset, length};
}

/// Returns the new buffer's index.
std::size_t append_buffer(Container& container, ByteList bytes) {
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
    extension.require(mode != kModes.end(), "mode: wanted ATTRIBUTES, TRIANGLES or INDICES, found ",
                      extension.has("mode") ? describe(*extension.find("mode")) : "none");
    return static_cast<MeshoptMode>(mode - kModes.begin());
}

ByteList decode_meshopt_view(const Container& container, const JsonObject& extension,
                             LoadAccount& account) {
    const ByteRange bytes = find_buffer_bytes(container, extension);
    const MeshoptMode mode = read_meshopt_mode(extension);
    const std::uint64_t count = extension.whole("count", 0),
                        stride = extension.whole("byteStride", 0);
    const bool is_attribute = mode == MeshoptMode::attributes;
    extension.require(
        is_attribute ? stride >= 4 && stride <= 256 && stride % 4 == 0 : stride == 2 || stride == 4,
        "byteStride: wanted ", is_attribute ? "a multiple of 4 from 4 to 256" : "2 or 4",
        ", found ", stride);
    extension.require(count >= 1 && (mode != MeshoptMode::triangles || count % 3 == 0),
                      "count: wanted at least 1",
                      mode == MeshoptMode::triangles ? " and a multiple of 3" : "", ", found ",
                      count);
    const std::string name = extension.text("filter", "NONE");
    const auto* const filter = std::ranges::find(kMeshoptFilters, name, &MeshoptFilter::name);
    extension.require(filter != kMeshoptFilters.end() &&
                          (filter->undo == nullptr || is_attribute) && filter->fits(stride),
                      "filter: wanted NONE, OCTAHEDRAL, QUATERNION or EXPONENTIAL that "
                      "fits the mode and a stride of ",
                      stride, ", found ", describe(Json(name)));
    account.decoded_bytes.add(count > ~0ull / stride ? ~0ull : count * stride, extension.place());
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
    extension.require(failed == 0, "wanted ", count, " elements of ", stride,
                      " bytes in meshopt's format, found ", bytes.size,
                      " bytes that do not decode to them");
    if (filter->undo != nullptr) filter->undo(elements.data(), count, stride);
    return elements;
}

void decode_meshopt_views(Container& container, const std::string& file, LoadAccount& account) {
    const std::size_t views = JsonObject(container.document, file).size("bufferViews");
    for (std::size_t i = 0; i < views; ++i) {
        ByteList elements;
        {
            const JsonObject root(container.document, file);
            const auto extension = root.at("bufferViews", i).extension(kMeshoptExtension);
            if (!extension) continue;
            elements = decode_meshopt_view(container, *extension, account);
        }
        Json& view = container.document["bufferViews"][i];
        view["byteOffset"] = 0u;
        view["byteLength"] = elements.size();
        view["buffer"] = append_buffer(container, std::move(elements));
        erase_extension(view, kMeshoptExtension);
    }
}

// ---- KHR_draco_mesh_compression

DracoType read_component_type(const JsonObject& accessor) {
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
std::size_t read_component_count(const JsonObject& accessor) {
    constexpr std::array<std::string_view, 4> kTypes{"SCALAR", "VEC2", "VEC3", "VEC4"};
    const auto* const type = std::ranges::find(kTypes, accessor.text("type"));
    accessor.require(type != kTypes.end(), "type: wanted SCALAR or VEC2 .. VEC4, found ",
                     accessor.has("type") ? describe(*accessor.find("type")) : "none");
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
void set_accessors(Container& container, std::vector<DecodedAccessor> decoded, std::size_t mesh,
                   std::size_t primitive) {
    Json& document = container.document;
    for (DecodedAccessor& one : decoded) {
        const std::size_t length = one.bytes.size();
        document["bufferViews"].push_back(
            {{"buffer", append_buffer(container, std::move(one.bytes))}, {"byteLength", length}});
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
void shrink_accessors(Json& document, const std::vector<std::size_t>& accessors) {
    for (const std::size_t index : accessors) {
        Json& accessor = document["accessors"][index];
        if (!accessor.contains("bufferView") && !accessor.contains("sparse"))
            accessor["count"] = 1u;
    }
}

std::vector<DecodedAccessor> decode_draco_primitive(const Container& container,
                                                    const JsonObject& root,
                                                    const JsonObject& primitive,
                                                    const JsonObject& extension,
                                                    LoadAccount& account) {
    const JsonObject view = root.at("bufferViews",
                                    extension.needed_index("bufferView", root.size("bufferViews")));
    const ByteRange bytes = find_buffer_bytes(container, view);
    const std::optional<JsonObject> compressed = extension.object("attributes"),
                                    attributes = primitive.object("attributes");
    extension.require(compressed && attributes, "wanted attributes, found none");
    const std::uint64_t mode = primitive.whole("mode", TINYGLTF_MODE_TRIANGLES);
    primitive.require(mode == TINYGLTF_MODE_TRIANGLES || mode == TINYGLTF_MODE_TRIANGLE_STRIP,
                      "mode: wanted 4 or 5 beside ", kDracoExtension, ", found ", mode);
    std::vector<DecodedAccessor> decoded;
    std::vector<DracoAttribute> wanted;
    for (const auto& [name, value] : compressed->json().items()) {
        const JsonObject accessor = root.at("accessors",
                                            attributes->needed_index(name, root.size("accessors")));
        decoded.push_back({name, accessor.json(), {}});
        wanted.push_back({.id = static_cast<std::uint32_t>(
                              std::min(compressed->whole(name, 0), std::uint64_t{~0u})),
                          .type = read_component_type(accessor),
                          .width = read_component_count(accessor)});
    }
    // Decoding takes time in proportion to the compressed bytes. They count once for each
    // primitive, even if many primitives name the same bytes.
    account.decoded_bytes.add(bytes.size * kMaxDracoRatio, extension.place());
    const DracoCodec& codec = draco_codec();
    DracoCounts counts;
    std::string wrong = codec.read_counts({bytes.first, bytes.size}, counts);
    extension.require(wrong.empty(), wrong);
    account.mesh_triangles.check_fits(counts.triangles, extension.place());
    account.positions.check_fits(counts.points, extension.place());
    extension.require(counts.points <= std::uint64_t{3} * counts.triangles,
                      "wanted at most three points for each of ", counts.triangles,
                      " triangles, found ", counts.points);
    std::vector<std::uint32_t> corners;
    wrong = codec.decode({bytes.first, bytes.size}, wanted, corners);
    extension.require(wrong.empty(), wrong);

    for (std::size_t i = 0; i < wanted.size(); ++i) {
        decoded[i].bytes = std::move(wanted[i].values);
        const std::size_t element = element_bytes(root.at(
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
        account.decoded_bytes.add(one.bytes.size(), extension.place());
    return decoded;
}

void decode_draco_primitives(Container& container, const std::string& file, LoadAccount& account) {
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
                const auto extension = primitive.extension(kDracoExtension);
                if (!extension) continue;
                decoded = decode_draco_primitive(container, root, primitive, *extension, account);
                const std::size_t count = root.size("accessors");
                if (const auto indices = primitive.index("indices", count))
                    described.push_back(*indices);
                const JsonObject attributes = *primitive.object("attributes");
                for (const DecodedAccessor& one : decoded)
                    if (!one.attribute.empty())
                        described.push_back(attributes.needed_index(one.attribute, count));
            }
            set_accessors(container, std::move(decoded), i, k);
        }
    }
    shrink_accessors(container.document, described);
}

} // namespace

void decode_geometry(Container& container, const std::string& file, LoadAccount& account) {
    decode_meshopt_views(container, file, account);
    decode_draco_primitives(container, file, account);
}

} // namespace catoptric::scene::gltf
