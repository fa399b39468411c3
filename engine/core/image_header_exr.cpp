// Reads those parts of the OpenEXR header (https://openexr.com/en/latest/OpenEXRFileLayout.html)
// that determine how much memory a file needs.
#include "core/error.hpp"
#include "core/image_header.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string_view>

namespace catoptric {

namespace {

constexpr std::size_t kMaxExrNameLength = 255;
constexpr std::uint32_t kExrTiledFlag = 0x200, kExrDeepPartsFlag = 0x800,
                        kExrMultiPartFlag = 0x1000;

/// Reads a file from front to end.
class ExrFileCursor {
public:
    ExrFileCursor(const RandomAccessByteSource& bytes, const std::string& name)
        : bytes_(bytes), name_(name) {}

    [[noreturn]] void throw_bad_exr_file_error(const auto&... what) const {
        fail(Failure::bad_data, name_, ": cannot be decoded: byte ", at_, ": ", what...);
    }
    std::uint64_t count_bytes_left() const { return bytes_.size() - at_; }

    std::uint32_t read_uint32() {
        std::array<char, 4> read{};
        read_bytes_into(read);
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value |= std::uint32_t(static_cast<unsigned char>(read[i])) << (8 * i);
        return value;
    }
    std::int32_t read_int32() { return static_cast<std::int32_t>(read_uint32()); }
    std::uint8_t read_byte() {
        std::array<char, 1> read{};
        read_bytes_into(read);
        return static_cast<std::uint8_t>(read[0]);
    }
    /// Returns the text up to a zero byte, and skips this byte.
    std::string read_string() {
        std::array<char, kMaxExrNameLength + 1> read{};
        const std::string_view text(read.data(), bytes_.read(at_, read));
        const std::size_t end = text.find('\0');
        if (end == text.npos)
            throw_bad_exr_file_error("wanted a name of at most ", kMaxExrNameLength, " bytes");
        at_ += end + 1;
        return std::string(text.substr(0, end));
    }
    /// Returns whether a zero byte comes next, and skips it if so.
    bool skip_exr_byte_if_zero() {
        const bool is_zero = read_byte() == 0;
        if (!is_zero) --at_;
        return is_zero;
    }
    /// Throws if fewer than `size` bytes are left.
    void check_exr_bytes_left(std::uint64_t size, const char* what) const {
        if (size > count_bytes_left())
            throw_bad_exr_file_error("wanted ", size, " bytes of ", what, ", found ",
                                     count_bytes_left());
    }
    void skip_bytes(std::uint64_t size) {
        check_exr_bytes_left(size, "an attribute");
        at_ += size;
    }
    std::uint64_t file_position() const { return at_; }
    void seek_to_offset(std::uint64_t at) { at_ = at; }

private:
    void read_bytes_into(std::span<char> into) {
        if (bytes_.read(at_, into) < into.size())
            throw_bad_exr_file_error("the file ends in its header");
        at_ += into.size();
    }

    const RandomAccessByteSource& bytes_;
    const std::string& name_;
    std::uint64_t at_ = 0;
};

/// The header of one part of the file.
struct ExrPartHeader {
    std::vector<std::string> channels;
    std::uint64_t pixel_bytes = 0;
    bool is_subsampled = false;
    std::uint32_t compression = 0;
    std::array<std::int32_t, 4> window{0, 0, -1, -1};
    std::array<std::uint32_t, 2> tile{};
    bool is_tiled = false;
    std::uint64_t chunk_count = 0; ///< number of chunks, as the file claims; 0 if it claims none

