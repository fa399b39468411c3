#include "scene/gltf_accessor.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>

namespace catoptric::scene::gltf {

namespace {

std::size_t bytes_of(Component component) {
    switch (component) {
    case Component::u8: return 1;
    case Component::u16: return 2;
    case Component::u32:
    case Component::f32: return 4;
    }
    return 0;
}

/// glTF and every machine that we run on are little-endian.
template <typename Stored>
double stored_at(const unsigned char* bytes) {
    Stored value;
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
}

double component_at(const unsigned char* bytes, Component component) {
    switch (component) {
    case Component::u8: return stored_at<std::uint8_t>(bytes);
    case Component::u16: return stored_at<std::uint16_t>(bytes);
    case Component::u32: return stored_at<std::uint32_t>(bytes);
    case Component::f32: return stored_at<float>(bytes);
    }
    return 0;
}

} // namespace

std::vector<double> decode(const Accessor& accessor, const std::string& place) {
    const auto& [buffer, view_offset, view_length, given_stride, offset, count, width,
                 component] = accessor;
    check(view_offset <= buffer.size() && view_length <= buffer.size() - view_offset,
          Failure::bad_data, place, ": wanted ", view_length, " bytes from ", view_offset,
          " on, found a buffer of ", buffer.size());
    const std::size_t size = bytes_of(component), element = width * size;
    check(size > 0, Failure::bad_data, place,
          ": wanted component type 5121, 5123, 5125 or 5126, found ", int(component));
    const std::size_t stride = given_stride == 0 ? element : given_stride;
    const std::size_t room = view_length - std::min(offset, view_length);
    const std::size_t fit = room < element || stride < element ? 0 : (room - element) / stride + 1;
    check(count >= 1 && count <= fit, Failure::bad_data, place, ": wanted ", count,
          " elements, at least 1, found a buffer view that holds ", fit);

    std::vector<double> numbers;
    numbers.reserve(count * width);
    const unsigned char* first = buffer.data() + view_offset + offset;
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < width; ++k)
            numbers.push_back(component_at(first + i * stride + k * size, component));
    return numbers;
}

} // namespace catoptric::scene::gltf
