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

constexpr std::size_t kMaxNameLength = 255;
constexpr std::uint32_t kTiledFlag = 0x200, kDeepFlag = 0x800, kMultiPartFlag = 0x1000;

/// Reads a file from front to end.
class ExrCursor {
public:
    ExrCursor(const ByteSource& bytes, const std::string& name) : bytes_(bytes), name_(name) {}

    [[noreturn]] void refuse(const auto&... what) const {
        fail(Failure::bad_data, name_, ": cannot be decoded: byte ", at_, ": ", what...);
    }
    std::uint64_t bytes_left() const { return bytes_.size() - at_; }

    std::uint32_t read_uint32() {
        std::array<char, 4> read{};
        read_into(read);
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i)
            value |= std::uint32_t(static_cast<unsigned char>(read[i])) << (8 * i);
        return value;
    }
    std::int32_t read_int32() { return static_cast<std::int32_t>(read_uint32()); }
    std::uint8_t read_byte() {
        std::array<char, 1> read{};
        read_into(read);
        return static_cast<std::uint8_t>(read[0]);
    }
    /// Returns the text up to a zero byte, and skips this byte.
    std::string read_string() {
        std::array<char, kMaxNameLength + 1> read{};
        const std::string_view text(read.data(), bytes_.read(at_, read));
        const std::size_t end = text.find('\0');
        if (end == text.npos) refuse("wanted a name of at most ", kMaxNameLength, " bytes");
        at_ += end + 1;
        return std::string(text.substr(0, end));
    }
    /// Returns whether a zero byte comes next, and skips it if so.
    bool skip_zero() {
        const bool is_zero = read_byte() == 0;
        if (!is_zero) --at_;
        return is_zero;
    }
    /// Throws if fewer than `size` bytes are left.
    void check_left(std::uint64_t size, const char* what) const {
        if (size > bytes_left())
            refuse("wanted ", size, " bytes of ", what, ", found ", bytes_left());
    }
    void skip_bytes(std::uint64_t size) {
        check_left(size, "an attribute");
        at_ += size;
    }
    std::uint64_t position() const { return at_; }
    void seek(std::uint64_t at) { at_ = at; }

private:
    void read_into(std::span<char> into) {
        if (bytes_.read(at_, into) < into.size()) refuse("the file ends in its header");
        at_ += into.size();
    }

    const ByteSource& bytes_;
    const std::string& name_;
    std::uint64_t at_ = 0;
};

/// The header of one part of the file.
struct ExrPart {
    std::vector<std::string> channels;
    std::uint64_t pixel_bytes = 0;
    bool is_subsampled = false;
    std::uint32_t compression = 0;
    std::array<std::int32_t, 4> window{0, 0, -1, -1};
    std::array<std::uint32_t, 2> tile{};
    bool is_tiled = false;
    std::uint64_t chunk_count = 0; ///< as the file claims; 0 if it claims none

    std::uint64_t side(std::size_t axis) const {
        const std::int64_t first = window[axis], last = window[axis + 2];
        return static_cast<std::uint64_t>(std::max<std::int64_t>(0, last - first + 1));
    }
};

void read_channels(ExrCursor& file, ExrPart& part, std::uint64_t end) {
    while (file.position() < end) {
        std::string name = file.read_string();
        if (name.empty()) break;
        if (std::ranges::find(part.channels, name) != part.channels.end())
            file.refuse("wanted one channel of each name, found two of ", quote(name));
        const std::uint32_t type = file.read_uint32();
        file.read_uint32(); // skips the flag for linear data
        const std::uint32_t across = file.read_uint32(), down = file.read_uint32();
        part.is_subsampled |= across != 1 || down != 1;
        part.pixel_bytes += type == 1 ? 2 : 4;
        part.channels.push_back(std::move(name));
    }
}

/// Checks the strings of a vector, because OpenEXR trusts the length of each.
void check_strings(ExrCursor& file, std::uint64_t end) {
    while (file.position() + 4 <= end) {
        const std::uint32_t size = file.read_uint32();
        if (size > end - std::min(end, file.position()))
            file.refuse("a string of ", size, " bytes");
        file.skip_bytes(size);
    }
}

