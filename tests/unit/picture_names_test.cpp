// Tests of pictures whose colours lie elsewhere than a reader by place expects: OpenEXR files of
// layers and parts, with windows and whole numbers, and Radiance files in any order of lines.
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_codec.hpp"
#include "measure/picture_file.hpp"
#include "support/folder.hpp"
#include "support/process.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace catoptric {
namespace {

using measure::Picture;
using measure::read_picture;
using testing::AllOf;
using testing::HasSubstr;

class PictureNames : public test::InFolder {
protected:
    std::string path(const std::string& name) const { return (folder / name).string(); }
    /// Writes a file of 3x2 pixels whose channel c of pixel i has the value 10 c + i.
    std::string write_channels(const std::string& name,
                               const std::vector<std::string>& channels) const {
        const ImageShape shape{{3, 2}, channels.size(), channels};
        std::vector<float> values;
        for (int pixel = 0; pixel < 6; ++pixel)
            for (std::size_t channel = 0; channel < channels.size(); ++channel)
                values.push_back(float(10 * channel) + float(pixel));
        write_file(path(name), encode_openexr(shape, values));
        return path(name);
    }
    /// Runs oiiotool, whose output is the file `name`.
    std::string convert(std::vector<std::string> words, const std::string& name) const {
        words.insert(words.begin(), "/usr/bin/oiiotool");
        words.insert(words.end(), {"-o", path(name)});
        const test::ProcessResult made = test::run_process({.command = words});
        EXPECT_EQ(made.exit_code, 0) << made.err << made.out;
        return path(name);
    }
    static std::string error_text(const std::string& file) {
        return test::catch_error_text(Failure::bad_data, [&] { read_picture(file); });
    }
    /// Returns the first pixel's colour.
    static vec3 first_pixel(const std::string& file) { return read_picture(file).pixels.at(0); }
};

TEST_F(PictureNames, ColoursAreFoundByTheirNames) {
    EXPECT_EQ(first_pixel(write_channels("a.exr", {"A", "B", "G", "R", "Z"})), vec3(30, 20, 10));
    EXPECT_EQ(first_pixel(write_channels("b.exr", {"depth.Z", "view.B", "view.G", "view.R"})),
              vec3(30, 20, 10));
    EXPECT_EQ(first_pixel(write_channels("c.exr", {"B", "G", "R", "x.B", "x.G", "x.R"})),
              vec3(20, 10, 0))
        << "colours without a layer come first";
    EXPECT_EQ(first_pixel(write_channels("d.exr", {"Y"})), vec3(0));
    EXPECT_EQ(first_pixel(write_channels("e.exr", {"A", "Y"})), vec3(10));
}

TEST_F(PictureNames, LayersAreChosenByName) {
    const std::string file = write_channels("many.exr",
                                            {"a.B", "a.G", "a.R", "b.c.B", "b.c.G", "b.c.R"});
    EXPECT_THAT(error_text(file), AllOf(HasSubstr(file), HasSubstr("found the layers a, b.c"),
                                        HasSubstr("FILE:LAYER")));
    EXPECT_EQ(first_pixel(file + ":a"), vec3(20, 10, 0));
    EXPECT_EQ(first_pixel(file + ":b.c"), vec3(50, 40, 30));
    EXPECT_THAT(error_text(file + ":c"), HasSubstr("wanted one of the layers a, b.c, found"));
    std::filesystem::copy_file(file, path("many:a"));
    EXPECT_THAT(error_text(path("many:a")), HasSubstr("found the layers"))
        << "a file whose name has a colon";
}

TEST_F(PictureNames, PicturesWithoutColoursAreRefusedWithTheNamesTheyHave) {
    for (const std::vector<std::string>& channels :
         std::vector<std::vector<std::string>>{{"Z"},
                                               {"G", "R"},
                                               {"A"},
                                               {"normal.X", "normal.Y", "normal.Z"},
                                               {"Crypto00.b", "Crypto00.g", "Crypto00.r"},
                                               {"b", "g", "r"}}) {
        std::string names;
        for (const std::string& channel : channels) names += (names.empty() ? "" : ", ") + channel;
        EXPECT_THAT(error_text(write_channels("x.exr", channels)),
                    HasSubstr("wanted the channels R, G and B, or Y, found " + names));
    }
}

TEST_F(PictureNames, PartsAreFoundByTheirNames) {
    const std::string depth = write_channels("depth.exr", {"Z"}),
                      colour = write_channels("colour.exr", {"B", "G", "R"}),
                      other = write_channels("other.exr", {"R", "G", "B"});
    const auto name_part = [](const char* name) {
        return std::vector<std::string>{"--attrib", "oiio:subimagename", name};
    };
    const auto join = [&](const std::string& a, const char* a_name, const std::string& b,
                          const char* b_name, const std::string& to) {
        std::vector<std::string> words{a};
        for (const std::string& word : name_part(a_name)) words.push_back(word);
        words.push_back(b);
        for (const std::string& word : name_part(b_name)) words.push_back(word);
        words.emplace_back("--siappend");
        return convert(words, to);
    };
    EXPECT_EQ(first_pixel(join(depth, "depth", colour, "beauty", "first.exr")), vec3(20, 10, 0))
        << "a part of depths comes first";
    const std::string two = join(colour, "left", other, "right", "two.exr");
    EXPECT_THAT(error_text(two), HasSubstr("found the layers left, right"));
    EXPECT_EQ(first_pixel(two + ":left"), vec3(20, 10, 0));
    EXPECT_EQ(first_pixel(two + ":right"), vec3(0, 10, 20));
}

TEST_F(PictureNames, WholeNumbersAreNumbers) {
    const std::string from = write_channels("from.exr", {"B", "G", "R"});
    // oiiotool scales floats of 0 to 1 to whole numbers up to 2^32 - 1.
    const std::string whole = convert({from, "--mulc", "2.3283064370807974e-10", "-d", "uint32"},
                                      "whole.exr");
    const Picture picture = read_picture(whole);
    for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(picture.pixels[i].x, 20 + float(i), 1e-3f) << i;
}

TEST_F(PictureNames, PicturesAreTheirDisplayWindow) {
    const std::string from = write_channels("from.exr", {"B", "G", "R"});
    const Picture whole = read_picture(from);
    // The stored pixels lie at (1, 2) in a window of 5x4.
    const Picture inside = read_picture(
        convert({from, "--origin", "+1+2", "--fullsize", "5x4+0+0"}, "inside.exr"));
    ASSERT_EQ(inside.width, 5);
    ASSERT_EQ(inside.height, 4);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x) {
            const bool is_stored = x >= 1 && x < 4 && y >= 2;
            EXPECT_EQ(inside.at(x, y), is_stored ? whole.at(x - 1, y - 2) : vec3(0))
                << x << "," << y;
        }
    // The window shows the middle column of the lower row only.
    const Picture cut = read_picture(convert({from, "--fullsize", "1x1+1+1"}, "cut.exr"));
    ASSERT_EQ(cut.pixels.size(), 1u);
    EXPECT_EQ(cut.pixels[0], whole.at(1, 1));
    // Rows in pieces are those of the whole.
    measure::PictureReader reader(path("inside.exr"));
    std::vector<vec3> row(5);
    for (int y = 0; y < 4; ++y) {
        reader.read_rows(y, row);
        for (int x = 0; x < 5; ++x) EXPECT_EQ(row[std::size_t(x)], inside.at(x, y));
    }
}

