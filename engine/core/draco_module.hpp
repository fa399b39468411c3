#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

// The interface between this library and the module that links Draco (engine/draco).
namespace catoptric {

/// Type of the components in which the values of an attribute are wanted.
enum class DracoType : std::uint8_t { int8, uint8, int16, uint16, uint32, float32 };

struct DracoAttribute {
    std::uint32_t id = 0; ///< unique id within the data
    DracoType type = DracoType::float32;
    std::size_t width = 3;             ///< components of each value, 1 to 4
    std::vector<unsigned char> values; ///< filled: the values of all points, tightly packed
};

/// Numbers that the data claim, before anything is decoded.
struct DracoCounts {
    std::uint32_t triangles = 0, points = 0;
};

/// The functions of the module. They throw no exceptions, and refer to no argument after a call.
struct DracoCodec {
    /// Reads the counts of a triangle mesh in Draco's bitstream 2.2. Returns a text about the
    /// error; empty if there is none.
    std::string (*read_counts)(std::span<const unsigned char> bytes, DracoCounts& counts) noexcept;
    /// Decodes the attributes, and three point indices for each triangle. Needs memory for the
    /// counts that `read_counts` returns. Returns a text about the error; empty if there is none.
    std::string (*decode)(std::span<const unsigned char> bytes,
                          std::vector<DracoAttribute>& attributes,
                          std::vector<std::uint32_t>& corners) noexcept;
};

/// The only symbol that the module exports: a function that returns its `DracoCodec`. Its number
/// rises with every change of the interface above.
constexpr const char* kDracoCodecSymbol = "catoptric_draco_codec_1";
using DracoCodecFunction = const DracoCodec* (*)();

/// Returns the module's functions. The first call loads the module. Throws as load_symbol
/// does (core/module.hpp).
const DracoCodec& draco_codec();

} // namespace catoptric
