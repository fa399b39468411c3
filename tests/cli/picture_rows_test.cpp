// Tests of rows whose pictures are files of another renderer (compare --row).
#include "cli/program.hpp"
#include "measure/display.hpp"
#include "measure/picture_file.hpp"

namespace {

using nlohmann::json;

class PictureRows : public Cli {
protected:
    void SetUp() override {
        Cli::SetUp();
        for (const char* file : {"own.exr", "own.png"})
            ASSERT_EQ(run_cli(with_small_quick_frame(
                                  {"render", "--technique", "parallax:face=16", "-o", file}))
                          .exit_code,
                      0);
    }

    /// Compares with the rows given as NAME=FILE.
    test::ProcessResult compare_picture_rows(const Words& rows) const {
        Words words{"compare", "-o", "out", "--techniques", "parallax:face=16", "reuse:face=16"};
        for (const std::string& row : rows) words.insert(words.end(), {"--row", row});
        return run_cli(with_small_quick_frame(words));
    }

    json read_report_row(std::size_t index) const {
        return json::parse(read_file_at_path(folder / "out/report.json"))["rows"][index];
    }
};

TEST_F(PictureRows, OwnPictureHandedBackHasTheSameFigures) {
    const test::ProcessResult ended = compare_picture_rows({"mine=own.exr", "8 bits=own.png"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json own = read_report_row(0), back = read_report_row(2), rounded = read_report_row(3);
    EXPECT_EQ(back["label"], "mine");
    EXPECT_EQ(back["technique"], "picture");
    for (const char* mask : {"error", "error_all", "error_first_order"})
        for (const char* figure : {"rmse", "flip", "mae", "off", "max"}) {
            EXPECT_NEAR(back[mask][figure], own[mask][figure].get<double>(), 1e-6)
                << mask << " " << figure;
            EXPECT_NEAR(rounded[mask][figure], own[mask][figure].get<double>(), .01)
                << mask << " " << figure;
        }
    EXPECT_TRUE(back["gpu_ms"].is_null());
    EXPECT_THAT(ended.out, testing::HasSubstr("mine"));
    EXPECT_THAT(ended.out, testing::Not(testing::HasSubstr("nan")));
    const std::string csv = read_file_at_path(folder / "out/rows.csv"),
                      page = read_file_at_path(folder / "out/report.html"),
                      text = read_file_at_path(folder / "out/report.md");
    EXPECT_THAT(csv, testing::HasSubstr("mine"));
    EXPECT_THAT(page, testing::HasSubstr("mine"));
    EXPECT_THAT(text, testing::HasSubstr("since their time is not known: mine (FLIP"));
    for (const std::string& document : {csv, page, text})
        EXPECT_THAT(document, testing::Not(testing::HasSubstr("nan ")));
    EXPECT_TRUE(std::filesystem::exists(folder / "out/images/picture1-mine.png"));
}

/// A PNG is read with the comparison's exposure taken off.
TEST_F(PictureRows, PngHoldsWhatIsDisplayedAtTheExposure) {
    ASSERT_EQ(run_cli(with_small_quick_frame({"render", "--technique", "parallax:face=16",
                                              "--exposure", "1", "-o", "bright.png"}))
                  .exit_code,
              0);
    Words words{"compare",    "-o", "out",   "--techniques",   "parallax:face=16",
                "--exposure", "1",  "--row", "mine=bright.png"};
    ASSERT_EQ(run_cli(with_small_quick_frame(words)).exit_code, 0);
    EXPECT_NEAR(read_report_row(1)["error"]["rmse"],
                read_report_row(0)["error"]["rmse"].get<double>(), .005);
}

TEST_F(PictureRows, PictureUpsideDownOrOfOtherLightIsNamed) {
    namespace measure = catoptric::measure;
    const measure::Picture own = measure::read_picture(folder / "own.exr");
    measure::Picture turned(own.width, own.height), bright = own;
    for (int y = 0; y < own.height; ++y)
        for (int x = 0; x < own.width; ++x) turned.at(x, y) = own.at(x, own.height - 1 - y);
    for (auto& pixel : bright.pixels) pixel *= 3;
    measure::write_exr(turned, folder / "turned.exr");
    measure::write_exr(bright, folder / "bright.exr");
    const test::ProcessResult ended = compare_picture_rows(
        {"t=turned.exr", "b=bright.exr", "o=own.exr"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const std::string warnings =
        json::parse(read_file_at_path(folder / "out/report.json"))["warnings"].dump();
    EXPECT_THAT(warnings, testing::HasSubstr("'t': its picture is upside down"));
    EXPECT_THAT(warnings, testing::HasSubstr("'b': its rmse is "));
    EXPECT_THAT(warnings, testing::Not(testing::HasSubstr("'o'")));
}

TEST_F(PictureRows, PictureThatDoesNotFitIsRefusedBeforeMeasuring) {
    namespace measure = catoptric::measure;
    measure::write_exr(measure::Picture(5, 4), folder / "small.exr");
    const auto refused = [&](const Words& rows, int code, const std::string& says) {
        const test::ProcessResult ended = compare_picture_rows(rows);
        EXPECT_EQ(ended.exit_code, code) << ended.err;
        EXPECT_THAT(ended.err, testing::HasSubstr(says));
        EXPECT_FALSE(std::filesystem::exists(folder / "out/report.json"));
    };
    refused({"a=small.exr"}, 65, "small.exr: wanted a picture of ");
    refused({"a=none.exr"}, 66, "none.exr");
    refused({"own.exr"}, 2, "wanted NAME=FILE");
    refused({"a=own.exr", "a=own.png"}, 2, "wanted a name that no other row has");
    refused({"parallax:face=16=own.exr"}, 66, "16=own.exr");
}

} // namespace
