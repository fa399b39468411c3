// Tests of picture files whose headers claim more pixels than the file holds or than the program
// accepts. The program must refuse such files by their headers.
#include "cli/program.hpp"

#include <bit>

namespace {

constexpr std::uint64_t kMostBytes = 50 << 20;

std::string big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    return bytes;
}

std::string little_endian(std::uint32_t value) {
    const std::string bytes = big_endian(value);
    return {bytes.rbegin(), bytes.rend()};
}

/// Returns the CRC-32 checksum that PNG chunks use.
std::uint32_t crc_of(const std::string& bytes) {
    std::uint32_t crc = ~0U;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0);
    }
    return ~crc;
}

std::string chunk(const std::string& kind, const std::string& content) {
    return big_endian(static_cast<std::uint32_t>(content.size())) + kind + content +
           big_endian(crc_of(kind + content));
}

/// Returns a PNG file of 8-bit RGB with `bytes` bytes of pixel data that cannot be decoded.
std::string png(std::uint32_t width, std::uint32_t height, std::size_t bytes) {
    return "\x89PNG\r\n\x1a\n" +
           chunk("IHDR",
                 big_endian(width) + big_endian(height) + std::string("\x08\x02\0\0\0", 5)) +
           chunk("IDAT", std::string(bytes, 'x')) + chunk("IEND", "");
}

std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
    return name + '\0' + type + '\0' + little_endian(static_cast<std::uint32_t>(value.size())) +
           value;
}

/// Returns an OpenEXR file with ZIP compression, three float channels and an empty table of chunks.
/// `last_x`, `last_y`: the largest pixel coordinates. `more`: further header attributes.
std::string exr(std::uint32_t last_x, std::uint32_t last_y, const std::string& more = {}) {
    std::string channels;
    for (const char* name : {"B", "G", "R"})
        channels += std::string(name) + '\0' + little_endian(2) + little_endian(0) +
                    little_endian(1) + little_endian(1);
    const std::string window = little_endian(0) + little_endian(0) + little_endian(last_x) +
                               little_endian(last_y);
    const std::string one = little_endian(std::bit_cast<std::uint32_t>(1.0F));
    return std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) +
           attribute("channels", "chlist", channels + '\0') +
           attribute("compression", "compression", std::string(1, '\3')) +
           attribute("dataWindow", "box2i", window) + attribute("displayWindow", "box2i", window) +
           attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           attribute("pixelAspectRatio", "float", one) +
           attribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
           attribute("screenWindowWidth", "float", one) + more + '\0' + std::string(600, '\0');
}

class PictureBudget : public Cli {
protected:
    void expect_cheap(const Words& words, const std::string& says) const {
        const test::ProcessResult ended = cli(words);
        expect_ended(ended, 65, {says});
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        EXPECT_LT(ended.peak_bytes, kMostBytes) << words[1];
    }
};

TEST_F(PictureBudget, DiffRefusesPicturesByTheirHeaders) {
    write("many.png", png(40000, 40000, 5'000'000));
    expect_cheap({"diff", "many.png", "many.png"},
                 "many.png: wanted at most 536870912 values, found 40000x40000 with 3 channels");
    write("empty.png", png(8192, 8192, 1000));
    expect_cheap({"diff", "empty.png", "empty.png"},
                 "empty.png: wanted at least 195091 bytes for 8192x8192 pixels, found 1057");
    write("long.exr", exr(23, 60000));
    expect_cheap({"diff", "long.exr", "long.exr"}, "pixels of 3 channels, found 600");
    write("wide.exr", exr(0x7ffffffe, 15));
    expect_cheap({"diff", "wide.exr", "wide.exr"},
                 "bytes behind its header for 2147483647x16 pixels");
    write("dark.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9000 +X 9000\n");
    expect_cheap({"diff", "dark.hdr", "dark.hdr"}, "bytes for 9000x9000 pixels, found 51");
}

/// Each attribute holds a number for which the OpenEXR library would allocate memory before it
/// notices that the file ends.
TEST_F(PictureBudget, ExrHeaderWithHugeNumbersIsRefused) {
    const std::string huge = little_endian(0x7fffffff);
    const std::pair<std::string, std::string> wrong[] = {
        {attribute("chunkCount", "int", huge), "bytes behind its header"},
        {attribute("tiles", "tiledesc", huge + huge + '\0'), "wanted tiles of 1 to 1024 pixels"},
        {attribute("preview", "preview", huge + huge), "a preview of 2147483647x2147483647"},
        {attribute("names", "stringvector", huge), "a string of 2147483647 bytes"},
        {std::string("long\0string\0", 12) + huge, "wanted 2147483647 bytes of an attribute"}};
    for (const auto& [more, says] : wrong) {
        write("a.exr", exr(23, 15, more));
        expect_cheap({"diff", "a.exr", "a.exr"}, says);
    }
}

TEST_F(PictureBudget, TooLargeEnvironmentIsRefusedBeforeDecoding) {
    write("sky.png", png(8192, 8192, 196'000));
    expect_cheap({"render", "cornell-mirrors", "--technique", "reuse", "-o", "x.png",
                  "--environment", "sky.png"},
                 "sky.png: wanted an environment of at most 33554432 texels, found 8192x8192");
}

TEST_F(PictureBudget, MaskOfAnotherSizeIsRefusedBeforeDecoding) {
    write("mask.png", png(8192, 8192, 196'000));
    const test::ProcessResult made = cli(
        quick({"render", "cornell-mirrors", "--technique", "reuse", "-o", "a.png"}));
    ASSERT_EQ(made.exit_code, 0) << made.err;
    expect_cheap({"diff", "a.png", "a.png", "--mask", "mask.png"},
                 "mask.png: wanted a mask of 32x32 as the pictures, found 8192x8192");
}

TEST_F(PictureBudget, TooLargeTextureIsRefusedBeforeDecoding) {
    write("wood.png", png(60000, 60000, 11'000'000));
    write("m.mtl", "newmtl m\nmap_Kd wood.png\n");
    write("x.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    expect_cheap({"info", "x.obj"}, "wanted at most 67108864 texels in pictures");
}

TEST_F(PictureBudget, BrokenPngGivesASingleErrorLine) {
    write("broken.png", png(8, 8, 100));
    expect_cheap({"diff", "broken.png", "broken.png"}, "broken.png: cannot be decoded: ");
}

} // namespace
