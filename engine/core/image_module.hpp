#pragma once

#include "core/byte_source.hpp"
#include "core/math.hpp"

#include <cstdint>
#include <string>
#include <vector>

// What lies between this library and the module that links OpenImageIO (engine/images): two hundred
// libraries, which a program loads when its first picture is read or written, and not before.
namespace catoptric {

enum class CodecAnswer {
    done,
    no_codec, ///< this OpenImageIO knows no such format
    refused,
    out_of_memory,
    broken ///< OpenImageIO threw something else
};

struct CodecResult {
    CodecAnswer answer = CodecAnswer::done;
    std::string why = {}; ///< in one line; may be empty
};

enum class CodecValue { uint8, float32 };

/// The module's functions. They throw nothing and keep nothing that they are handed but the bytes
/// of an open picture. `format` is what OpenImageIO calls it.
struct ImageCodecs {
    struct Picture; ///< an open one; the module knows what it is
    struct Header {
        ivec2 size{0};
        int channel_count = 0;
        bool is_deep = false;
        std::vector<std::string> channels;
    };
    struct Values {
        uvec2 size{0};
        std::size_t channel_count = 0;
        CodecValue type = CodecValue::uint8;
        const void* values = nullptr;
    };

    /// `picture` is to be closed where this is done, and null otherwise.
    CodecResult (*open)(const ByteSource& bytes, const std::string& format, const std::string& name,
                        Picture*& picture, Header& header) noexcept;
    /// `row_count` rows from `first` on; rows of tiled pictures may be read from their tiles anew.
    CodecResult (*read)(Picture& picture, std::uint32_t first, std::uint32_t row_count,
                        CodecValue type, void* values) noexcept;
    void (*close)(Picture* picture) noexcept;
    CodecResult (*encode)(const std::string& format, const Values& picture,
                          std::string& bytes) noexcept;
};

/// The one name that the module exports, a function that returns its `ImageCodecs`. It counts up
/// with what stands above, so that a library and a module of two versions do not meet.
constexpr const char* kImageCodecs = "catoptric_image_codecs_2";
using ImageCodecsFunction = const ImageCodecs* (*)();

/// The module's functions; the first call loads it, a fifth of a second. Looked for beside the
/// library or program that this code is part of, and where it is installed from there. Throws
/// `internal` (`exhausted` where memory was wanting) with the places and what to install; then the
/// next call looks again. From any thread.
const ImageCodecs& image_codecs();

} // namespace catoptric
