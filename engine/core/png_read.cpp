#include "core/png_read.hpp"

#include "core/error.hpp"
#include "core/text.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstdint>
#include <exception>
#include <type_traits>
#include <vector>

namespace catoptric {

namespace {

struct PngSource {
    const ByteSource& bytes;
    std::uint64_t at = 0;
    std::string why;
};

[[noreturn]] void fail_png_read(png_structp png, png_const_charp why) {
    auto& origin = *static_cast<PngSource*>(png_get_error_ptr(png));
    try {
        origin.why = escape(why);
    } catch (const std::exception&) { // reported without the reason
    }
    png_longjmp(png, 1);
}
void ignore_png_read_warning(png_structp, png_const_charp) {}

void read_png_bytes(png_structp png, png_bytep into, std::size_t size) {
    auto& origin = *static_cast<PngSource*>(png_get_io_ptr(png));
    bool is_whole = false;
    try {
        is_whole = origin.bytes.read(origin.at, {reinterpret_cast<char*>(into), size}) == size;
    } catch (const std::exception&) { // exceptions must not pass through a C library
    }
    if (!is_whole) png_error(png, "the file ends early");
    origin.at += size;
}

// libpng may leave these functions by longjmp, so no variable in them may have a destructor.

/// Reads the file up to the first values. Returns whether this succeeded.
bool read_png_header(png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_info(png, info);
    return true;
}

bool start_png_rows(png_structp png, png_infop info) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_set_expand(png); // expands to 8 bits and alpha
    png_read_update_info(png, info);
    return true;
}

bool read_png_row(png_structp png, png_bytep row) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_row(png, row, nullptr);
    return true;
}

bool read_png_rows(png_structp png, png_bytepp rows) {
    if (setjmp(png_jmpbuf(png))) return false;
    png_read_image(png, rows);
    return true;
}

/// Converts a row of values of 8 bits, or of 16 bits with the high byte first.
template <typename Value>
void convert_row(const std::uint8_t* row, std::size_t count, bool is_wide, Value* values) {
    constexpr bool kIsFloatPixelValue = std::is_same_v<Value, float>;
    if (!is_wide) {
        if constexpr (kIsFloatPixelValue)
            std::transform(row, row + count, values,
                           [](std::uint8_t value) { return float(value) * (1.0F / 255); });
        else
            std::copy_n(row, count, values);
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t value = std::uint32_t(row[2 * i]) << 8 | row[2 * i + 1];
        if constexpr (kIsFloatPixelValue)
            values[i] = float(value) * (1.0F / 65535);
        else
            values[i] = static_cast<std::uint8_t>((value + 128) / 257);
    }
}

} // namespace

struct PngReader::State {
    State(const ByteSource& bytes, const std::string& its_name) : origin{bytes}, name(its_name) {
        png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &origin, fail_png_read,
                                     ignore_png_read_warning);
        info = png ? png_create_info_struct(png) : nullptr;
        if (!info) {
            png_destroy_read_struct(&png, &info, nullptr);
            fail(Failure::exhausted, name, ": not enough memory to decode it");
        }
        png_set_read_fn(png, &origin, read_png_bytes);
        png_set_user_limits(png, ImageReader::kMaxSide, ImageReader::kMaxSide);
        limit_chunk_memory();
    }
    ~State() { png_destroy_read_struct(&png, &info, nullptr); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    /// libpng allocates as many bytes as a chunk claims, before it reads them. So only chunks that
    /// change pixels are read, and none that is longer than the file.
    void limit_chunk_memory() const {
        constexpr std::uint64_t kMinChunkBytes = 4096;
        png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
        png_set_chunk_malloc_max(png, std::max(origin.bytes.size(), kMinChunkBytes));
    }

    void throw_unless(bool works) const {
        if (works) return;
        fail(Failure::bad_data, name, ": cannot be decoded", origin.why.empty() ? "" : ": ",
             origin.why);
    }
    /// Throws if the picture has more values than deflate can store in the file.
    void check_size() const {
        const std::uint64_t bits = std::uint64_t(png_get_bit_depth(png, info)) *
                                   png_get_channels(png, info);
        const std::uint64_t row_bytes = 1 + (png_get_image_width(png, info) * bits + 7) / 8;
        const std::uint64_t least = row_bytes * png_get_image_height(png, info) / 1032;
        check(least <= origin.bytes.size(), Failure::bad_data, name, ": wanted at least ", least,
              " bytes for ", png_get_image_width(png, info), "x", png_get_image_height(png, info),
              " pixels, found ", origin.bytes.size());
    }

    PngSource origin;
    std::string name;
    png_structp png = nullptr;
    png_infop info = nullptr;
    uvec2 size{0};
    std::size_t channel_count = 0;
    bool is_wide = false, is_interlaced = false;
    bool is_started = false;
    std::uint32_t next = 0;               ///< number of the next row
    std::vector<std::uint8_t> row, whole; ///< `row`: one row; `whole`: an interlaced picture
};

