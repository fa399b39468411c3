// Tests of picture files whose headers claim more pixels than the file holds or than the program
// accepts. The program must refuse such files by their headers.
#include "cli/program.hpp"

#include <bit>

namespace {

constexpr std::uint64_t kMaxMemoryBytes = 50 << 20;

std::string encode_big_endian(std::uint32_t value) {
    std::string bytes;
    for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    return bytes;
}

std::string encode_little_endian(std::uint32_t value) {
    const std::string bytes = encode_big_endian(value);
    return {bytes.rbegin(), bytes.rend()};
}

/// Returns the CRC-32 checksum that PNG chunks use.
std::uint32_t compute_png_crc(const std::string& bytes) {
    std::uint32_t crc = ~0U;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320U : 0);
    }
    return ~crc;
}

std::string make_png_chunk(const std::string& kind, const std::string& content) {
    return encode_big_endian(static_cast<std::uint32_t>(content.size())) + kind + content +
           encode_big_endian(compute_png_crc(kind + content));
}

/// Returns a PNG file of 8-bit RGB with `bytes` bytes of pixel data that cannot be decoded.
std::string make_png_bytes(std::uint32_t width, std::uint32_t height, std::size_t bytes) {
    return "\x89PNG\r\n\x1a\n" +
           make_png_chunk("IHDR", encode_big_endian(width) + encode_big_endian(height) +
                                      std::string("\x08\x02\0\0\0", 5)) +
           make_png_chunk("IDAT", std::string(bytes, 'x')) + make_png_chunk("IEND", "");
}

std::string make_exr_attribute(const std::string& name, const std::string& type,
                               const std::string& value) {
    return name + '\0' + type + '\0' +
           encode_little_endian(static_cast<std::uint32_t>(value.size())) + value;
}

/// Returns an OpenEXR file with ZIP compression, three float channels and an empty table of chunks.
/// `last_x`, `last_y`: the largest pixel coordinates. `more`: further header attributes.
/// `compression`: 3 for ZIP, 4 for PIZ, 8 for DWAA.
std::string make_exr_bytes(std::uint32_t last_x, std::uint32_t last_y, const std::string& more = {},
                           char compression = 3) {
    std::string channels;
    for (const char* name : {"B", "G", "R"})
        channels += std::string(name) + '\0' + encode_little_endian(2) + encode_little_endian(0) +
                    encode_little_endian(1) + encode_little_endian(1);
    const std::string window = encode_little_endian(0) + encode_little_endian(0) +
                               encode_little_endian(last_x) + encode_little_endian(last_y);
    const std::string one = encode_little_endian(std::bit_cast<std::uint32_t>(1.0F));
    return std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) +
           make_exr_attribute("channels", "chlist", channels + '\0') +
           make_exr_attribute("compression", "compression", std::string(1, compression)) +
           make_exr_attribute("dataWindow", "box2i", window) +
           make_exr_attribute("displayWindow", "box2i", window) +
           make_exr_attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
           make_exr_attribute("pixelAspectRatio", "float", one) +
           make_exr_attribute("screenWindowCenter", "v2f", std::string(8, '\0')) +
           make_exr_attribute("screenWindowWidth", "float", one) + more + '\0' +
           std::string(600, '\0');
}

class PictureMemoryBudgetCliTest : public CommandLineTest {
protected:
    void expect_small_memory_use(const Words& words, const std::string& says) const {
        const test::ProcessResult ended = run_cli(words);
        expect_exit_code(ended, 65, {says});
        EXPECT_EQ(std::ranges::count(ended.err, '\n'), 1) << ended.err;
        EXPECT_LT(ended.peak_bytes, kMaxMemoryBytes) << words[1];
    }
};

TEST_F(PictureMemoryBudgetCliTest, DiffRefusesPicturesByTheirHeaders) {
    write_input_file("many.png", make_png_bytes(40000, 40000, 5'000'000));
    expect_small_memory_use(
        {"diff", "many.png", "many.png"},
        "many.png: wanted at most 536870912 values, found 40000x40000 with 3 channels");
    write_input_file("empty.png", make_png_bytes(8192, 8192, 1000));
    expect_small_memory_use(
        {"diff", "empty.png", "empty.png"},
        "empty.png: wanted at least 195091 bytes for 8192x8192 pixels, found 1057");
    write_input_file("long.exr", make_exr_bytes(23, 60000));
    expect_small_memory_use({"diff", "long.exr", "long.exr"}, "pixels of 3 channels, found 600");
    write_input_file("wide.exr", make_exr_bytes(0x7ffffffe, 15));
    expect_small_memory_use({"diff", "wide.exr", "wide.exr"},
                            "bytes behind its header for 2147483647x16 pixels");
    write_input_file("dark.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 9000 +X 9000\n");
    expect_small_memory_use({"diff", "dark.hdr", "dark.hdr"},
                            "bytes for 9000x9000 pixels, found 51");
}