void read_attribute(ExrCursor& file, ExrPart& part, const std::string& name,
                    const std::string& type) {
    const std::uint32_t size = file.read_uint32();
    file.check_left(size, "an attribute");
    const std::uint64_t end = file.position() + size;
    if (name == "channels") {
        read_channels(file, part, end);
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
        check_strings(file, end);
    } else if (type == "preview" && size >= 8) {
        const std::uint64_t width = file.read_uint32(), height = file.read_uint32();
        if (width * height > (size - 8) / 4)
            file.refuse("a preview of ", width, "x", height, " pixels in ", size, " bytes");
    }
    file.seek(end);
}

ExrPart read_part(ExrCursor& file, bool is_tiled) {
    ExrPart part;
    part.is_tiled = is_tiled;
    for (std::string name = file.read_string(); !name.empty(); name = file.read_string()) {
        const std::string type = file.read_string();
        read_attribute(file, part, name, type);
    }
    return part;
}

std::uint32_t lines_per_chunk(std::uint32_t compression) {
    constexpr std::uint32_t kExrLinesPerChunk[] = {1, 1, 1, 16, 32, 16, 32, 32, 32, 256};
    return compression < std::size(kExrLinesPerChunk) ? kExrLinesPerChunk[compression] : 256;
}

/// Returns the most bytes of values that one byte of the file can stand for. RLE stores runs of 128
/// in 2 bytes. Deflate stores at most 1032 bytes in 1. PXR24 drops a quarter of a float before
/// deflate. B44A stores 32 bytes in 3. PIZ's Huffman code stores 256 halves in 10 bits. DWA stores
/// a block of 64 floats in two halves at least, one in such a code and one deflated. The limits of
/// other compressions are not known.
double max_expansion(std::uint32_t compression) {
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
double min_chunk_bytes(const ExrCursor& file, const ExrPart& part) {
    const auto width = double(part.side(0)), height = double(part.side(1));
    double chunks = std::ceil(height / lines_per_chunk(part.compression));
    if (part.is_tiled) {
        // OpenEXR allocates a whole tile, however small the picture is.
        constexpr double kMaxTileSide = 1024;
        const auto [across, down] = part.tile;
        if (across == 0 || down == 0 || across > std::max(kMaxTileSide, width) ||
            down > std::max(kMaxTileSide, height))
            file.refuse("wanted tiles of 1 to ", kMaxTileSide, " pixels a side or as large as the ",
                        "picture, found ", across, "x", down, " for ", width, "x", height);
        chunks = std::ceil(width / across) * std::ceil(height / down);
    }
    const double values = part.is_subsampled ? 0 : width * height * double(part.pixel_bytes);
    return 16 * std::max(chunks, double(part.chunk_count)) +
           std::floor(values / max_expansion(part.compression));
}

} // namespace

ImageShape read_openexr_header(const ByteSource& bytes, const std::string& name) {
    ExrCursor file(bytes, name);
    file.read_uint32(); // skips the magic number
    const std::uint32_t flags = file.read_uint32();
    check((flags & kDeepFlag) == 0, Failure::bad_data, name,
          ": wanted a flat picture, found a deep one");
    std::vector<ExrPart> parts{read_part(file, (flags & kTiledFlag) != 0)};
    if ((flags & kMultiPartFlag) != 0)
        while (!file.skip_zero()) parts.push_back(read_part(file, false));
    double least = 0;
    for (const ExrPart& part : parts) least += min_chunk_bytes(file, part);
    const ExrPart& first = parts.front();
    check(least <= double(file.bytes_left()), Failure::bad_data, name, ": wanted at least ",
          static_cast<std::uint64_t>(std::min(least, 1e18)), " bytes behind its header for ",
          first.side(0), "x", first.side(1), " pixels of ", first.channels.size(),
          " channels, found ", file.bytes_left());
    constexpr std::uint64_t kMaxUint32 = std::numeric_limits<std::uint32_t>::max();
    return {{static_cast<std::uint32_t>(std::min(first.side(0), kMaxUint32)),
             static_cast<std::uint32_t>(std::min(first.side(1), kMaxUint32))},
            first.channels.size(),
            first.channels};
}

} // namespace catoptric