TEST_F(PictureNames, HugeWindowsOfFewPixelsAreRefused) {
    const std::string from = write_channels("from.exr", {"B", "G", "R"});
    EXPECT_THAT(error_text(convert({from, "--fullsize", "20000x20000+0+0"}, "huge.exr")),
                HasSubstr("wanted a display window of at most 64 times the stored pixels, found "
                          "20000x20000 for 3x2"));
}

/// Returns the bytes of a Radiance file whose pixel i, in the order of the file, has the mantissa
/// 16 (i + 1) and the exponent of 1.
std::string make_radiance_file(const std::string& size, int pixels, const std::string& lines = "") {
    std::string bytes = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n" + lines + "\n" + size + "\n";
    for (int i = 0; i < pixels; ++i)
        bytes += {char(16 * (i + 1)), char(8 * (i + 1)), char(4 * (i + 1)), char(129)};
    return bytes;
}

TEST_F(PictureNames, RadianceLinesAreReadInTheirOrder) {
    struct OrderOfLines {
        const char* size;
        int width;
        std::vector<int> stored; // number of the stored pixel for each pixel of the picture
    };
    for (const auto& [size, width, stored] : {OrderOfLines{"-Y 2 +X 3", 3, {0, 1, 2, 3, 4, 5}},
                                              {"-Y 2 -X 3", 3, {2, 1, 0, 5, 4, 3}},
                                              {"+Y 2 +X 3", 3, {3, 4, 5, 0, 1, 2}},
                                              {"+Y 2 -X 3", 3, {5, 4, 3, 2, 1, 0}},
                                              {"+X 3 -Y 2", 3, {0, 2, 4, 1, 3, 5}},
                                              {"+X 3 +Y 2", 3, {1, 3, 5, 0, 2, 4}},
                                              {"-X 3 -Y 2", 3, {4, 2, 0, 5, 3, 1}},
                                              {"-X 3 +Y 2", 3, {5, 3, 1, 4, 2, 0}}}) {
        write_file(path("x.hdr"), make_radiance_file(size, 6));
        const Picture picture = read_picture(path("x.hdr"));
        ASSERT_EQ(picture.width, width) << size;
        for (std::size_t i = 0; i < 6; ++i)
            EXPECT_FLOAT_EQ(picture.pixels[i].x, float(stored[i] + 1) / 8)
                << size << ", pixel " << i;
    }
}