PngReader::PngReader(const ByteSource& bytes, const std::string& name)
    : state_(std::make_unique<State>(bytes, name)) {
    State& open = *state_;
    open.throw_unless(read_png_header(open.png, open.info));
    open.size = {png_get_image_width(open.png, open.info),
                 png_get_image_height(open.png, open.info)};
    const int colours = png_get_color_type(open.png, open.info);
    const bool has_alpha = (colours & PNG_COLOR_MASK_ALPHA) != 0 ||
                           png_get_valid(open.png, open.info, PNG_INFO_tRNS) != 0;
    open.channel_count = std::size_t((colours & PNG_COLOR_MASK_COLOR) != 0 ? 3 : 1) + has_alpha;
    open.is_wide = png_get_bit_depth(open.png, open.info) == 16;
    open.is_interlaced = png_get_interlace_type(open.png, open.info) != PNG_INTERLACE_NONE;
}

PngReader::~PngReader() = default;

void PngReader::check_size() const { state_->check_size(); }

ImageShape PngReader::shape() const {
    constexpr const char* kGreyChannelNames[] = {"Y", "A"};
    constexpr const char* kColourChannelNames[] = {"R", "G", "B", "A"};
    const bool is_grey = state_->channel_count < 3;
    const char* const* const names = is_grey ? kGreyChannelNames : kColourChannelNames;
    return {.size = state_->size,
            .channel_count = state_->channel_count,
            .channels = {names, names + state_->channel_count},
            .description = {},
            .is_8_bit = !state_->is_wide};
}

void PngReader::read_rows(std::uint32_t first, std::uint32_t row_count, PixelType type,
                          void* values) {
    State& open = *state_;
    check(first == open.next && row_count <= open.size.y - first, Failure::internal, open.name,
          ": wanted row ", open.next, " to be read next, found ", first);
    const std::size_t count = std::size_t(open.size.x) * open.channel_count;
    const std::size_t row_bytes = count * (open.is_wide ? 2 : 1);
    if (!open.is_started) {
        open.throw_unless(start_png_rows(open.png, open.info));
        check(png_get_rowbytes(open.png, open.info) == row_bytes, Failure::internal, open.name,
              ": wanted ", row_bytes, " bytes a row, found ",
              png_get_rowbytes(open.png, open.info));
        open.is_started = true;
        open.row.resize(row_bytes);
        if (open.is_interlaced) {
            open.whole.resize(row_bytes * open.size.y);
            std::vector<png_bytep> rows(open.size.y);
            for (std::size_t y = 0; y < rows.size(); ++y)
                rows[y] = open.whole.data() + y * row_bytes;
            open.throw_unless(read_png_rows(open.png, rows.data()));
        }
    }
    for (std::uint32_t y = 0; y < row_count; ++y) {
        const std::uint8_t* row = open.row.data();
        if (open.is_interlaced)
            row = open.whole.data() + std::size_t(first + y) * row_bytes;
        else
            open.throw_unless(read_png_row(open.png, open.row.data()));
        if (type == PixelType::float32)
            convert_row(row, count, open.is_wide, static_cast<float*>(values) + y * count);
        else
            convert_row(row, count, open.is_wide, static_cast<std::uint8_t*>(values) + y * count);
    }
    open.next += row_count;
}

} // namespace catoptric
