#include "scene/gltf_model.hpp"

#include <algorithm>
#include <cmath>
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

} // namespace catoptric::scene::gltf
