// Compares OpenEXR files that encode_openexr writes with those that OpenImageIO writes for the same
// values, and OpenEXR files that ImageReader reads with what OpenImageIO reads.
#include "core/byte_source.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_codec.hpp"
#include "core/image_module.hpp"
#include "support/folder.hpp"
#include "support/process.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace catoptric {
namespace {

class Exr : public test::InFolder {};

std::vector<float> make_exr_test_values(uvec2 size, std::size_t channel_count) {
    std::vector<float> values(std::size_t(size.x) * size.y * channel_count);
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = i % 7 < 3 ? float(i / 16) : std::sin(float(i)) * 1e3f;
    values.front() = std::numeric_limits<float>::infinity();
    return values;
}

std::string encode_with_openimageio(const ImageShape& shape, std::span<const float> values) {
    std::string bytes;
    const CodecResult made = image_codecs().encode("openexr",
                                                   {shape.size, shape.channel_count,
                                                    PixelType::float32, values.data(),
                                                    shape.channels, shape.description},
                                                   bytes);
    EXPECT_EQ(made.answer, CodecStatus::done) << made.why;
    return bytes;
}

TEST_F(Exr, ExrBytesEqualThoseOfOpenImageIO) {
    const std::vector<std::string> layers{"R", "G", "B", "normal.X", "distance.Z", "a"};
    for (const uvec2 size : {uvec2(1, 1), uvec2(7, 3), uvec2(300, 200)}) {
        for (std::size_t channel_count = 1; channel_count <= 4; ++channel_count) {
            const std::vector<float> values = make_exr_test_values(size, channel_count);
            const ImageShape shape{size, channel_count, {}};
            EXPECT_TRUE(encode_openexr(shape, values) == encode_with_openimageio(shape, values))
                << size.x << "x" << size.y << " with " << channel_count << " channels";
        }
        const std::vector<float> values = make_exr_test_values(size, layers.size());
        const ImageShape shape{size, layers.size(), layers, "made by a test"};
        EXPECT_TRUE(encode_openexr(shape, values) == encode_with_openimageio(shape, values))
            << size.x << "x" << size.y << " with layers";
    }
}

TEST_F(Exr, UnwritableExrPicturesAreRefusedWithTheReason) {
    EXPECT_THAT(test::catch_error_text(Failure::internal,
                                       [&] {
                                           encode_openexr({{2, 1}, 5, {}}, std::vector<float>(10));
                                       }),
                testing::HasSubstr("a picture of 2x1 cannot be written as OpenEXR: wanted a name "
                                   "for each channel, found 4 names for 5 channels and 10 values"));
}

/// Reads the floats of a file with OpenImageIO alone.
std::vector<float> read_with_openimageio(const ByteSource& bytes,
                                         std::vector<std::string>& channels) {
    ImageCodecs::Picture* picture = nullptr;
    ImageCodecs::Header header;
    EXPECT_EQ(image_codecs().open(bytes, "openexr", "x", picture, header).answer,
              CodecStatus::done);
    channels = header.channels;
    std::vector<float> values(std::size_t(header.size.x * header.size.y * header.channel_count));
    EXPECT_EQ(
        image_codecs()
            .read(*picture, 0, std::uint32_t(header.size.y), PixelType::float32, values.data())
            .answer,
        CodecStatus::done);
    image_codecs().close(picture);
    return values;
}

// oiiotool turns a file of encode_openexr into files of other kinds: halves, tiles, other
// compressions, other channels. ExrColourReader must read the colours that OpenImageIO reads.
TEST_F(Exr, ColoursOfAllKindsAreThoseOfOpenImageIo) {
    const std::vector<std::string> channels{"B", "A", "R", "G"};
    const ImageShape shape{{37, 29}, 4, channels, "a text"};
    std::vector<float> values = make_exr_test_values(shape.size, 4);
    for (float& value : values) value = std::clamp(value, 0.f, 100.f);
    const std::string from = (folder / "from.exr").string();
    write_file(from, encode_openexr(shape, values));
    const std::vector<std::vector<std::string>> kinds{{},
                                                      {"-d", "half"},
                                                      {"--tile", "16", "16"},
                                                      {"-d", "half", "--tile", "16", "16"},
                                                      {"--compression", "piz"},
                                                      {"--ch", "R,G,B"},
                                                      {"--ch", "R", "--chnames", "Y"},
                                                      {"--ch", "R,G", "--chnames", "Y,A"},
                                                      {"-d", "R=half"}};
    for (const std::vector<std::string>& kind : kinds) {
        const std::string to = (folder / "to.exr").string();
        std::vector<std::string> command{"/usr/bin/oiiotool", from};
        command.insert(command.end(), kind.begin(), kind.end());
        command.insert(command.end(), {"-o", to});
        const test::ProcessResult made = test::run_process({.command = command});
        ASSERT_EQ(made.exit_code, 0) << made.err << made.out;
        const std::string file = read_file(to);
        const MemorySource bytes(file);
        SCOPED_TRACE(testing::PrintToString(kind));
        std::vector<std::string> wanted_channels;
        const std::vector<float> wanted = read_with_openimageio(bytes, wanted_channels);
        ImageReader reader(bytes, "openexr", to, {}, ImageColours());
        const ImageShape found = reader.shape();
        EXPECT_THAT(found.channels, testing::UnorderedElementsAreArray(wanted_channels));
        ASSERT_EQ(found.size, shape.size);
        EXPECT_EQ(found.description, "a text");
        const std::vector<float> read = reader.floats();
        ASSERT_EQ(read.size(), wanted.size());
        for (std::size_t i = 0; i < read.size(); ++i) {
            const std::string& channel = found.channels[i % found.channel_count];
            const auto place = static_cast<std::size_t>(
                std::ranges::find(wanted_channels, channel) - wanted_channels.begin());
            ASSERT_EQ(read[i], wanted[i / found.channel_count * found.channel_count + place])
                << channel << " of pixel " << i / found.channel_count;
        }
        // Without the choice of colours, all channels are read as OpenImageIO orders them.
        EXPECT_TRUE(ImageReader(bytes, "openexr", to).floats() == wanted);
        // Rows may be read in pieces.
        ImageReader in_rows(bytes, "openexr", to, {}, ImageColours());
        std::vector<float> pieces(read.size());
        const std::size_t row = read.size() / shape.size.y;
        for (std::uint32_t first = 0; first < shape.size.y; first += 10)
            in_rows.read_rows(first, std::span(pieces).subspan(
                                         first * row, std::min(10U, shape.size.y - first) * row));
        EXPECT_TRUE(pieces == read);
    }
}

// A picture of more than half a million pixels is encoded and decoded by several threads.
TEST_F(Exr, LargePicturesKeepTheirValues) {
    const ImageShape shape{{1024, 600}, 3, {"R", "G", "B"}};
    const std::vector<float> values = make_exr_test_values(shape.size, 3);
    const std::string encoded = encode_openexr(shape, values);
    EXPECT_TRUE(encoded == encode_with_openimageio(shape, values));
    const MemorySource bytes(encoded);
    EXPECT_TRUE(ImageReader(bytes, "openexr", "large", {}, ImageColours()).floats() == values);
}

// A file that ends early is refused with the reason, whatever part of it is missing.
TEST_F(Exr, FilesThatEndEarlyAreRefused) {
    const ImageShape shape{{40, 60}, 3, {"R", "G", "B"}};
    const std::string whole = encode_openexr(shape, make_exr_test_values(shape.size, 3));
    for (const std::size_t size : {whole.size() - 1, whole.size() / 2, std::size_t{200}}) {
        const MemorySource bytes(std::string_view(whole).substr(0, size));
        for (const std::optional<ImageColours>& colours :
             {std::optional<ImageColours>(), std::optional(ImageColours())})
            EXPECT_THAT(test::catch_error_text(
                            Failure::bad_data,
                            [&] { ImageReader(bytes, "openexr", "cut", {}, colours).floats(); }),
                        testing::StartsWith("cut: "))
                << size;
    }
}

} // namespace
} // namespace catoptric