/// Each attribute holds a number for which the OpenEXR library would allocate memory before it
/// notices that the file ends.
TEST_F(PictureMemoryBudgetCliTest, ExrHeaderWithHugeNumbersIsRefused) {
    const std::string huge = encode_little_endian(0x7fffffff);
    const std::pair<std::string, std::string> wrong[] = {
        {make_exr_attribute("chunkCount", "int", huge), "bytes behind its header"},
        {make_exr_attribute("tiles", "tiledesc", huge + huge + '\0'),
         "wanted tiles of 1 to 1024 pixels"},
        {make_exr_attribute("preview", "preview", huge + huge),
         "a preview of 2147483647x2147483647"},
        {make_exr_attribute("names", "stringvector", huge), "a string of 2147483647 bytes"},
        {std::string("long\0string\0", 12) + huge, "wanted 2147483647 bytes of an attribute"}};
    for (const auto& [more, says] : wrong) {
        write_input_file("a.exr", make_exr_bytes(23, 15, more));
        expect_small_memory_use({"diff", "a.exr", "a.exr"}, says);
    }
}

/// A picture may be one tile, which OpenEXR decodes as a whole. A small file of such a tile took
/// gigabytes.
TEST_F(PictureMemoryBudgetCliTest, LargeTileInASmallExrFileIsRefused) {
    const std::string side = encode_little_endian(16384);
    for (const char compression : {'\3', '\4', '\x8', '\x9'}) {
        std::string file = make_exr_bytes(
            16383, 16383, make_exr_attribute("tiles", "tiledesc", side + side + '\0'), compression);
        file[5] = '\2'; // the file has tiles
        write_input_file("tile.exr", file);
        for (const Words& words : {Words{"diff", "tile.exr", "tile.exr"},
                                   {"info", "cornell-mirrors", "--environment", "tile.exr"}})
            expect_small_memory_use(words, "bytes behind its header for 16384x16384 pixels");
    }
}

TEST_F(PictureMemoryBudgetCliTest, TooLargeEnvironmentIsRefusedBeforeDecoding) {
    write_input_file("sky.png", make_png_bytes(8192, 8192, 196'000));
    expect_small_memory_use(
        {"render", "cornell-mirrors", "--technique", "reuse", "-o", "x.png", "--environment",
         "sky.png"},
        "sky.png: wanted an environment of at most 33554432 texels, found 8192x8192");
}

TEST_F(PictureMemoryBudgetCliTest, MaskOfAnotherSizeIsRefusedBeforeDecoding) {
    write_input_file("mask.png", make_png_bytes(8192, 8192, 196'000));
    const test::ProcessResult made = run_cli(add_small_frame_options(
        {"render", "cornell-mirrors", "--technique", "reuse", "-o", "a.png"}));
    ASSERT_EQ(made.exit_code, 0) << made.err;
    expect_small_memory_use({"diff", "a.png", "a.png", "--mask", "mask.png"},
                            "mask.png: wanted a mask of 32x32 as the pictures, found 8192x8192");
}

TEST_F(PictureMemoryBudgetCliTest, TooLargeTextureIsRefusedBeforeDecoding) {
    write_input_file("wood.png", make_png_bytes(60000, 60000, 11'000'000));
    write_input_file("m.mtl", "newmtl m\nmap_Kd wood.png\n");
    write_input_file("x.obj",
                     "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    expect_small_memory_use({"info", "x.obj"}, "wanted at most 67108864 texels in pictures");
}

TEST_F(PictureMemoryBudgetCliTest, PhotoshopSectionThatClaimsGigabytesIsRefused) {
    const auto make_psd = [](std::uint32_t colours, std::uint32_t resources) {
        return "8BPS" + std::string("\0\1\0\0\0\0\0\0\0\3", 10) + encode_big_endian(4) +
               encode_big_endian(4) + std::string("\0\10\0\3", 4) + encode_big_endian(colours) +
               encode_big_endian(resources) + std::string(100, '\0');
    };
    write_input_file("m.mtl", "newmtl m\nmap_Kd wood.psd\n");
    write_input_file("x.obj",
                     "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
    write_input_file("wood.psd", make_psd(0x7fffffff, 0));
    expect_small_memory_use({"info", "x.obj"}, "found 2147483647 bytes");
    write_input_file("wood.psd", make_psd(0, 0xffffffff));
    expect_small_memory_use({"info", "x.obj"}, "wanted image resources within 134 bytes of file");
}

TEST_F(PictureMemoryBudgetCliTest, BrokenPngGivesASingleErrorLine) {
    write_input_file("broken.png", make_png_bytes(8, 8, 100));
    expect_small_memory_use({"diff", "broken.png", "broken.png"},
                            "broken.png: cannot be decoded: ");
}

} // namespace
