// Tests of `render --aov`: the channels of the file, their values, and the text of errors.
#include "cli/program.hpp"

#include "core/byte_source.hpp"
#include "core/image_codec.hpp"
#include "measure/picture_file.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// All channels of an EXR file, as OpenImageIO names and reads them.
struct ExrChannels {
    std::vector<std::string> names;
    std::map<std::string, std::vector<float>> values;
};

class AovTest : public CommandLineTest {
protected:
    test::ProcessResult render_layers(const std::string& technique, const std::string& file,
                                      const Words& more) const {
        Words words{"render", "--technique", technique, "--size", "48x40", "-o", file};
        words.insert(words.end(), more.begin(), more.end());
        test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return ended;
    }
    ExrChannels read_channels(const std::string& file) const {
        const auto bytes = catoptric::open_source(folder / file);
        catoptric::ImageReader reader(*bytes, "openexr", file);
        const std::vector<float> values = reader.floats();
        ExrChannels read{reader.shape().channels, {}};
        for (std::size_t i = 0; i < values.size(); ++i)
            read.values[read.names[i % read.names.size()]].push_back(values[i]);
        return read;
    }
};

TEST_F(AovTest, LayersLieBesideUnchangedColours) {
    render_layers("parallax:face=32", "plain.exr", {});
    render_layers("parallax:face=32", "all.exr", {"--aov", "all"});
    const ExrChannels all = read_channels("all.exr");
    std::vector<std::string> names = all.names;
    EXPECT_THAT((std::vector<std::string>{names.begin(), names.begin() + 3}),
                ElementsAre("R", "G", "B"))
        << "tools show the first three channels";
    std::ranges::sort(names);
    EXPECT_THAT(names, ElementsAre("B", "G", "R", "distance.Z", "mirror.V", "normal.X", "normal.Y",
                                   "normal.Z", "object.V", "roughness.V", "tier.V"));
    const ExrChannels plain = read_channels("plain.exr");
    for (const char* name : {"R", "G", "B"})
        EXPECT_EQ(all.values.at(name), plain.values.at(name)) << name;
    // Programs that read only colours, such as our own, read the same picture.
    const test::ProcessResult same = run_cli({"diff", "all.exr", "plain.exr", "--json"});
    EXPECT_EQ(json::parse(same.out)["max"], 0) << same.err;

    render_layers("parallax:face=32", "two.exr", {"--aov", "normal,distance,normal", "--origin"});
    const ExrChannels two = read_channels("two.exr");
    EXPECT_EQ(two.names.size(), 7u);
    EXPECT_EQ(two.values.at("normal.Y"), all.values.at("normal.Y"));
    EXPECT_EQ(two.values.at("distance.Z"), all.values.at("distance.Z"));
}

TEST_F(AovTest, NumbersAreThoseOfInfo) {
    render_layers("raytrace", "numbers.exr", {"--aov", "object,mirror,roughness,distance,tier"});
    const ExrChannels found = read_channels("numbers.exr");
    const json info = json::parse(run_cli({"info", "cornell-mirrors", "--json"}).out);
    ASSERT_EQ(info["object_names"].size(), info["objects"]);
    std::map<int, std::size_t> pixels;
    for (std::size_t i = 0; i < found.values.at("object.V").size(); ++i) {
        const auto object = static_cast<int>(found.values.at("object.V")[i]),
                   mirror = static_cast<int>(found.values.at("mirror.V")[i]);
        ++pixels[mirror];
        EXPECT_EQ(static_cast<float>(object), found.values.at("object.V")[i]);
        EXPECT_EQ(found.values.at("tier.V")[i], mirror > 0 ? 4 : 0) << "4: traced";
        if (object == 0) {
            EXPECT_EQ(found.values.at("distance.Z")[i], INFINITY);
            continue;
        }
        if (mirror == 0) continue;
        EXPECT_EQ(info["object_names"][object - 1], info["mirrors"][mirror - 1]["name"]);
    }
    ASSERT_EQ(pixels.size(), 5u) << "four balls, and no mirror";
    // `info` counts the pixels of each mirror in a smaller picture of its own.
    for (const json& mirror : info["mirrors"])
        EXPECT_NEAR(static_cast<double>(pixels[mirror["mirror"]]) / 1920,
                    mirror["screen_share"].get<double>(), .02)
            << mirror;
}

TEST_F(AovTest, TechniquesDifferOnlyInTheTier) {
    render_layers("raytrace:depth=2", "rays.exr", {"--aov", "all"});
    const ExrChannels rays = read_channels("rays.exr");
    for (const char* technique : {"naive:bounces=1", "secant:face=32", "planar"}) {
        render_layers(technique, "other.exr", {"--aov", "all"});
        const ExrChannels other = read_channels("other.exr");
        for (const auto& [name, values] : rays.values) {
            if (name.size() == 1 || name == "tier.V") continue;
            EXPECT_EQ(other.values.at(name), values) << technique << " " << name;
        }
        EXPECT_NE(other.values.at("tier.V"), rays.values.at("tier.V"));
    }
}

TEST_F(AovTest, EachPictureOfASequenceHasItsOwnLayers) {
    render_layers("reuse:face=16", "f{n}.exr",
                  {"--aov", "distance,object,tier", "--animate", "--time", ".3", "--frames", "30",
                   "--warmup", "1"});
    const ExrChannels first = read_channels("f1.exr"), last = read_channels("f30.exr");
    EXPECT_NE(first.values.at("distance.Z"), last.values.at("distance.Z")) << "a ball moves";
    render_layers("raytrace", "still.exr",
                  {"--aov", "distance,object", "--time", std::to_string(.3 + 30 / 60.)});
    EXPECT_EQ(read_channels("still.exr").values.at("object.V"), last.values.at("object.V"));
}

/// A limit of captures changes no still picture, and therefore none of its layers.
TEST_F(AovTest, LayersOfAStillPictureDoNotDependOnTheLimitOfCaptures) {
    const std::string technique = "hybrid:face=16,shadow_map=64"; // has captures and rays
    render_layers(technique, "all.exr", {"--aov", "all"});
    const test::ProcessResult limited = render_layers(
        technique, "limited.exr", {"--aov", "all", "--budget-ms", "1e-6", "--verbose"});
    EXPECT_THAT(limited.err, HasSubstr("captures: at most 1 of 4 mirrors a frame"));
    EXPECT_EQ(read_output_file("limited.exr"), read_output_file("all.exr"));
}

TEST_F(AovTest, OtherFilesAndUnknownLayersAreRefused) {
    const Words start{"render", "--technique", "raytrace", "--size", "16x16"};
    const auto refuse = [&](const std::string& list, const std::string& file, const Words& parts) {
        Words words = start;
        words.insert(words.end(), {"--aov", list, "-o", file});
        expect_usage_refused(words, 2, parts);
    };
    for (const std::string file : {"x.png", "-"})
        refuse("distance", file,
               {"--aov: wanted -o with a name ending in .exr, which holds layers, found '" + file +
                "'"});
    refuse("distanse", "x.exr",
           {"--aov: wanted one of distance, normal, object, mirror, tier, roughness, all, found "
            "'distanse' (did you mean 'distance'?)"});
    refuse("normal,,tier", "x.exr", {"--aov: wanted one of", "found ''"});
    refuse("", "x.exr", {"--aov"});
    EXPECT_TRUE(std::filesystem::is_empty(folder));
}

} // namespace
