#pragma once

#include "core/byte_source.hpp"
#include "core/math.hpp"

#include <cstdint>
#include <string>
#include <vector>

// The interface between this library and the module that links OpenImageIO (engine/images).
// OpenImageIO brings two hundred libraries. A program loads them only when it reads the first
// picture that libpng and OpenEXR do not read (core/image_codec.hpp).
namespace catoptric {

enum class CodecStatus {
    done,
    no_codec, ///< this build of OpenImageIO does not support the image format
    refused,
    out_of_memory,
    broken ///< OpenImageIO threw something else
};

struct CodecResult {
    CodecStatus answer = CodecStatus::done;
    std::string why = {}; ///< why the call failed, in one line; may be empty
};

enum class PixelType { uint8, float32 };

/// The functions of the module. The functions throw no exceptions. After a call they refer to no
/// argument, except to the bytes of an open picture. `format` is OpenImageIO's name of a format.
struct ImageCodecs {
    struct Picture; ///< an open picture; defined in the module
    struct Header {
        ivec2 size{0};
        int channel_count = 0;
        bool is_deep = false;
        std::vector<std::string> channels;
        std::string description; ///< text that describes the image, see ImageShape
    };
    struct Pixels {
        uvec2 size{0};
        std::size_t channel_count = 0;
        PixelType type = PixelType::uint8;
        const void* values = nullptr;
        std::vector<std::string> channels; ///< empty: named by the format
        /// Text that describes the image, see ImageShape.
        std::string description;
    };

    /// Opens a picture. If the answer is `done`, the caller must close `picture`; otherwise it is
    /// null.
    CodecResult (*open)(const ByteSource& bytes, const std::string& format, const std::string& name,
                        Picture*& picture, Header& header) noexcept;
    /// Reads `row_count` rows from `first` on. Rows of tiled pictures may be read again from their
    /// tiles.
    CodecResult (*read)(Picture& picture, std::uint32_t first, std::uint32_t row_count,
                        PixelType type, void* values) noexcept;
    void (*close)(Picture* picture) noexcept;
    CodecResult (*encode)(const std::string& format, const Pixels& picture,
                          std::string& bytes) noexcept;
};

/// The only symbol that the module exports: a function that returns its `ImageCodecs`. Its number
/// rises with every change of the interface above, so that a library never uses a module of another
/// version.
constexpr const char* kImageCodecsSymbol = "catoptric_image_codecs_3";
using ImageCodecsFunction = const ImageCodecs* (*)();

/// Returns the module's functions. The first call loads the module, which takes a fifth of a
/// second. The module is searched beside the library or program that contains this code, and at its
/// installed place relative to them. Throws `internal` with the searched places and what to
/// install, or `exhausted` without memory. After an error the next call searches again. May be
/// called from any thread.
const ImageCodecs& image_codecs();

} // namespace catoptric
