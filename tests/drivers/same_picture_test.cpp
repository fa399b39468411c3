// Test of case D4 of docs/extremes.md: two versions of a driver draw the same pictures.
#include "cli/program.hpp"
#include "drivers/second_driver.hpp"
#include "measure/flip.hpp"
#include "measure/picture_file.hpp"

#include <iostream>

namespace {

using namespace catoptric;
class SecondDriverPictureTest : public CommandLineTest {
protected:
    using Environment = std::map<std::string, std::string>;

    nlohmann::json json(const Words& words, const Environment& environment) const {
        test::ProcessStartOptions process = make_process_start(words);
        process.environment = environment;
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return nlohmann::json::parse(ended.out);
    }

    /// Renders a picture of each technique into the folder `place`/images.
    void render_techniques_into_folder(const Words& techniques, const std::string& place,
                                       const Environment& environment) const {
        Words words = {"compare", "-o",       place, "--size",  "256x256",     "--frames",
                       "1",       "--warmup", "1",   "--quiet", "--techniques"};
        words.insert(words.end(), techniques.begin(), techniques.end());
        test::ProcessStartOptions process = make_process_start(words);
        process.environment = environment;
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
    }
};

TEST_F(SecondDriverPictureTest, TwoDriverVersionsDrawTheSamePictures) {
    constexpr double kMaxFlipBetweenDrivers = 0.0005;
    const auto second = test::find_second_driver_environment();
    if (!second) GTEST_SKIP() << test::kNoSecondDriverMessage;
    const std::string driver_1 = json({"info", "--json"}, {})["device"]["driver"],
                      driver_2 = json({"info", "--json"}, *second)["device"]["driver"];
    ASSERT_NE(driver_1, driver_2);
    EXPECT_THAT(driver_2, testing::HasSubstr("Mesa 25"));
    std::cout << "[ MEASURED ] D4 " << driver_1 << " and " << driver_2 << "\n";
    Words techniques;
    const nlohmann::json list = json({"list", "techniques", "--json"}, {});
    for (const auto& technique : list["techniques"]) techniques.push_back(technique["name"]);
    render_techniques_into_folder(techniques, "first", {});
    render_techniques_into_folder(techniques, "second", *second);
    for (const std::string& technique : techniques) {
        const measure::Picture a = measure::read_picture(folder / "first/images" /
                                                         (technique + ".exr"));
        const measure::Picture b = measure::read_picture(folder / "second/images" /
                                                         (technique + ".exr"));
        const double flip = measure::flip_mean(
            measure::flip(measure::to_display(a), measure::to_display(b)));
        std::size_t different = 0;
        for (std::size_t i = 0; i < a.pixels.size(); ++i)
            different += a.pixels[i] != b.pixels[i] ? 1 : 0;
        std::cout << "[ MEASURED ] D4 " << technique << ": FLIP " << flip << ", " << different
                  << " of " << a.pixels.size() << " pixels are not the same bits\n";
        EXPECT_LE(flip, kMaxFlipBetweenDrivers) << technique;
    }
}

} // namespace
