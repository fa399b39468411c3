#include "core/image_header.hpp"

#include "core/error.hpp"
#include "core/radiance.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace catoptric {

namespace {

/// Reads integers at offsets in a file; 0 beyond its end.
class IntegerReader {
public:
    explicit IntegerReader(const ByteSource& bytes) : bytes_(bytes) {}

    std::uint32_t little_endian(std::uint64_t offset, std::size_t size) const {
        std::uint32_t value = 0;
        const auto read = bytes_at(offset);
        for (std::size_t i = 0; i < size; ++i) value |= std::uint32_t(read[i]) << (8 * i);
        return value;
    }
    std::uint32_t big_endian(std::uint64_t offset, std::size_t size) const {
        std::uint32_t value = 0;
        const auto read = bytes_at(offset);
        for (std::size_t i = 0; i < size; ++i) value = value << 8 | read[i];
        return value;
    }

private:
    std::array<unsigned char, 4> bytes_at(std::uint64_t offset) const {
        std::array<char, 4> read{};
        bytes_.read(offset, read);
        std::array<unsigned char, 4> values{};
        for (std::size_t i = 0; i < 4; ++i) values[i] = static_cast<unsigned char>(read[i]);
        return values;
    }

    const ByteSource& bytes_;
};

ImageShape make_shape(std::uint32_t width, std::uint32_t height, std::size_t channel_count) {
    return {{width, height}, channel_count, {}};
}

/// Returns the shape in the frame header, which follows any number of segments. If the file ends or
/// is no JPEG there, the size is 0.
ImageShape read_jpeg_header(const ByteSource& bytes) {
    const IntegerReader numbers(bytes);
    for (std::uint64_t at = 2; at + 9 < bytes.size();) {
        const std::uint32_t mark = numbers.big_endian(at, 2), kind = mark & 0xff;
        if (mark >> 8 != 0xff) break;
        if (kind == 0xff) { // the byte is a fill byte
            ++at;
            continue;
        }
        const bool is_frame = kind >= 0xc0 && kind <= 0xcf && kind != 0xc4 && kind != 0xc8 &&
                              kind != 0xcc;
        if (is_frame)
            return make_shape(numbers.big_endian(at + 7, 2), numbers.big_endian(at + 5, 2),
                              numbers.big_endian(at + 9, 1));
        at += 2 + numbers.big_endian(at + 2, 2);
    }
    return {};
}

ImageShape read_webp_header(const ByteSource& bytes) {
    const IntegerReader numbers(bytes);
    switch (numbers.big_endian(12, 4)) {
    case 0x56503858: // "VP8X"
        return make_shape(numbers.little_endian(24, 3) + 1, numbers.little_endian(27, 3) + 1, 4);
    case 0x5650384c: { // "VP8L": two sides of 14 bits
        const std::uint32_t bits = numbers.little_endian(21, 4);
        return make_shape((bits & 0x3fff) + 1, (bits >> 14 & 0x3fff) + 1, 4);
    }
    default:
        return make_shape(numbers.little_endian(26, 2) & 0x3fff,
                          numbers.little_endian(28, 2) & 0x3fff, 3);
    }
}

/// The first directory of a TIFF file, in either byte order (TIFF 6.0, section 2).
class TiffDirectory {
public:
    explicit TiffDirectory(const ByteSource& bytes)
        : numbers_(bytes), is_big_endian_(numbers_.big_endian(0, 2) == 0x4d4d),
          first_(integer(4, 4)) {}

    /// Returns the first value of a tag, of 16 or 32 bits; `otherwise` if the tag is missing.
    std::uint32_t value(std::uint32_t tag, std::uint32_t otherwise) const {
        constexpr std::uint32_t kTiffShortType = 3;
        for (std::uint32_t i = 0; i < integer(first_, 2); ++i) {
            const std::uint64_t entry = first_ + 2 + std::uint64_t{12} * i;
            if (integer(entry, 2) != tag) continue;
            const std::size_t size = integer(entry + 2, 2) == kTiffShortType ? 2 : 4;
            // Otherwise the entry holds the value's offset.
            const bool is_inside = size * integer(entry + 4, 4) <= 4;
            return integer(is_inside ? entry + 8 : integer(entry + 8, 4), size);
        }
        return otherwise;
    }

private:
    std::uint32_t integer(std::uint64_t at, std::size_t size) const {
        return is_big_endian_ ? numbers_.big_endian(at, size) : numbers_.little_endian(at, size);
    }