    std::uint64_t exr_data_window_side_length(std::size_t axis) const {
        const std::int64_t first = window[axis], last = window[axis + 2];
        return static_cast<std::uint64_t>(std::max<std::int64_t>(0, last - first + 1));
    }
};

void read_exr_channels(ExrFileCursor& file, ExrPartHeader& part, std::uint64_t end) {
    while (file.file_position() < end) {
        std::string name = file.read_string();
        if (name.empty()) break;
        if (std::ranges::find(part.channels, name) != part.channels.end())
            file.throw_bad_exr_file_error("wanted one channel of each name, found two of ",
                                          quote_text_with_escapes(name));
        const std::uint32_t type = file.read_uint32();
        file.read_uint32(); // skips the flag for linear data
        const std::uint32_t across = file.read_uint32(), down = file.read_uint32();
        part.is_subsampled |= across != 1 || down != 1;
        part.pixel_bytes += type == 1 ? 2 : 4;
        part.channels.push_back(std::move(name));
    }
}

/// Checks the strings of a vector, because OpenEXR trusts the length of each.
void check_exr_string_vector(ExrFileCursor& file, std::uint64_t end) {
    while (file.file_position() + 4 <= end) {
        const std::uint32_t size = file.read_uint32();
        if (size > end - std::min(end, file.file_position()))
            file.throw_bad_exr_file_error("a string of ", size, " bytes");
        file.skip_bytes(size);
    }
}

void read_exr_attribute(ExrFileCursor& file, ExrPartHeader& part, const std::string& name,
                        const std::string& type) {
    const std::uint32_t size = file.read_uint32();
    file.check_exr_bytes_left(size, "an attribute");
    const std::uint64_t end = file.file_position() + size;
    if (name == "channels") {
        read_exr_channels(file, part, end);
    } else if (name == "compression" && size == 1) {
        part.compression = file.read_byte();
    } else if (name == "dataWindow" && size == 16) {
        for (std::int32_t& edge : part.window) edge = file.read_int32();
    } else if (name == "tiles" && size == 9) {
        part.is_tiled = true;
        for (std::uint32_t& side : part.tile) side = file.read_uint32();
    } else if (name == "chunkCount" && size == 4) {
        part.chunk_count = file.read_uint32();
    } else if (type == "stringvector") {
        check_exr_string_vector(file, end);
    } else if (type == "preview" && size >= 8) {
        const std::uint64_t width = file.read_uint32(), height = file.read_uint32();
        if (width * height > (size - 8) / 4)
            file.throw_bad_exr_file_error("a preview of ", width, "x", height, " pixels in ", size,
                                          " bytes");
    }
    file.seek_to_offset(end);
}

ExrPartHeader read_exr_part_header(ExrFileCursor& file, bool is_tiled) {
    ExrPartHeader part;
    part.is_tiled = is_tiled;
    for (std::string name = file.read_string(); !name.empty(); name = file.read_string()) {
        const std::string type = file.read_string();
        read_exr_attribute(file, part, name, type);
    }
    return part;
}

/// Returns the number of lines in one chunk.
std::uint32_t exr_lines_per_chunk(std::uint32_t compression) {
    constexpr std::uint32_t kExrLinesPerChunk[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return compression < std::size(kExrLinesPerChunk) ? kExrLinesPerChunk[compression] : 256;
}

/// Returns the most bytes of values that one byte of the file can stand for. RLE stores runs of 128
/// in 2 bytes. Deflate stores at most 1032 bytes in 1. PXR24 drops a quarter of a float before
/// deflate. B44A stores 32 bytes in 3. PIZ's Huffman code stores 256 halves in 10 bits. DWA stores
/// a block of 64 floats in two halves at least, one in such a code and one deflated. The limits of
/// other compressions are not known.
double exr_max_expansion_factor(std::uint32_t compression) {
    constexpr double kPiz = 512 * 8 / 10.0, kDwa = 256 / (2 / kPiz + 2 / 1032.0);
    constexpr double kExrMaxExpansionFactors[] = {1,  64, 1032, 1032, kPiz, 1032 * 4 / 3.0,
                                                  11, 11, kDwa, kDwa};
    const double most = compression < std::size(kExrMaxExpansionFactors)
                            ? kExrMaxExpansionFactors[compression]
                            : 0;
    return most > 0 ? most : std::numeric_limits<double>::infinity();
}

/// Returns the least bytes that the chunks of this part take. Each chunk has 8 bytes in the chunk
/// table and 8 before its values. The result is a double, because products of claimed sizes may
/// overflow any integer.
double min_exr_chunk_bytes(const ExrFileCursor& file, const ExrPartHeader& part) {
    const auto width = double(part.exr_data_window_side_length(0)),
               height = double(part.exr_data_window_side_length(1));
    double chunks = std::ceil(height / exr_lines_per_chunk(part.compression));
    if (part.is_tiled) {
        // OpenEXR allocates a whole tile, however small the picture is.
        constexpr double kMaxTileSide = 1024;
        const auto [across, down] = part.tile;
        if (across == 0 || down == 0 || across > std::max(kMaxTileSide, width) ||
            down > std::max(kMaxTileSide, height))
            file.throw_bad_exr_file_error("wanted tiles of 1 to ", kMaxTileSide,
                                          " pixels a side or as large as the ", "picture, found ",
                                          across, "x", down, " for ", width, "x", height);
        chunks = std::ceil(width / across) * std::ceil(height / down);
    }
    const double values = part.is_subsampled ? 0 : width * height * double(part.pixel_bytes);
    return 16 * std::max(chunks, double(part.chunk_count)) +
           std::floor(values / exr_max_expansion_factor(part.compression));
}

} // namespace

ImageSizeAndChannels read_openexr_header(const RandomAccessByteSource& bytes,
                                         const std::string& name) {
    ExrFileCursor file(bytes, name);
    file.read_uint32(); // skips the magic number
    const std::uint32_t flags = file.read_uint32();
    check((flags & kExrDeepPartsFlag) == 0, Failure::bad_data, name,
          ": wanted a flat picture, found a deep one");
    std::vector<ExrPartHeader> parts{read_exr_part_header(file, (flags & kExrTiledFlag) != 0)};
    if ((flags & kExrMultiPartFlag) != 0)
        while (!file.skip_exr_byte_if_zero()) parts.push_back(read_exr_part_header(file, false));
    double least = 0;
    for (const ExrPartHeader& part : parts) least += min_exr_chunk_bytes(file, part);
    const ExrPartHeader& first = parts.front();
    check(least <= double(file.count_bytes_left()), Failure::bad_data, name, ": wanted at least ",
          static_cast<std::uint64_t>(std::min(least, 1e18)), " bytes behind its header for ",
          first.exr_data_window_side_length(0), "x", first.exr_data_window_side_length(1),
          " pixels of ", first.channels.size(), " channels, found ", file.count_bytes_left());
    constexpr std::uint64_t kMaxUint32 = std::numeric_limits<std::uint32_t>::max();
    return {
        {static_cast<std::uint32_t>(std::min(first.exr_data_window_side_length(0), kMaxUint32)),
         static_cast<std::uint32_t>(std::min(first.exr_data_window_side_length(1), kMaxUint32))},
        first.channels.size(),
        first.channels};
}

} // namespace catoptric
