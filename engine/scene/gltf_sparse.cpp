#include "scene/gltf_check.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

/// Returns the bytes of the view that `part` names, from the offset of `part` on.
const unsigned char* find_view_bytes(const Container& container, const JsonObject& root,
                                     const JsonObject& part) {
    const JsonObject view = root.at("bufferViews", part.whole("bufferView", 0));
    const GltfBuffer& buffer = container.buffers[view.whole("buffer", 0)];
    return container.files[buffer.file].data() + view.whole("byteOffset", 0) +
           part.whole("byteOffset", 0);
}

std::uint64_t read_sparse_index(const unsigned char* bytes, std::size_t size, std::size_t index) {
    std::uint64_t place = 0; // glTF and all supported machines are little-endian
    std::memcpy(&place, bytes + index * size, size);
    return place;
}

/// Copies the sparse values to their indices in `dense`. Sparse values and indices are always
/// tightly packed. Throws `bad_data` for an invalid index.
void write_sparse_values(const Container& container, const JsonObject& root,
                         const JsonObject& sparse, std::size_t size, std::uint64_t count,
                         ByteList& dense) {
    const JsonObject indices = *sparse.object("indices"), values = *sparse.object("values");
    const auto component = static_cast<std::uint32_t>(indices.whole("componentType", 0));
    indices.require(component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                        component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                        component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                    "componentType: wanted 5121, 5123 or 5125, found ", component);
    const auto width = static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(component));
    const unsigned char* const places = find_view_bytes(container, root, indices);
    const unsigned char* const from = find_view_bytes(container, root, values);
    for (std::uint64_t i = 0; i < sparse.whole("count", 0); ++i) {
        const std::uint64_t place = read_sparse_index(places, width, i);
        sparse.require(place < count, "indices: wanted places below ", count, ", found ", place);
        std::copy_n(from + i * size, size, dense.begin() + std::ptrdiff_t(place * size));
    }
}

ByteList make_dense(const Container& container, const JsonObject& root,
                    const JsonObject& accessor) {
    const std::size_t size = element_bytes(accessor);
    const std::uint64_t count = accessor.whole("count", 0);
    ByteList dense(count * size, 0);
    if (accessor.has("bufferView")) {
        const JsonObject view = root.at("bufferViews", accessor.whole("bufferView", 0));
        const std::uint64_t given = view.whole("byteStride", 0);
        const std::uint64_t stride = given == 0 ? size : given;
        const unsigned char* const from = find_view_bytes(container, root, accessor);
        for (std::uint64_t i = 0; i < count; ++i)
            std::copy_n(from + i * stride, size, dense.begin() + std::ptrdiff_t(i * size));
    }
    if (const auto sparse = accessor.object("sparse"))
        write_sparse_values(container, root, *sparse, size, count, dense);
    return dense;
}

} // namespace

void expand_sparse(Container& container, const std::string& file, LoadAccount& account) {
    const std::size_t accessors = JsonObject(container.document, file).size("accessors");
    for (std::size_t i = 0; i < accessors; ++i) {
        ByteList dense;
        {
            const JsonObject root(container.document, file);
            const JsonObject accessor = root.at("accessors", i);
            if (accessor.has("bufferView") && !accessor.has("sparse")) continue;
            const std::uint64_t count = accessor.whole("count", 0);
            account.made_bytes.add(count > ~0ull / 64 ? ~0ull : count * element_bytes(accessor),
                                   accessor.place());
            dense = make_dense(container, root, accessor);
        }
        Json& document = container.document;
        document["bufferViews"].push_back(
            {{"buffer", container.buffers.size()}, {"byteLength", dense.size()}});
        container.buffers.push_back({container.files.size(), dense.size()});
        container.files.push_back(std::move(dense));
        Json& accessor = document["accessors"][i];
        accessor.erase("sparse");
        accessor["bufferView"] = document["bufferViews"].size() - 1;
        accessor["byteOffset"] = 0u;
    }
}

} // namespace catoptric::scene::gltf
