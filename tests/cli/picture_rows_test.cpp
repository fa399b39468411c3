// Tests of rows whose pictures are files of another renderer (compare --row).
#include "cli/program.hpp"
#include "measure/display.hpp"
#include "measure/picture_file.hpp"
#include "measure/srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace {

using nlohmann::json;

class PictureRowsCliTest : public CommandLineTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        for (const char* file : {"own.exr", "own.png"})
            ASSERT_EQ(run_cli(add_small_frame_options(
                                  {"render", "--technique", "parallax:face=16", "-o", file}))
                          .exit_code,
                      0);
    }

    /// Runs a comparison with pictures of another renderer as rows. Each word is NAME=PICTURES.
    test::ProcessResult compare_picture_rows(const Words& rows) const {
        Words words{"compare", "-o", "out", "--techniques", "parallax:face=16", "reuse:face=16"};
        for (const std::string& row : rows) words.insert(words.end(), {"--row", row});
        return run_cli(add_small_frame_options(words));
    }

    json read_report_row(std::size_t index) const {
        return json::parse(read_file_at_path(folder / "out/report.json"))["rows"][index];
    }
};

TEST_F(PictureRowsCliTest, OwnPictureHandedBackHasTheSameFigures) {
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

/// A PNG file holds displayed colours, so its values are divided by 2^exposure when the file is
/// read.
TEST_F(PictureRowsCliTest, PngHoldsWhatIsDisplayedAtTheExposure) {
    ASSERT_EQ(run_cli(add_small_frame_options({"render", "--technique", "parallax:face=16",
                                               "--exposure", "1", "-o", "bright.png"}))
                  .exit_code,
              0);
    Words words{"compare",    "-o", "out",   "--techniques",   "parallax:face=16",
                "--exposure", "1",  "--row", "mine=bright.png"};
    ASSERT_EQ(run_cli(add_small_frame_options(words)).exit_code, 0);
    EXPECT_NEAR(read_report_row(1)["error"]["rmse"],
                read_report_row(0)["error"]["rmse"].get<double>(), .005);
}

TEST_F(PictureRowsCliTest, PictureUpsideDownOrOfOtherLightIsNamed) {
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

TEST_F(PictureRowsCliTest, PictureWithAWrongCurveIsNamedAndOtherExposuresAreNot) {
    namespace measure = catoptric::measure;
    const measure::Picture own = measure::read_picture(folder / "own.exr");
    measure::Picture shown = own, clamped = own;
    for (std::size_t i = 0; i < own.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            clamped.pixels[i][c] = std::clamp(own.pixels[i][c], 0.F, 1.F);
            shown.pixels[i][c] = static_cast<float>(
                measure::srgb_from_linear(static_cast<double>(clamped.pixels[i][c])));
        }
    measure::write_exr(shown, folder / "shown.exr");
    measure::write_png(clamped, folder / "linear.png"); // values of linear light as they are
    Words rows{"s=shown.exr", "l=linear.png", "o=own.exr", "p=own.png"};
    for (const int stops : {-2, -1, 1, 2}) {
        const std::string name = "e" + std::to_string(stops);
        measure::write_exr(measure::apply_exposure(own, stops), folder / (name + ".exr"));
        measure::write_png(measure::to_display(own, stops), folder / (name + ".png"));
        rows.insert(rows.end(), {name + "=" + name + ".exr", name + "png=" + name + ".png"});
    }
    const test::ProcessResult ended = compare_picture_rows(rows);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json report = json::parse(read_file_at_path(folder / "out/report.json"));
    std::vector<std::string> curves;
    for (const std::string warning : report["warnings"])
        if (warning.find("its values seem") != std::string::npos) curves.push_back(warning);
    EXPECT_THAT(curves, testing::ElementsAre(
                            testing::HasSubstr("'s': its values seem to have the sRGB curve of a "
                                               "display; wanted linear light in EXR"),
                            testing::HasSubstr("'l': its values seem to be linear light; wanted "
                                               "values with the sRGB curve in a PNG")));
}

TEST_F(PictureRowsCliTest, PictureThatDoesNotFitIsRefusedBeforeMeasuring) {
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
    refused({"own.exr"}, 2, "wanted NAME=PICTURES");
    refused({"a=own.exr", "a=own.png"}, 2, "wanted a name that no other row has");
    refused({"parallax:face=16=own.exr"}, 66, "16=own.exr");
}

/// A row with stated times is ranked among the measured rows only if they were measured on the
/// device that the file of times names.
TEST_F(PictureRowsCliTest, TimesOfOtherRenderersRankTheirRowsOnTheirDevice) {
    ASSERT_EQ(compare_picture_rows({"mine=own.exr"}).exit_code, 0);
    const json before = json::parse(read_output_file("out/report.json"));
    EXPECT_FALSE(before["rows"][0].contains("row_times"));
    const std::string here = before["device"]["name"];
    write_input_file("here.json", R"({"schema": "catoptric/row-times/1", "device": ")" + here +
                                      R"(", "rows": [{"row": "mine",
                                      "ms": [0.003, 0.001, 0.002, 0.002, 0.001, 0.004]}]})");
    write_input_file("card.json", R"({"schema": "catoptric/row-times/1", "device": "card",
                                      "rows": [{"row": "mine", "ms": 4.5}]})");
    write_input_file("costs.json", R"({"schema": "catoptric/costs/1", "device": "card",
        "origin": "given", "costs": [{"work": "frames", "ns": 5000000}]})");
    const auto compare_with_times = [&](const Words& options) {
        Words words{"compare",          "-o",    "out",         "--techniques",
                    "parallax:face=16", "--row", "mine=own.exr"};
        words.insert(words.end(), options.begin(), options.end());
        return run_cli(add_small_frame_options(words));
    };
    const test::ProcessResult ended = compare_with_times(
        {"--row-times", "here.json", "--row-times", "card.json", "--costs", "costs.json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json report = json::parse(read_output_file("out/report.json"));
    const json& mine = report["rows"][1];
    EXPECT_EQ(mine["gpu_ms"]["median"], .002);
    EXPECT_EQ(mine["gpu_ms"]["ci95"], json::parse("[0.001, 0.004]"));
    EXPECT_EQ(report["pareto"][0], 1) << "the fastest of the front";
    ASSERT_EQ(mine["row_times"].size(), 2U);
    EXPECT_EQ(mine["row_times"][1], json::parse(R"({"device": "card", "ms": 4.5, "low_ms": null,
                                                    "high_ms": null, "frames": 1})"));
    // On the named device, the other renderer takes 4.5 ms, and the predicted time of our row is 5
    // ms.
    EXPECT_EQ(mine["costs"][0]["ms"], 4.5);
    EXPECT_EQ(mine["costs"][0]["on_front"], true);
    EXPECT_EQ(report["rows"][0]["costs"][0]["ms"], 5);
    EXPECT_EQ(report["rows"][0]["costs"][0]["on_front"], false);
    const std::string markdown = read_output_file("out/report.md");
    EXPECT_THAT(markdown, testing::ContainsRegex("mine *[|] card +[|] +4[.]50 [|] +– [|] +1 [|]"));
    EXPECT_THAT(markdown, testing::HasSubstr("As stated by the files of --row-times. Times on the "
                                             "comparison's own device rank their rows"));

    write_input_file("bad.json", R"({"schema": "catoptric/row-times/1", "device": "card",
                                     "rows": [{"row": "mine", "ms": [1, 0]}]})");
    write_input_file("other.json", R"({"schema": "catoptric/row-times/1", "device": "card",
                                       "rows": [{"row": "yours", "ms": 1}]})");
    const std::pair<Words, std::string> refused[] = {
        {{"--row-times", "bad.json"},
         "bad.json: rows[0].ms[1]: wanted milliseconds above 0, found '0'"},
        {{"--row-times", "other.json"},
         "--row-times other.json: wanted the name of a row of --row, found 'yours'"},
        {{"--row-times", "card.json", "--row-times", "card.json"},
         "wanted one time for each row and device, found a second for 'mine' on 'card'"},
        {{"--row-times", "costs.json"}, "costs.json: schema: wanted times of rows"}};
    std::filesystem::remove_all(folder / "out");
    for (const auto& [options, text] : refused) {
        const test::ProcessResult failed = compare_with_times(options);
        EXPECT_NE(failed.exit_code, 0) << text;
        EXPECT_THAT(failed.err, testing::HasSubstr(text));
        EXPECT_FALSE(std::filesystem::exists(folder / "out/report.json")) << text;
    }
}

