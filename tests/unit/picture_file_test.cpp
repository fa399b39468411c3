#include "measure/picture_file.hpp"

#include "core/file.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <limits>

namespace catoptric::measure {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class PictureFile : public test::InFolder {
protected:
    fs::path write_picture_bytes(const std::string& name, const std::string& bytes) const {
        write_file(folder / name, bytes);
        return folder / name;
    }
};

std::string decode_hex(const std::string& hex) {
    std::string bytes;
    for (std::size_t i = 0; i < hex.size(); i += 2)
        bytes += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
    return bytes;
}

// The PNG files below were written by a Python script with zlib and struct, not by this engine.
// kRgb8PngBytes has 2x2 pixels with 8 bits per channel: (255 188 0)(1 2 3), then (0 0 0)(128 64
// 32).
const std::string kRgb8PngBytes = decode_hex(
    "89504e470d0a1a0a0000000d4948445200000002000000020802000000fdd49a73000000144944415478da63f8bf"
    "878191899901081a1c1400182502a223acfc8a0000000049454e44ae426082");
// A PNG of one pixel, (188 188 188). Its gAMA chunk claims that the values are linear.
const std::string kLinearGammaPngBytes = decode_hex(
    "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000467414d41000186a031"
    "e8965f0000000c4944415478da63d8b3670f00046c02355d11ef200000000049454e44ae426082");
// A PNG of two grey pixels with 16 bits each: 65535 and 32768.
const std::string kGrey16PngBytes = decode_hex(
    "89504e470d0a1a0a0000000d494844520000000200000001100000000081d9fc150000000d4944415478da63f8ff"
    "bf81010007fe027fad8392250000000049454e44ae426082");
// A PNG of three RGBA pixels: transparent (255 128 0 | 0), opaque black (0 0 0 | 255) and half
// transparent (0 0 1 | 128).
const std::string kRgba8PngBytes = decode_hex(
    "89504e470d0a1a0a0000000d49484452000000030000000108060000001be014b4000000124944415478da63f8df"
    "c00002ff1918181b0016fe030063c4645b0000000049454e44ae426082");

/// Returns a 2x1 OpenEXR file of 16-bit floats, (1 0.5 -2)(inf NaN 65504). The bytes follow the
/// documented file layout and are written here without a library.
std::string make_half_float_exr() {
    std::string bytes("\x76\x2f\x31\x01\x02\0\0\0", 8);
    const auto number = [](std::uint32_t value, int size) {
        std::string text;
        for (int i = 0; i < size; ++i) text += static_cast<char>(value >> (8 * i) & 255U);
        return text;
    };
    const auto attribute = [&](const char* name, const char* type, const std::string& value) {
        bytes += std::string(name) + '\0' + type + '\0' +
                 number(static_cast<std::uint32_t>(value.size()), 4) + value;
    };
    std::string channels;
    for (const char* name : {"B", "G", "R"})
        channels += std::string(name) + '\0' + number(1, 4) + number(0, 4) + number(1, 4) +
                    number(1, 4);
    const std::string window = number(0, 4) + number(0, 4) + number(1, 4) + number(0, 4);
    const std::string one = number(std::bit_cast<std::uint32_t>(1.0F), 4);
    attribute("channels", "chlist", channels + '\0');
    attribute("compression", "compression", std::string(1, '\0'));
    attribute("dataWindow", "box2i", window);
    attribute("displayWindow", "box2i", window);
    attribute("lineOrder", "lineOrder", std::string(1, '\0'));
    attribute("pixelAspectRatio", "float", one);
    attribute("screenWindowCenter", "v2f", std::string(8, '\0'));
    attribute("screenWindowWidth", "float", one);
    bytes += '\0';
    // The offset of the first scan line in the file.
    bytes += number(static_cast<std::uint32_t>(bytes.size()) + 8, 4) + number(0, 4);
    bytes += number(0, 4) + number(12, 4);
    for (const std::uint32_t half : {0xC000U, 0x7BFFU, 0x3800U, 0x7E00U, 0x3C00U, 0x7C00U})
        bytes += number(half, 2);
    return bytes;
}

Picture make_picture_of_extreme_values() {
    Picture picture(3, 2);
    picture.at(0, 0) = vec3(0, -0.0F, 1);
    picture.at(1, 0) = vec3(std::numeric_limits<float>::infinity(), -3.5F, 1e30F);
    picture.at(2, 0) = vec3(std::numeric_limits<float>::quiet_NaN(), 0.1F, 1e-40F);
    picture.at(0, 1) = vec3(0.25F, 0.5F, 0.75F);
    picture.at(1, 1) = vec3(1.0F / 3, 17, 4);
    picture.at(2, 1) = vec3(1e-8F, 65504, 65536);
    return picture;
}

TEST_F(PictureFile, ExrFileKeepsEveryBitOfAPicture) {
    const Picture picture = make_picture_of_extreme_values();
    write_exr(picture, folder / "a.exr");
    const Picture back = read_picture(folder / "a.exr");
    ASSERT_EQ(back.width, 3);
    ASSERT_EQ(back.height, 2);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        EXPECT_EQ(std::memcmp(&picture.pixels[i], &back.pixels[i], sizeof(vec3)), 0) << i;
}

TEST_F(PictureFile, EqualPicturesGiveFilesOfEqualBytes) {
    const std::string exr = encode_exr(make_picture_of_extreme_values());
    EXPECT_THAT(exr, HasSubstr("2000:01:01 00:00:00")); // the date in files is constant
    EXPECT_EQ(exr, encode_exr(make_picture_of_extreme_values()));
    EXPECT_EQ(encode_png(make_picture_of_extreme_values()),
              encode_png(make_picture_of_extreme_values()));
    write_png(make_picture_of_extreme_values(), folder / "a.png");
    EXPECT_EQ(read_file(folder / "a.png"), encode_png(make_picture_of_extreme_values()));
}

TEST_F(PictureFile, WrittenPngIsEightBitRgbRoundedAndClamped) {
    Picture display(2, 1);
    display.at(0, 0) = vec3(-1, 0.5F, std::numeric_limits<float>::quiet_NaN());
    display.at(1, 0) = vec3(2, 187.4F / 255, 187.6F / 255);
    const std::string png = encode_png(display);
    EXPECT_EQ(png[24], 8); // bits per channel, in the IHDR chunk
    EXPECT_EQ(png[25], 2); // colour type RGB, in the IHDR chunk
    write_png(display, folder / "a.png");
    const Picture shown = to_display(read_picture(folder / "a.png"));
    EXPECT_EQ(shown.at(0, 0), vec3(0, 128.0F / 255, 0));
    EXPECT_EQ(shown.at(1, 0), vec3(1, 187.0F / 255, 188.0F / 255));
}

TEST_F(PictureFile, ReadPngIsDecodedFromSrgb) {
    const Picture picture = read_picture(write_picture_bytes("a.png", kRgb8PngBytes));
    EXPECT_EQ(picture.at(0, 0).x, 1.0F);
    EXPECT_NEAR(picture.at(0, 0).y, 0.502886, 1e-6); // ((188/255 + 0.055) / 1.055)^2.4
    EXPECT_EQ(picture.at(0, 0).z, 0.0F);
    EXPECT_NEAR(picture.at(1, 0).x, 1 / 255.0 / 12.92, 1e-9);
    EXPECT_NEAR(picture.at(1, 1).y, 0.051269, 1e-6);
    EXPECT_NEAR(read_picture(write_picture_bytes("gamma.png", kLinearGammaPngBytes)).at(0, 0).x,
                0.502886, 1e-6);
}

TEST_F(PictureFile, SixteenBitGreyPngIsReadAsRgb) {
    const Picture picture = read_picture(write_picture_bytes("a.png", kGrey16PngBytes));
    EXPECT_EQ(picture.at(0, 0), vec3(1));
    EXPECT_NEAR(picture.at(1, 0).x, 0.214053, 1e-5); // 32768 / 65535, decoded from sRGB
    EXPECT_EQ(picture.at(1, 0).x, picture.at(1, 0).z);
}

TEST_F(PictureFile, AlphaOfAPngIsIgnored) {
    const Picture picture = read_picture(write_picture_bytes("a.png", kRgba8PngBytes));
    EXPECT_EQ(picture.at(0, 0).x, 1.0F);
    EXPECT_NEAR(picture.at(0, 0).y, 0.215861, 1e-6);
    EXPECT_EQ(picture.at(1, 0), vec3(0));
}

TEST_F(PictureFile, HalfFloatExrOfAnotherWriterIsRead) {
    const Picture picture = read_picture(write_picture_bytes("a.exr", make_half_float_exr()));
    EXPECT_EQ(picture.at(0, 0), vec3(1, 0.5F, -2));
    EXPECT_TRUE(std::isinf(picture.at(1, 0).x));
    EXPECT_TRUE(std::isnan(picture.at(1, 0).y));
    EXPECT_EQ(picture.at(1, 0).z, 65504.0F);
}

TEST_F(PictureFile, FileFormatIsFoundByContentNotByName) {
    EXPECT_EQ(read_picture(write_picture_bytes("a.exr", kRgb8PngBytes)).at(0, 0).x, 1.0F);
}

TEST_F(PictureFile, MaskSelectsPixelsThatAreNotZero) {
    EXPECT_EQ(read_mask(write_picture_bytes("a.png", kRgb8PngBytes), 2, 2),
              (Mask{255, 255, 0, 255}));
    EXPECT_EQ(read_mask(write_picture_bytes("b.png", kRgba8PngBytes), 3, 1), (Mask{255, 0, 255}));
    EXPECT_THAT(
        test::catch_error_text(Failure::bad_data, [&] { read_mask(folder / "a.png", 4, 2); }),
        HasSubstr("a.png: wanted a mask of 4x2 as the pictures, found 2x2"));
    EXPECT_THAT(test::catch_error_text(
                    Failure::bad_data,
                    [&] { read_mask(write_picture_bytes("c.exr", make_half_float_exr()), 2, 1); }),
                HasSubstr("c.exr: wanted a PNG as mask, found OpenEXR"));
}

TEST_F(PictureFile, MissingAndUndecodableFilesAreRefused) {
    EXPECT_THAT(
        test::catch_error_text(Failure::missing_input, [&] { read_picture(folder / "no.png"); }),
        HasSubstr("no.png"));
    EXPECT_THAT(
        test::catch_error_text(Failure::bad_data,
                               [&] { read_picture(write_picture_bytes("t.png", "Hello")); }),
        HasSubstr("t.png: wanted an OpenEXR, Radiance or PNG picture, found 5 bytes"));
    EXPECT_THAT(test::catch_error_text(Failure::bad_data,
                                       [&] { read_picture(write_picture_bytes("e.png", "")); }),
                HasSubstr("found 0 bytes"));
}

TEST_F(PictureFile, TruncatedFilesAreRefusedAtEveryLength) {
    const auto refuses = [&](const std::string& name, const std::string& whole, std::size_t size) {
        const fs::path path = write_picture_bytes(name, whole.substr(0, size));
        const std::string text = test::catch_error_text(Failure::bad_data,
                                                        [&] { read_picture(path); });
        EXPECT_THAT(text, HasSubstr(name)) << size << " of " << whole.size();
        EXPECT_THAT(text, Not(HasSubstr("\n")));
    };
    const std::string exr = make_half_float_exr();
    for (std::size_t size = 0; size < exr.size(); size += 7) refuses("cut.exr", exr, size);
    refuses("cut.exr", exr, exr.size() - 1);
    for (std::size_t size = 0; size < 60; size += 3) refuses("cut.png", kRgb8PngBytes, size);
}

TEST_F(PictureFile, FailedWriteKeepsTheOldFile) {
    const fs::path old = write_picture_bytes("old.png", "old");
    EXPECT_THAT(test::catch_error_text(Failure::internal, [&] { write_png(Picture(), old); }),
                HasSubstr("a picture of 0x0 cannot be written"));
    EXPECT_EQ(read_file(old), "old");
}

TEST_F(PictureFile, PathsThatCannotBeWrittenAreRefused) {
    const Picture picture(2, 2);
    EXPECT_THAT(test::catch_error_text(Failure::cannot_create, [&] { write_png(picture, folder); }),
                HasSubstr(folder.string()));
    EXPECT_THAT(test::catch_error_text(Failure::cannot_create,
                                       [&] { write_exr(picture, folder / "none" / "a.exr"); }),
                HasSubstr("none/a.exr"));
    EXPECT_THAT(test::catch_error_text(Failure::io, [&] { write_png(picture, "/dev/full"); }),
                HasSubstr("/dev/full")); // writing to /dev/full fails as on a full disk
}

} // namespace
} // namespace catoptric::measure
