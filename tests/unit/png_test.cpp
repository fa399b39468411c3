// Compares PNG files that encode_png writes (with libpng) with those that OpenImageIO writes for
// the same values.
#include "core/error.hpp"
#include "core/image_codec.hpp"
#include "core/image_module.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace catoptric {
namespace {

/// Returns the values of a picture with runs of equal values between varying values, so that each
/// of PNG's filters is used somewhere.
std::vector<std::uint8_t> make_png_test_values(uvec2 size, std::size_t channel_count) {
    std::vector<std::uint8_t> values(std::size_t(size.x) * size.y * channel_count);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<std::uint8_t>(i % 7 < 3 ? i / 16 : i * i * 31 >> 3);
    return values;
}

TEST(Png, PngBytesEqualThoseOfOpenImageIO) {
    for (const uvec2 size : {uvec2(1, 1), uvec2(7, 3), uvec2(300, 200)})
        for (std::size_t channel_count = 1; channel_count <= 4; ++channel_count) {
            const std::vector<std::uint8_t> values = make_png_test_values(size, channel_count);
            const PixelType type = PixelType::uint8;
            std::string wanted;
            const CodecResult made = image_codecs().encode(
                "png", {size, channel_count, type, values.data()}, wanted);
            ASSERT_EQ(made.answer, CodecStatus::done) << made.why;
            EXPECT_TRUE(encode_png({size, channel_count, {}}, values) == wanted)
                << size.x << "x" << size.y << " with " << channel_count << " channels";
        }
}

TEST(Png, UnwritablePicturesAreRefusedWithTheReason) {
    const std::vector<std::uint8_t> values(10);
    EXPECT_THAT(test::catch_error_text(Failure::internal,
                                       [&] {
                                           encode_png({{2, 1}, 5, {}}, values);
                                       }),
                testing::HasSubstr("a picture of 2x1 cannot be written as PNG: wanted 1 to 4 "
                                   "channels, found 5 and 10 values"));
    EXPECT_THAT(
        test::catch_error_text(Failure::internal,
                               [&] {
                                   encode_png({{2, 2}, 3, {}}, values);
                               }),
        testing::HasSubstr("2x2 cannot be written as PNG: wanted 1 to 4 channels, found 3 and 10"));
    const std::vector<std::uint8_t> row(2'000'000);
    EXPECT_THAT(test::catch_error_text(Failure::internal,
                                       [&] {
                                           encode_png({{2'000'000, 1}, 1, {}}, row);
                                       }),
                testing::HasSubstr("libpng cannot encode a picture of 2000000x1: "));
}

} // namespace
} // namespace catoptric