/// Fixture for tests of another renderer that draws the views of `catoptric views`. Here Catoptric
/// itself draws the pictures, so their row must have the same errors as the row of the technique
/// that drew them.
class ViewPictureRowsCliTest : public PictureRowsCliTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        const test::ProcessResult ended = run_cli(
            {"views", "flat", "--count", "6", "--seed", "9", "--size", "48x32", "-o", "views"});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        views_ = json::parse(read_file_at_path(folder / "views/views.json"))["views"];
        ASSERT_EQ(views_.size(), 7U);
        for (const json& view : views_) render_view(view);
    }

    void render_view(const json& view) const {
        const json& camera = view["camera"];
        std::string text;
        for (const char* point : {"eye", "target"}) {
            for (const json& number : camera[point]) text += number.dump() + ",";
            text.back() = ':';
        }
        text += camera["vertical_fov_degrees"].dump();
        const std::string file = "views/" + view["name"].get<std::string>() + ".exr";
        ASSERT_EQ(run_cli({"render", "flat", "--technique", "reuse:face=16", "--size", "48x32",
                           "--camera", text, "--time", view["time"].dump(), "-o", file})
                      .exit_code,
                  0);
    }

    test::ProcessResult compare_views(const Words& more = {}) const {
        Words words{"compare", "flat",    "--size", "48x32", "--seed",
                    "9",       "--views", "6",      "-o",    "out"};
        words.insert(words.end(), more.begin(), more.end());
        for (const char* word :
             {"--frames", "6", "--row", "mine=views", "--techniques", "reuse:face=16"})
            words.emplace_back(word);
        return run_cli(words);
    }

    json views_;
};