TEST_F(PictureNames, RadianceExposureIsTakenBack) {
    const auto read = [&](const std::string& lines) {
        write_file(path("x.hdr"), make_radiance_file("-Y 2 +X 3", 6, lines));
        return read_picture(path("x.hdr")).pixels[0];
    };
    const vec3 plain = read("");
    EXPECT_FLOAT_EQ(read("EXPOSURE=2\n").x, plain.x / 2);
    EXPECT_FLOAT_EQ(read("EXPOSURE=2\nEXPOSURE= 4\n").x, plain.x / 8);
    const vec3 corrected = read("COLORCORR= 1 2 4\n");
    EXPECT_FLOAT_EQ(corrected.y, plain.y / 2);
    EXPECT_FLOAT_EQ(corrected.z, plain.z / 4);
    write_file(path("y.hdr"), make_radiance_file("-Y 2 +X 3", 6, "EXPOSURE=0\n"));
    EXPECT_THAT(error_text(path("y.hdr")), HasSubstr("wanted numbers above 0, found"));
}

TEST_F(PictureNames, RadianceFilesOfOtherKindsAreRefused) {
    std::string bytes = make_radiance_file("-Y 2 +X 3", 6);
    bytes.replace(bytes.find("rgbe"), 4, "xyze");
    write_file(path("x.hdr"), bytes);
    EXPECT_THAT(error_text(path("x.hdr")),
                HasSubstr("wanted FORMAT=32-bit_rle_rgbe, found '32-bit_rle_xyze'"));
    write_file(path("y.hdr"), make_radiance_file("-Y 2 +Z 3", 6));
    EXPECT_THAT(error_text(path("y.hdr")), HasSubstr("wanted a size such as -Y 512 +X 1024"));
    write_file(path("z.hdr"), make_radiance_file("-Y 2 -Y 3", 6));
    EXPECT_THAT(error_text(path("z.hdr")), HasSubstr("wanted a size such as -Y 512 +X 1024"));
}

TEST_F(PictureNames, LayersOfOtherFormatsAreRefused) {
    write_file(path("x.hdr"), make_radiance_file("-Y 2 +X 3", 6));
    EXPECT_THAT(error_text(path("x.hdr") + ":beauty"),
                HasSubstr("wanted an OpenEXR picture with the layer 'beauty'"));
}

} // namespace
} // namespace catoptric
