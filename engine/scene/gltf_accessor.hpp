#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace catoptric::scene::gltf {

/// glTF's numbers for component types.
enum class Component { u8 = 5121, u16 = 5123, u32 = 5125, f32 = 5126 };

/// Elements in a buffer view, as the file claims.
struct Accessor {
    std::span<const unsigned char> buffer;
    std::size_t view_offset = 0, view_length = 0;
    std::size_t stride = 0; ///< 0: tightly packed
    std::size_t offset = 0; ///< of the first element in the view
    std::size_t count = 0;
    std::size_t width = 1; ///< components of an element
    Component component = Component::f32;
};

/// Every component in a row. Throws `bad_data` naming `place` unless all of it lies in the buffer.
std::vector<double> decode(const Accessor& accessor, const std::string& place);

} // namespace catoptric::scene::gltf