TEST_F(ViewPictureRowsCliTest, OwnPicturesHandedBackHaveTheSameErrorsInEachView) {
    const test::ProcessResult ended = compare_views();
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json own = read_report_row(0), back = read_report_row(1);
    EXPECT_EQ(back["label"], "mine");
    EXPECT_NEAR(back["error"]["flip"], own["error"]["flip"].get<double>(), 1e-6);
    for (const char* figure : {"flip", "rmse"}) {
        const json &values = back["views"]["error"][figure]["values"],
                   &wanted = own["views"]["error"][figure]["values"];
        ASSERT_EQ(values.size(), 6U);
        for (std::size_t i = 0; i < 6; ++i)
            EXPECT_NEAR(values[i], wanted[i].get<double>(), 1e-6) << figure << " of view " << i + 1;
    }
    EXPECT_EQ(back["views"]["worst"]["view"], own["views"]["worst"]["view"]);
    EXPECT_TRUE(std::filesystem::exists(folder / "out/images/worst-picture1-mine.png"));
    const json report = json::parse(read_file_at_path(folder / "out/report.json"));
    EXPECT_THAT(report["warnings"].dump(), testing::Not(testing::HasSubstr("'mine'")));
    EXPECT_EQ(report["views"][2]["camera"]["eye"], views_[3]["camera"]["eye"]);
}

TEST_F(ViewPictureRowsCliTest, PicturesOfOtherViewsAreRefused) {
    Words words{"compare", "flat", "--size", "48x32", "--seed", "8", "--views", "6", "-o", "out"};
    for (const char* word : {"--row", "mine=views", "--techniques", "reuse:face=16"})
        words.emplace_back(word);
    const test::ProcessResult other = run_cli(words);
    EXPECT_EQ(other.exit_code, 65) << other.err;
    EXPECT_THAT(other.err, testing::HasSubstr("views/views.json: wanted the views of this "
                                              "comparison, found another view-001; scene, --views, "
                                              "--seed, --camera and --time must be those of"));
    words[5] = "9", words[7] = "7"; // one view more than the folder has
    EXPECT_THAT(run_cli(words).err, testing::HasSubstr("found another view-007"));
}

