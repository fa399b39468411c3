#include "import/gltf_check.hpp"
#include "import/gltf_model.hpp"

#include <tiny_gltf.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

namespace catoptric::scene::gltf {

namespace {

std::string type_name(int type) {
    if (type == TINYGLTF_TYPE_SCALAR) return "SCALAR";
    const int size = type & 15; // tinygltf adds 32 to the size of a matrix
    return (type == size ? "VEC" : "MAT") + std::to_string(size);
}

/// Reads one component as it is stored. glTF and all supported machines are little-endian.
template <typename Stored>
Stored read_stored_component(const AccessorElements& elements, std::size_t index, int component) {
    Stored value;
    std::memcpy(&value,
                elements.first + index * elements.stride + std::size_t(component) * sizeof value,
                sizeof value);
    return value;
}

/// Reads one integer component, normalised as glTF defines it. The two lowest signed integers both
/// become -1.
template <typename Stored>
double read_normalised_integer(const AccessorElements& elements, std::size_t index, int component) {
    const double value = read_stored_component<Stored>(elements, index, component);
    return elements.normalised ? std::max(value / std::numeric_limits<Stored>::max(), -1.0) : value;
}

AccessorElements read_typed(const tinygltf::Model& model, int index, int type,
                            const std::string& place) {
    const tinygltf::Accessor& accessor = model.accessors[std::size_t(index)];
    check(accessor.type == type, Failure::bad_data, place, ": wanted an accessor of ",
          type_name(type), ", found ", type_name(accessor.type));
    return read_elements(model, index);
}

/// Returns whether the components are integers of 8 or 16 bits.
bool has_short_integers(const AccessorElements& elements) {
    return elements.component >= TINYGLTF_COMPONENT_TYPE_BYTE &&
           elements.component <= TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT;
}

bool is_finite_element(const AccessorElements& elements, std::size_t index) {
    for (int i = 0; i < elements.width; ++i)
        if (!std::isfinite(read_number(elements, index, i))) return false;
    return true;
}

} // namespace

AccessorElements read_elements(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors[std::size_t(index)];
    const tinygltf::BufferView& view = model.bufferViews[std::size_t(accessor.bufferView)];
    const std::vector<unsigned char>& bytes = model.buffers[std::size_t(view.buffer)].data;
    // Any stride that holds an element is valid here, even if tinygltf finds it misaligned.
    const int packed = accessor.ByteStride({});
    return {.first = bytes.data() + view.byteOffset + accessor.byteOffset,
            .stride = view.byteStride != 0 ? view.byteStride : std::size_t(packed),
            .count = accessor.count,
            .component = accessor.componentType,
            .width = tinygltf::GetNumComponentsInType(std::uint32_t(accessor.type)),
            .normalised = accessor.normalized};
}

AccessorElements ReadContext::floats(int index, int type, LimitedSum& total,
                                     const std::string& place, AllowedIntegers also) {
    const AccessorElements elements = read_typed(document.model, index, type, place);
    const bool is_whole = has_short_integers(elements) &&
                          ((also == AllowedIntegers::normalised && elements.normalised) ||
                           (also == AllowedIntegers::quantised && document.is_quantised));
    check(elements.component == TINYGLTF_COMPONENT_TYPE_FLOAT || is_whole, Failure::bad_data, place,
          ": wanted floats, found component type ", elements.component);
    if (!finite.insert(index).second) return elements;
    total.add(elements.count, place);
    for (std::size_t i = 0; i < elements.count && !is_whole; ++i)
        check(is_finite_element(elements, i), Failure::bad_data, place, ": element ", i,
              ": wanted finite numbers, found NaN or infinity");
    return elements;
}

AccessorElements ReadContext::whole(int index, const std::string& place, int type) const {
    const AccessorElements elements = read_typed(document.model, index, type, place);
    const bool is_unsigned = elements.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             elements.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             elements.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    check(is_unsigned, Failure::bad_data, place,
          ": wanted component type 5121, 5123 or 5125, found ", elements.component);
    return elements;
}

double read_number(const AccessorElements& elements, std::size_t index, int component) {
    switch (elements.component) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
        return read_normalised_integer<std::int8_t>(elements, index, component);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return read_normalised_integer<std::uint8_t>(elements, index, component);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
        return read_normalised_integer<std::int16_t>(elements, index, component);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return read_normalised_integer<std::uint16_t>(elements, index, component);
    default: return read_stored_component<float>(elements, index, component);
    }
}

dvec3 read_vector(const AccessorElements& elements, std::size_t index) {
    return {read_number(elements, index, 0), read_number(elements, index, 1),
            read_number(elements, index, 2)};
}

std::uint32_t read_integer(const AccessorElements& elements, std::size_t index, int component) {
    switch (elements.component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
        return read_stored_component<std::uint8_t>(elements, index, component);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
        return read_stored_component<std::uint16_t>(elements, index, component);
    default: return read_stored_component<std::uint32_t>(elements, index, component);
    }
}

std::uint32_t restart_index(const AccessorElements& elements) {
    switch (elements.component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return std::numeric_limits<std::uint8_t>::max();
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return std::numeric_limits<std::uint16_t>::max();
    default: return std::numeric_limits<std::uint32_t>::max();
    }
}

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
