#include "scene/gltf_check.hpp"

#include <algorithm>

#include <tiny_gltf.h>

namespace catoptric::scene::gltf {

namespace {

constexpr std::string_view kTypeNames[] = {"SCALAR", "VEC2", "VEC3", "VEC4",
                                           "MAT2",   "MAT3", "MAT4"};
constexpr std::size_t kComponentCounts[] = {1, 2, 3, 4, 4, 9, 16}; // components per element

struct StridedView {
    std::uint64_t length, stride; ///< bytes; a stride of 0 means tightly packed
};

std::size_t component_bytes(const JsonObject& item) {
    const std::uint64_t component = item.whole("componentType", 0);
    const bool is_known = component >= TINYGLTF_COMPONENT_TYPE_BYTE &&
                          component <= TINYGLTF_COMPONENT_TYPE_FLOAT &&
                          component != TINYGLTF_COMPONENT_TYPE_INT;
    item.require(is_known, "componentType: wanted 5120, 5121, 5122, 5123, 5125 or 5126, found ",
                 component);
    return static_cast<std::size_t>(
        tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(component)));
}

StridedView make_strided_view(const JsonObject& item, const std::vector<GltfBuffer>& buffers) {
    const std::uint64_t size = buffers[item.needed_index("buffer", buffers.size())].length;
    const std::uint64_t offset = item.whole("byteOffset", 0), length = item.whole("byteLength", 0);
    item.require(length >= 1 && offset <= size && length <= size - offset, "wanted ", length,
                 " bytes, at least 1, from ", offset, " on, found a buffer of ", size);
    const std::uint64_t stride = item.whole("byteStride", 0);
    const bool is_legal = stride == 0 || (stride >= 4 && stride <= 252 && stride % 4 == 0);
    item.require(is_legal, "byteStride: wanted a multiple of 4 from 4 to 252, found ", stride);
    return {length, stride};
}

/// Checks that `count` elements, at least 1, of `size` bytes lie in the item's view.
void check_in_view(const JsonObject& item, const std::vector<StridedView>& views,
                   std::uint64_t count, std::size_t size) {
    const auto& [length, given_stride] = views[item.needed_index("bufferView", views.size())];
    const std::uint64_t stride = given_stride == 0 ? size : given_stride;
    const std::uint64_t room = length - std::min(item.whole("byteOffset", 0), length);
    const std::uint64_t fit = room < size || stride < size ? 0 : (room - size) / stride + 1;
    item.require(count >= 1 && count <= fit, "wanted ", count,
                 " elements, at least 1, found a buffer view that holds ", fit);
}

/// Checks that the values and the indices of a sparse accessor lie in their views.
void check_sparse(const JsonObject& sparse, const std::vector<StridedView>& views,
                  std::uint64_t count, std::size_t element) {
    const std::uint64_t changed = sparse.whole("count", 0);
    sparse.require(changed >= 1 && changed <= count, "count: wanted 1 to ", count, ", found ",
                   changed);
    const std::optional<JsonObject> indices = sparse.object("indices"),
                                    values = sparse.object("values");
    sparse.require(indices && values, "wanted indices and values, found one of them or none");
    check_in_view(*indices, views, changed, component_bytes(*indices));
    check_in_view(*values, views, changed, element);
}

void check_accessor(const JsonObject& item, const std::vector<StridedView>& views) {
    const auto* const type = std::ranges::find(kTypeNames, item.text("type"));
    item.require(type != std::end(kTypeNames),
                 "type: wanted SCALAR, VEC2 .. VEC4 or MAT2 .. MAT4, found ",
                 item.has("type") ? describe(*item.find("type")) : "none");
    const std::size_t size = kComponentCounts[type - kTypeNames] * component_bytes(item);
    const std::uint64_t count = item.whole("count", 0);
    item.require(count >= 1, "count: wanted at least 1, found ", count);
    if (item.has("bufferView")) check_in_view(item, views, count, size);
    if (const std::optional<JsonObject> sparse = item.object("sparse"))
        check_sparse(*sparse, views, count, size);
}

} // namespace

std::size_t element_bytes(const JsonObject& accessor) {
    const auto* const type = std::ranges::find(kTypeNames, accessor.text("type"));
    return kComponentCounts[type - kTypeNames] * component_bytes(accessor);
}

void check_view_bounds(const JsonObject& root, const std::vector<GltfBuffer>& buffers) {
    std::vector<StridedView> views;
    root.each("bufferViews",
              [&](const JsonObject& item) { views.push_back(make_strided_view(item, buffers)); });
    root.each("accessors", [&](const JsonObject& item) { check_accessor(item, views); });
}

} // namespace catoptric::scene::gltf
