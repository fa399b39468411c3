// Tests of TIFF headers. The number of pixels that a header claims is compared with the file's size
// before decoding.
#include "core/image_codec.hpp"
#include "core/image_header.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>

#include <map>
#include <string>

namespace {

using namespace catoptric;

std::string encode_number_bytes(std::uint32_t value, int size, bool is_big_endian) {
    std::string text;
    for (int i = 0; i < size; ++i)
        text += static_cast<char>(value >> (8 * (is_big_endian ? size - 1 - i : i)) & 0xff);
    return text;
}

/// Builds a TIFF file with three channels of 8 bits and one strip of `bytes` bytes.
std::string make_tiff_bytes(std::uint32_t width, std::uint32_t height, std::uint32_t compression,
                            std::size_t bytes, bool is_big_endian = false) {
    const auto of = [&](std::uint32_t value, int size) {
        return encode_number_bytes(value, size, is_big_endian);
    };
    std::string entries;
    const auto entry = [&](std::uint32_t tag, bool is_short, std::uint32_t count,
                           std::uint32_t value) {
        entries += of(tag, 2) + of(is_short ? 3 : 4, 2) + of(count, 4) +
                   (is_short && count == 1 ? of(value, 2) + of(0, 2) : of(value, 4));
    };
    entry(256, false, 1, width), entry(257, false, 1, height);
    // The bits per sample of the three channels are stored at byte 8.
    entry(258, true, 3, 8);
    entry(259, true, 1, compression), entry(277, true, 1, 3);
    const std::string text = (is_big_endian ? "MM" : "II") + of(42, 2) + of(14, 4) + of(8, 2) +
                             of(8, 2) + of(8, 2) + of(5, 2) + entries;
    return text + std::string(bytes, '\0');
}

ImageShape read_image_shape(const std::string& file) {
    return read_image_header(MemorySource(file), "tiff", "a.tif").value();
}

TEST(ImageHeader, FormatIsFoundByTheFirstBytes) {
    using namespace std::string_literals;
    for (const auto& [bytes, format] :
         std::map<std::string, std::string>{{"\x89PNG\r\n\x1a\n", "png"},
                                            {"\xff\xd8\xff\xe0", "jpeg"},
                                            {"\x76\x2f\x31\x01", "openexr"},
                                            {"#?RADIANCE\n", "hdr"},
                                            {"BM6", "bmp"},
                                            {"GIF89a", "gif"},
                                            {"GIF87a", "gif"},
                                            {"II*\0"s, "tiff"},
                                            {"MM\0*"s, "tiff"},
                                            {"DDS |", "dds"},
                                            {"8BPS", "psd"},
                                            {"RIFF\x24\0\0\0WEBPVP8 "s, "webp"},
                                            {"RIFF\x24\0\0\0WAVEfmt "s, ""},
                                            {"glTF", ""}})
        EXPECT_EQ(detect_format(bytes), format) << bytes;
}

TEST(TiffHeader, HeaderGivesSizeAndChannelsInEitherByteOrder) {
    for (const bool is_big_endian : {false, true}) {
        const ImageShape shape = read_image_shape(
            make_tiff_bytes(70000, 3, 1, 630000, is_big_endian));
        EXPECT_EQ(shape.size, uvec2(70000, 3)) << is_big_endian;
        EXPECT_EQ(shape.channel_count, 3u) << is_big_endian;
    }
}

TEST(TiffHeader, MorePixelsThanTheFileCanHoldAreRefused) {
    constexpr std::uint32_t kTiffUncompressed = 1, kLzw = 5, kPackBits = 32773, kFax = 4;
    const auto refusal = [](std::uint32_t compression, std::size_t bytes) {
        return test::catch_error_text(Failure::bad_data, [&] {
            read_image_shape(make_tiff_bytes(8192, 8192, compression, bytes));
        });
    };
    EXPECT_THAT(refusal(kTiffUncompressed, 1000),
                testing::HasSubstr("a.tif: wanted at least 201326592 bytes for 8192x8192 pixels"));
    EXPECT_THAT(refusal(kPackBits, 1000), testing::HasSubstr("wanted at least 3145728 bytes"));
    EXPECT_THAT(refusal(kLzw, 1000), testing::HasSubstr("wanted at least 49152 bytes"));
    EXPECT_EQ(read_image_shape(make_tiff_bytes(8192, 8192, kLzw, 50000)).size, uvec2(8192));
    EXPECT_EQ(read_image_shape(make_tiff_bytes(8192, 8192, kFax, 10)).size, uvec2(8192))
        << "any size may do";
}

TEST(TiffHeader, TruncatedFileIsReadOrRefused) {
    const std::string whole = make_tiff_bytes(4, 4, 1, 48);
    for (std::size_t size = 0; size < whole.size(); ++size) try {
            EXPECT_LE(read_image_shape(whole.substr(0, size)).channel_count, 3u) << size;
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::bad_data) << size;
        }
}

} // namespace
