// Writes PNG pictures with libpng. Most programs write only PNG. OpenImageIO would write the same
// bytes, but takes a fifth of a second to load.
#include "core/error.hpp"
#include "core/image_codec.hpp"

#include <png.h>
#include <zlib.h>

#include <csetjmp>
#include <exception>
#include <memory>

namespace catoptric {

namespace {

struct PngDestination {
    std::string bytes, why;
};

void append_png_bytes(png_structp png, png_bytep data, std::size_t size) {
    auto& destination = *static_cast<PngDestination*>(png_get_io_ptr(png));
    try {
        destination.bytes.append(reinterpret_cast<const char*>(data), size);
    } catch (const std::exception&) { // exceptions must not pass through a C library
        png_error(png, "out of memory");
    }
}
void ignore_png_flush(png_structp) {}

[[noreturn]] void fail_png_write(png_structp png, png_const_charp why) {
    auto& destination = *static_cast<PngDestination*>(png_get_error_ptr(png));
    try {
        destination.why = why;
    } catch (const std::exception&) { // reported without the reason
    }
    png_longjmp(png, 1);
}
void ignore_png_write_warning(png_structp, png_const_charp) {}

/// Writes the metadata: sRGB and a constant time, so that equal pictures have equal bytes.
void write_png_metadata(png_structp png, png_infop info) {
    png_set_sRGB_gAMA_and_cHRM(png, info, PNG_sRGB_INTENT_ABSOLUTE);
    png_set_oFFs(png, info, 0, 0, PNG_OFFSET_PIXEL);
    png_time time{.year = 2000, .month = 1, .day = 1, .hour = 0, .minute = 0, .second = 0};
    png_set_tIME(png, info, &time);
    char key[] = "oiio:ColorSpace", value[] = "sRGB";
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = key;
    text.text = value;
    png_set_text(png, info, &text, 1);
}

/// Writes the picture and returns whether this succeeded. libpng leaves by longjmp, so no variable
/// here may have a destructor.
bool write_png_image(png_structp png, png_infop info, const ImageShape& shape,
                     const std::uint8_t* values) {
    if (setjmp(png_jmpbuf(png))) return false;
    constexpr int kPngColourTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA,
                                       PNG_COLOR_TYPE_RGB, PNG_COLOR_TYPE_RGB_ALPHA};
    png_set_IHDR(png, info, shape.size.x, shape.size.y, 8, kPngColourTypes[shape.channel_count - 1],
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, 6);
    png_set_compression_strategy(png, Z_DEFAULT_STRATEGY);
    write_png_metadata(png, info);
    png_write_info(png, info);
    for (std::uint32_t y = 0; y < shape.size.y; ++y)
        png_write_row(png, values + std::size_t(y) * shape.size.x * shape.channel_count);
    png_write_end(png, info);
    return true;
}

} // namespace

std::string encode_png(const ImageShape& shape, std::span<const std::uint8_t> values) {
    const std::size_t count = std::size_t(shape.size.x) * shape.size.y * shape.channel_count;
    check(count > 0 && shape.channel_count <= 4 && values.size() == count, Failure::internal,
          "a picture of ", shape.size.x, "x", shape.size.y,
          " cannot be written as PNG: wanted 1 to 4 channels, found ", shape.channel_count, " and ",
          values.size(), " values");
    PngDestination destination;
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &destination, fail_png_write,
                                              ignore_png_write_warning);
    png_infop info = png ? png_create_info_struct(png) : nullptr;
    const auto destroy = [&](png_structp) { png_destroy_write_struct(&png, &info); };
    const std::unique_ptr<png_struct, decltype(destroy)> owner(png, destroy);
    check(info != nullptr, Failure::exhausted, "not enough memory to encode PNG");
    png_set_write_fn(png, &destination, append_png_bytes, ignore_png_flush);
    check(write_png_image(png, info, shape, values.data()), Failure::internal,
          "libpng cannot encode a picture of ", shape.size.x, "x", shape.size.y, ": ",
          destination.why);
    return std::move(destination.bytes);
}

} // namespace catoptric