TEST_F(ViewPictureRowsCliTest, MissingDoubleAndTurnedPicturesAreNamed) {
    namespace measure = catoptric::measure;
    const measure::Picture own = measure::read_picture(folder / "views/view-004.exr");
    measure::Picture turned(own.width, own.height);
    for (int y = 0; y < own.height; ++y)
        for (int x = 0; x < own.width; ++x) turned.at(x, y) = own.at(x, own.height - 1 - y);
    measure::write_exr(turned, folder / "views/view-004.exr");
    const test::ProcessResult studied = compare_views({"--work", "--causes"});
    ASSERT_EQ(studied.exit_code, 0) << "studies of rows that are not drawn: " << studied.err;
    EXPECT_THAT(json::parse(read_file_at_path(folder / "out/report.json"))["warnings"].dump(),
                testing::HasSubstr("'mine', 'view-004': its picture is upside down"));
    std::filesystem::copy(folder / "views/view-002.exr", folder / "views/view-002.hdr");
    EXPECT_THAT(compare_views().err,
                testing::HasSubstr("views: wanted one view-002.exr, .hdr or .png, found several"));
    std::filesystem::remove(folder / "views/view-002.hdr");
    std::filesystem::remove(folder / "views/view-006.exr");
    const test::ProcessResult missing = compare_views();
    EXPECT_EQ(missing.exit_code, 65);
    EXPECT_THAT(missing.err,
                testing::HasSubstr("views: wanted one view-006.exr, .hdr or .png, found none"));
    measure::write_exr(measure::Picture(5, 4), folder / "views/view-006.exr");
    EXPECT_THAT(compare_views().err, testing::HasSubstr("view-006.exr: wanted a picture of 48x32"));
}

/// views.gltf and views.json hold the same cameras. The test computes eye and direction of each
/// camera in views.gltf by the rules of glTF 2.0.
TEST_F(PictureRowsCliTest, ViewsAsGltfAreThoseOfTheJson) {
    ASSERT_EQ(
        run_cli({"views", "courtyard", "--count", "8", "--size", "64x48", "-o", "v"}).exit_code, 0);
    const json views = json::parse(read_file_at_path(folder / "v/views.json"))["views"],
               gltf = json::parse(read_file_at_path(folder / "v/views.gltf"));
    ASSERT_EQ(gltf["nodes"].size(), 9U);
    for (std::size_t i = 0; i < 9; ++i) {
        const json &node = gltf["nodes"][i], &camera = views[i]["camera"],
                   &lens = gltf["cameras"][node["camera"].get<std::size_t>()]["perspective"];
        EXPECT_EQ(node["name"], views[i]["name"]);
        EXPECT_NEAR(lens["yfov"].get<double>() * 180 / 3.14159265358979,
                    camera["vertical_fov_degrees"].get<double>(), 1e-6);
        EXPECT_NEAR(lens["aspectRatio"], 64.0 / 48, 1e-12);
        std::array<double, 3> forward{}, wanted{};
        const auto q = node["rotation"].get<std::array<double, 4>>(); // x, y, z, w
        forward = {-2 * (q[0] * q[2] + q[3] * q[1]), -2 * (q[1] * q[2] - q[3] * q[0]),
                   -(1 - 2 * (q[0] * q[0] + q[1] * q[1]))};
        double length = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_EQ(node["translation"][k], camera["eye"][k]);
            wanted[k] = camera["target"][k].get<double>() - camera["eye"][k].get<double>();
            length += wanted[k] * wanted[k];
        }
        // The y axis of the camera points up: this axis lies in the plane of the view direction and
        // the scene's up vector.
        const double up_y = 1 - 2 * (q[0] * q[0] + q[2] * q[2]);
        EXPECT_GT(up_y, 0);
        for (std::size_t k = 0; k < 3; ++k)
            EXPECT_NEAR(forward[k], wanted[k] / std::sqrt(length), 1e-9) << i << " " << k;
    }
}

TEST_F(PictureRowsCliTest, ViewsAreRefusedWithoutAFolderOrWithTooFew) {
    EXPECT_EQ(run_cli({"views", "room"}).exit_code, 2);
    const test::ProcessResult few = run_cli({"views", "room", "--count", "3", "-o", "v"});
    EXPECT_EQ(few.exit_code, 2);
    EXPECT_THAT(few.err, testing::HasSubstr("--count: wanted 1 or at least 6"));
    EXPECT_FALSE(std::filesystem::exists(folder / "v"));
}

} // namespace
