#pragma once

#include <cstdint>
#include <string_view>

namespace catoptric {

/// Texel formats that the engine uses, named by channels, bits and kind. bgra8_unorm is for windows
/// only: only the last pass of a frame writes it.
enum class Format { r8_unorm, rgba8_unorm, bgra8_unorm, r16f, rgba16f, r32f, rgba32f, r32ui, d32f };

constexpr std::uint32_t bytes_per_texel(Format format) {
    switch (format) {
    case Format::r8_unorm: return 1;
    case Format::r16f: return 2;
    case Format::rgba8_unorm:
    case Format::bgra8_unorm:
    case Format::r32f:
    case Format::r32ui:
    case Format::d32f: return 4;
    case Format::rgba16f: return 8;
    case Format::rgba32f: return 16;
    }
    return 0;
}

constexpr std::string_view name_of(Format format) {
    switch (format) {
    case Format::r8_unorm: return "r8_unorm";
    case Format::rgba8_unorm: return "rgba8_unorm";
    case Format::bgra8_unorm: return "bgra8_unorm";
    case Format::r16f: return "r16f";
    case Format::rgba16f: return "rgba16f";
    case Format::r32f: return "r32f";
    case Format::rgba32f: return "rgba32f";
    case Format::r32ui: return "r32ui";
    case Format::d32f: return "d32f";
    }
    return "";
}

constexpr bool is_depth(Format format) { return format == Format::d32f; }

} // namespace catoptric
