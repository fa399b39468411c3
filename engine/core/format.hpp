#pragma once

#include <cstdint>
#include <string_view>

namespace catoptric {

/// Texel formats that the engine uses, named by channels, bits and kind. bgra8_unorm is for windows
/// only: only the last pass of a frame writes it.
enum class TexelFormat {
    r8_unorm,
    rgba8_unorm,
    bgra8_unorm,
    r16f,
    rgba16f,
    r32f,
    rgba32f,
    r32ui,
    d32f
};

constexpr std::uint32_t bytes_per_texel(TexelFormat format) {
    switch (format) {
    case TexelFormat::r8_unorm: return 1;
    case TexelFormat::r16f: return 2;
    case TexelFormat::rgba8_unorm:
    case TexelFormat::bgra8_unorm:
    case TexelFormat::r32f:
    case TexelFormat::r32ui:
    case TexelFormat::d32f: return 4;
    case TexelFormat::rgba16f: return 8;
    case TexelFormat::rgba32f: return 16;
    }
    return 0;
}

constexpr std::string_view format_name(TexelFormat format) {
    switch (format) {
    case TexelFormat::r8_unorm: return "r8_unorm";
    case TexelFormat::rgba8_unorm: return "rgba8_unorm";
    case TexelFormat::bgra8_unorm: return "bgra8_unorm";
    case TexelFormat::r16f: return "r16f";
    case TexelFormat::rgba16f: return "rgba16f";
    case TexelFormat::r32f: return "r32f";
    case TexelFormat::rgba32f: return "rgba32f";
    case TexelFormat::r32ui: return "r32ui";
    case TexelFormat::d32f: return "d32f";
    }
    return "";
}

constexpr bool is_depth(TexelFormat format) { return format == TexelFormat::d32f; }

} // namespace catoptric