    IntegerReader numbers_;
    bool is_big_endian_;
    std::uint64_t first_;
};

/// Returns the least bytes of a TIFF file with this many decoded bytes; 0 if no limit of its
/// compression is known.
std::uint64_t min_tiff_bytes(std::uint64_t decoded, std::uint64_t compression) {
    constexpr std::uint64_t kTiffNoCompression = 1, kLzwCompression = 5, kDeflateCompression = 8,
                            kOldDeflate = 32946, kPackBits = 32773;
    constexpr std::uint64_t kMaxLzwBytesPerCode =
        4096; // bytes per code, above deflate's limit of 1032
    if (compression == kTiffNoCompression) return decoded;
    if (compression == kPackBits) return decoded / 64;
    const bool is_known = compression == kLzwCompression || compression == kDeflateCompression ||
                          compression == kOldDeflate;
    return is_known ? decoded / kMaxLzwBytesPerCode : 0;
}

ImageShape read_tiff_header(const ByteSource& bytes, const std::string& name) {
    constexpr std::uint32_t kTiffWidthTag = 256, kHeightTag = 257, kBitsTag = 258,
                            kCompressionTag = 259, kChannelsTag = 277;
    const TiffDirectory directory(bytes);
    const std::uint32_t width = directory.value(kTiffWidthTag, 0),
                        height = directory.value(kHeightTag, 0),
                        channels = std::clamp(directory.value(kChannelsTag, 1), 1u, 64u),
                        bits = std::clamp(directory.value(kBitsTag, 1), 1u, 64u);
    const std::uint64_t texels = std::uint64_t{width} * height;
    // Clamping the number of texels avoids overflow of the product below. Later checks refuse
    // pictures with sides that are so long.
    constexpr std::uint64_t kMaxClampedTexelCount = std::uint64_t{1} << 40;
    const std::uint64_t least = min_tiff_bytes(std::min(texels, kMaxClampedTexelCount) * channels *
                                                   bits / 8,
                                               directory.value(kCompressionTag, 1));
    check(least <= bytes.size(), Failure::bad_data, name, ": wanted at least ", least,
          " bytes for ", width, "x", height, " pixels, found ", bytes.size());
    return make_shape(width, height, channels);
}

/// Reads the header of a Photoshop file. Throws if a section before the pixels claims more bytes
/// than the file has, because OpenImageIO allocates as many.
ImageShape read_psd_header(const ByteSource& bytes, const std::string& name) {
    const IntegerReader numbers(bytes);
    std::uint64_t end = 26; // of the header
    for (const char* section : {"colour mode data", "image resources"}) {
        const std::uint64_t length = numbers.big_endian(end, 4);
        end += 4 + length;
        check(end <= bytes.size(), Failure::bad_data, name, ": wanted ", section, " within ",
              bytes.size(), " bytes of file, found ", length, " bytes");
    }
    return make_shape(numbers.big_endian(18, 4), numbers.big_endian(14, 4),
                      numbers.big_endian(12, 2));
}

} // namespace

std::optional<ImageShape> read_image_header(const ByteSource& bytes, const std::string& format,
                                            const std::string& name) {
    const IntegerReader numbers(bytes);
    if (format == "openexr") return read_openexr_header(bytes, name);
    if (format == "hdr")
        return ImageShape{read_radiance_header(bytes, name).size(), 3, {"R", "G", "B"}};
    if (format == "tiff") return read_tiff_header(bytes, name);
    if (format == "jpeg") return read_jpeg_header(bytes);
    if (format == "webp") return read_webp_header(bytes);
    if (format == "gif")
        return make_shape(numbers.little_endian(6, 2), numbers.little_endian(8, 2), 4);
    if (format == "dds")
        return make_shape(numbers.little_endian(16, 4), numbers.little_endian(12, 4), 4);
    if (format == "targa")
        return make_shape(numbers.little_endian(12, 2), numbers.little_endian(14, 2), 4);
    if (format == "psd") return read_psd_header(bytes, name);
    if (format == "bmp") {
        const bool is_old = numbers.little_endian(14, 4) ==
                            12; // the old header has sides of 16 bits
        if (is_old)
            return make_shape(numbers.little_endian(18, 2), numbers.little_endian(20, 2), 4);
        const std::uint32_t height = numbers.little_endian(22, 4);
        return make_shape(numbers.little_endian(18, 4), height >> 31 ? ~height + 1 : height, 4);
    }
    return std::nullopt;
}

} // namespace catoptric
