#include "scene/gltf_model.hpp"
#include "scene/transform.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace catoptric::scene::gltf {

namespace {

std::string name_of(int type) {
    if (type == TINYGLTF_TYPE_SCALAR) return "SCALAR";
    const int size = type & 15; // 2, 3, 4 are vectors
    return (type == size ? "VEC" : "MAT") + std::to_string(size);
}

/// glTF and every machine that we run on are little-endian.
template <typename Stored>
Stored stored_at(const Elements& elements, std::size_t index) {
    Stored value;
    std::memcpy(&value, elements.first + index * elements.stride, sizeof value);
    return value;
}

Elements dense(const tinygltf::Model& model, int index, int type, const std::string& place) {
    const tinygltf::Accessor& accessor = model.accessors[std::size_t(index)];
    check(accessor.bufferView >= 0 && !accessor.sparse.isSparse, Failure::bad_data, place,
          ": wanted an accessor with a buffer view and without sparse, found another");
    check(accessor.type == type, Failure::bad_data, place, ": wanted an accessor of ",
          name_of(type), ", found ", name_of(accessor.type));
    return elements_of(model, index);
}

} // namespace

Elements elements_of(const tinygltf::Model& model, int index) {
    const tinygltf::Accessor& accessor = model.accessors[std::size_t(index)];
    const tinygltf::BufferView& view = model.bufferViews[std::size_t(accessor.bufferView)];
    const std::vector<unsigned char>& bytes = model.buffers[std::size_t(view.buffer)].data;
    // a stride that holds an element is right for us, whatever tinygltf says of its alignment
    const int packed = accessor.ByteStride({});
    return {.first = bytes.data() + view.byteOffset + accessor.byteOffset,
            .stride = view.byteStride != 0 ? view.byteStride : std::size_t(packed),
            .count = accessor.count,
            .component = accessor.componentType};
}

Elements Context::floats(int index, int type, Total& total, const std::string& place) {
    const Elements elements = dense(document.model, index, type, place);
    check(elements.component == TINYGLTF_COMPONENT_TYPE_FLOAT, Failure::bad_data, place,
          ": wanted floats, found component type ", elements.component);
    if (!finite.insert(index).second) return elements;
    total.add(elements.count, place);
    for (std::size_t i = 0; i < elements.count; ++i)
        check(type == TINYGLTF_TYPE_VEC3 ? is_finite(vector_at(elements, i))
                                         : std::isfinite(scalar_at(elements, i)),
              Failure::bad_data, place, ": element ", i,
              ": wanted finite numbers, found NaN or infinity");
    return elements;
}

Elements Context::whole(int index, const std::string& place) const {
    const Elements elements = dense(document.model, index, TINYGLTF_TYPE_SCALAR, place);
    const bool is_unsigned = elements.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE ||
                             elements.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT ||
                             elements.component == TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT;
    check(is_unsigned, Failure::bad_data, place,
          ": wanted component type 5121, 5123 or 5125, found ", elements.component);
    return elements;
}

double scalar_at(const Elements& elements, std::size_t index) {
    return stored_at<float>(elements, index);
}

dvec3 vector_at(const Elements& elements, std::size_t index) {
    const auto [x, y, z] = stored_at<std::array<float, 3>>(elements, index);
    return {x, y, z};
}

std::uint32_t whole_at(const Elements& elements, std::size_t index) {
    switch (elements.component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return stored_at<std::uint8_t>(elements, index);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return stored_at<std::uint16_t>(elements, index);
    default: return stored_at<std::uint32_t>(elements, index);
    }
}

std::uint32_t restart_of(const Elements& elements) {
    switch (elements.component) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE: return std::numeric_limits<std::uint8_t>::max();
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT: return std::numeric_limits<std::uint16_t>::max();
    default: return std::numeric_limits<std::uint32_t>::max();
    }
}

} // namespace catoptric::scene::gltf
