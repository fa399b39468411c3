// Tests of incomplete reports. Every file of a running or stopped run says so, and each picture is
// written once.
#include "core/file.hpp"
#include "measure/lag.hpp"
#include "measure/picture_file.hpp"
#include "measure/views.hpp"
#include "report/stress.hpp"
#include "report/writer.hpp"
#include "report_sample.hpp"
#include "support/folder.hpp"

#include <gmock/gmock.h>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>

namespace {

namespace fs = std::filesystem;
using namespace catoptric::report::sample;
using catoptric::Error;
using catoptric::Failure;
using catoptric::report::Comparison;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

const Error kDeviceLostError(Failure::device_lost, "Vulkan: cannot run frame 7: \"lost\"");
const std::string kDeviceLostReportText = "4 of 8 rows: Vulkan: cannot run frame 7: \"lost\"";

Comparison make_stopped_comparison() {
    Comparison made = make_usual_comparison();
    made.complete = false;
    made.asked = 8;
    made.stopped = kDeviceLostError;
    return made;
}

TEST(IncompleteReport, EveryFileSaysWhyTheRunStoppedAndHowManyRowsItHas) {
    const json document = json::parse(catoptric::report::to_json(make_stopped_comparison()));
    EXPECT_EQ(document["complete"], false);
    EXPECT_EQ(document["incomplete"], kDeviceLostReportText);
    EXPECT_EQ(document["rows_asked"], 8);
    EXPECT_EQ(document["rows"].size(), 4U);
    EXPECT_THAT(catoptric::report::to_markdown(make_stopped_comparison()),
                HasSubstr("> Incomplete, " + kDeviceLostReportText));
    EXPECT_THAT(catoptric::report::to_html(make_stopped_comparison()),
                HasSubstr("Incomplete, 4 of 8 rows: Vulkan: cannot run frame 7: &quot;lost&quot;"));
    const std::string csv = catoptric::report::to_csv(make_stopped_comparison());
    EXPECT_THAT(csv.substr(0, csv.find("\r\n")), testing::EndsWith(",incomplete"));
    EXPECT_THAT(
        csv, testing::EndsWith(",\"4 of 8 rows: Vulkan: cannot run frame 7: \"\"lost\"\"\"\r\n"));
}

TEST(IncompleteReport, ReportOfARunningRunSaysThatTheRunHasNotEnded) {
    Comparison made = make_stopped_comparison();
    made.stopped.reset();
    const std::string why = "4 of 8 rows: the run had not ended when this was written";
    EXPECT_EQ(json::parse(catoptric::report::to_json(made))["incomplete"], why);
    made.lag = std::make_shared<catoptric::measure::LagResults>();
    made.lag->complete = false;
    EXPECT_EQ(json::parse(catoptric::report::to_json(made))["incomplete"],
              why + "; their lag was not measured to its end");
}

TEST(IncompleteReport, CompleteReportIsNotMarkedIncomplete) {
    const Comparison made = make_usual_comparison();
    EXPECT_FALSE(json::parse(catoptric::report::to_json(made)).contains("incomplete"));
    EXPECT_THAT(catoptric::report::to_markdown(made), Not(HasSubstr("ncomplete")));
    EXPECT_THAT(catoptric::report::to_html(made), Not(HasSubstr("ncomplete")));
    EXPECT_THAT(catoptric::report::to_csv(made), testing::EndsWith(",\r\n"));
}

TEST(IncompleteReport, ReportWithoutRowsIsMarkedIncompleteToo) {
    Comparison made = make_stopped_comparison();
    made.rows.clear(), made.pareto.clear();
    const std::string csv = catoptric::report::to_csv(made);
    const std::string only = csv.substr(csv.find("\r\n") + 2);
    EXPECT_THAT(only, testing::MatchesRegex(",+\"0 of 8 rows: .*\"\r\n"));
    const auto fields = [](const std::string& line) {
        return std::count(line.begin(), line.end(), ',');
    };
    EXPECT_EQ(fields(only), fields(csv.substr(0, csv.find("\r\n"))));
    EXPECT_THAT(catoptric::report::to_html(made), HasSubstr("Incomplete, 0 of 8 rows"));
}

class GrowingReport : public test::InFolder {
protected:
    std::vector<std::string> list_image_files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder / "out/images"))
            names.push_back(entry.path().filename());
        std::ranges::sort(names);
        return names;
    }
};

/// The report is written after each row. Each time, all text files are written, but only the
/// pictures of new rows.
TEST_F(GrowingReport, EachPictureIsWrittenOnce) {
    Comparison whole = make_usual_comparison();
    Comparison made = whole;
    made.complete = false;
    made.asked = 4;
    made.rows.resize(1);
    made.rows[0].causes = std::make_shared<catoptric::measure::Causes>();
    made.rows[0].causes->largest.resize(made.rows[0].display.pixels.size());
    whole.rows[0].causes = made.rows[0].causes;
    catoptric::report::ReportWriter writer(folder / "out");
    writer.write(made);
    EXPECT_EQ(list_image_files(), (std::vector<std::string>{
                                      "causes-naive0.js", "causes-naive0.png", "mirrors.js",
                                      "naive0-error.js", "naive0-error.png", "naive0.exr",
                                      "naive0.js", "naive0.png", "reference.js", "reference.png"}));
    std::vector<fs::path> missing = catoptric::report::list_files({"naive0"});
    EXPECT_EQ(missing.size(), 4 + list_image_files().size() + 8);
    std::erase_if(missing, [&](const fs::path& file) { return fs::exists(folder / "out" / file); });
    EXPECT_EQ(missing, (std::vector<fs::path>{
                           "images/worst-naive0.png",      // the run drew no views
                           "images/lag-naive0-moving.exr", // and measured no lag
                           "images/lag-naive0-moving.js", "images/lag-naive0-still.exr",
                           "images/lag-naive0-still.js", "images/lag-naive0-reference.exr",
                           "images/lag-naive0-reference.js", "images/lag-naive0-mirrors.js"}));
    fs::remove_all(folder / "out/images");
    made.rows.push_back(whole.rows[1]);
    writer.write(made);
    const std::string second = whole.rows[1].image;
    EXPECT_EQ(list_image_files(),
              (std::vector<std::string>{second + "-error.js", second + "-error.png",
                                        second + ".exr", second + ".js", second + ".png"}));
    // The causes of a row's error may arrive after the row itself.
    made.rows[1].causes = whole.rows[1].causes = made.rows[0].causes;
    fs::remove_all(folder / "out/images");
    writer.write(made);
    EXPECT_EQ(list_image_files(),
              (std::vector<std::string>{"causes-" + second + ".js", "causes-" + second + ".png"}));
    EXPECT_EQ(json::parse(catoptric::read_file(folder / "out/report.json"))["rows"].size(), 2U);
    writer.write(whole);
    for (const auto& [file, text] : {std::pair("report.json", catoptric::report::to_json(whole)),
                                     std::pair("report.html", catoptric::report::to_html(whole)),
                                     std::pair("report.md", catoptric::report::to_markdown(whole)),
                                     std::pair("rows.csv", catoptric::report::to_csv(whole))})
        EXPECT_TRUE(catoptric::read_file(folder / "out" / file) == text) << file;
}

/// The instant of the largest lag is known after some speeds of a row, and may change with further
/// speeds. Its pictures are written again only if it changes.
TEST_F(GrowingReport, LagPicturesAreWrittenAgainWhenTheirInstantChanges) {
    Comparison made = make_usual_comparison();
    made.rows.resize(2);
    made.lag = std::make_shared<catoptric::measure::LagResults>();
    made.lag->seconds = {0, 1};
    for (const auto& row : made.rows) made.lag->rows.push_back({.label = row.label});
    catoptric::report::ReportWriter writer(folder / "out");
    writer.write(made);
    const std::string lag = "lag-" + made.rows[1].image;
    const auto list_lag_files = [&] {
        std::vector<std::string> files = list_image_files();
        std::erase_if(files, [](const std::string& file) { return !file.starts_with("lag-"); });
        return files;
    };
    EXPECT_EQ(list_lag_files(), std::vector<std::string>());
    EXPECT_TRUE(json::parse(catoptric::report::to_json(made))["lag"]["rows"][1]["worst"].is_null());
    catoptric::measure::Picture grey(9, 3);
    grey.pixels.assign(27, catoptric::vec3(.5f));
    made.lag->rows[1].worst = {.speed = 2,
                               .seconds = 1,
                               .flip = .25,
                               .moving = grey,
                               .still = catoptric::measure::Picture(9, 3),
                               .reference = grey,
                               .mirror_hits = std::vector<std::uint32_t>(27, 0x10002)};
    writer.write(made);
    const std::vector<std::string> wanted{
        lag + "-mirrors.js",   lag + "-moving.exr", lag + "-moving.js", lag + "-reference.exr",
        lag + "-reference.js", lag + "-still.exr",  lag + "-still.js"};
    EXPECT_EQ(list_lag_files(), wanted);
    EXPECT_EQ(
        catoptric::measure::read_picture(folder / "out/images" / (lag + "-moving.exr")).pixels,
        grey.pixels);
    EXPECT_EQ(catoptric::measure::read_picture(folder / "out/images" / (lag + "-still.exr")).pixels,
              made.lag->rows[1].worst->still.pixels);
    const json worst = json::parse(
        catoptric::read_file(folder / "out/report.json"))["lag"]["rows"][1]["worst"];
    EXPECT_EQ(worst, (json{{"speed", 2},
                           {"seconds", 1},
                           {"flip", .25},
                           {"moving", "images/" + lag + "-moving.exr"},
                           {"still", "images/" + lag + "-still.exr"},
                           {"reference", "images/" + lag + "-reference.exr"}}));
    const std::string page = catoptric::report::to_html(made);
    EXPECT_THAT(page, HasSubstr("worst lag of " + made.rows[1].label + ": 2x, 1.00 s"));
    EXPECT_THAT(page, Not(HasSubstr("worst lag of " + made.rows[0].label + ":")));
    fs::remove_all(folder / "out/images");
    writer.write(made);
    EXPECT_EQ(list_lag_files(), std::vector<std::string>());
    made.lag->rows[1].worst->speed = 4;
    writer.write(made);
    EXPECT_EQ(list_lag_files(), wanted);
    // A copy for a report on several scenes keeps the figures.
    const Comparison bare = catoptric::report::without_pictures(made);
    EXPECT_TRUE(bare.lag->rows[1].worst->moving.pixels.empty());
    EXPECT_TRUE(bare.lag->rows[1].worst->mirror_hits.empty());
    EXPECT_EQ(json::parse(catoptric::report::to_json(bare))["lag"],
              json::parse(catoptric::report::to_json(made))["lag"]);
    EXPECT_FALSE(made.lag->rows[1].worst->moving.pixels.empty());
}

/// The worst view of a row may change with every drawn view. The picture of a changed worst view is
/// written again.
TEST_F(GrowingReport, WorstViewPicturesAreWrittenAgainWhenTheyChange) {
    Comparison made = make_usual_comparison();
    made.complete = false;
    made.rows.resize(2);
    made.views.resize(6);
    for (auto& row : made.rows) row.views.resize(3);
    catoptric::report::ReportWriter writer(folder / "out");
    writer.write(made);
    made.rows[0].worst = std::make_shared<catoptric::measure::WorstView>(
        catoptric::measure::WorstView{0, catoptric::measure::Picture(9, 3)});
    made.rows[1].worst = std::make_shared<catoptric::measure::WorstView>(
        catoptric::measure::WorstView{0, catoptric::measure::Picture(9, 3)});
    fs::remove_all(folder / "out/images");
    writer.write(made);
    const auto of = [&](int row) { return "worst-" + made.rows[row].image + ".png"; };
    EXPECT_EQ(list_image_files(), (std::vector<std::string>{of(0), of(1)}));
    fs::remove_all(folder / "out/images");
    made.rows[1].worst->view = 2;
    writer.write(made);
    EXPECT_EQ(list_image_files(), std::vector<std::string>{of(1)});
    EXPECT_EQ(catoptric::read_file(folder / "out/report.html"), catoptric::report::to_html(made));
}

/// If a report has many bytes of pictures, the page loads them from files, because a large page
/// would open slowly.
TEST_F(GrowingReport, PageWithManyBytesOfPicturesLoadsThemFromFiles) {
    using catoptric::report::PagePictures;
    Comparison made = make_usual_comparison();
    const auto measure_page = [&](PagePictures pictures) {
        catoptric::report::ReportWriter writer(folder / "out", catoptric::report::CsvColumns::table,
                                               pictures);
        writer.write(made);
        return catoptric::read_file(folder / "out/report.html");
    };
    const std::string file = R"( loading="lazy" src="images/)" + made.rows[1].image + R"(.png">)";
    // Messages of a failure must not print pages of 16 MiB.
    const auto holds = [](const std::string& page, std::string_view text) {
        return page.find(text) != std::string::npos;
    };
    const std::string_view lazy = "loading=\"lazy\" src";
    EXPECT_FALSE(holds(measure_page(PagePictures::automatic), lazy));
    std::mt19937 random(7);
    made.rows[1].flip_map.clear();
    // A picture of noise, which no PNG shrinks.
    made.rows[1].display = catoptric::measure::Picture(2600, 2400);
    for (auto& pixel : made.rows[1].display.pixels)
        for (int k = 0; k < 3; ++k) pixel[k] = static_cast<float>(random() % 256) / 255;
    const std::string page = measure_page(PagePictures::automatic);
    EXPECT_TRUE(holds(page, file));
    EXPECT_FALSE(holds(page, "data:image/png"));
    EXPECT_LT(page.size(), 1U << 20);
    const std::string whole = measure_page(PagePictures::inlined);
    EXPECT_FALSE(holds(whole, lazy));
    EXPECT_GT(whole.size(), 16U << 20);
}

/// A file that could not be written is written again with the next row.
TEST_F(GrowingReport, FailedWriteIsRepeatedWithTheNextRow) {
    catoptric::report::ReportWriter writer(folder / "out");
    // A folder takes the name of a file that the writer will write.
    fs::create_directories(folder / "out/images/naive0.exr");
    Comparison made = make_usual_comparison();
    made.rows.resize(1);
    EXPECT_THROW(writer.write(made), Error);
    EXPECT_FALSE(fs::exists(folder / "out/report.json"));
    fs::remove(folder / "out/images/naive0.exr");
    writer.write(made);
    EXPECT_TRUE(fs::exists(folder / "out/images/naive0.exr"));
    EXPECT_TRUE(fs::exists(folder / "out/report.json"));
}

TEST_F(GrowingReport, IncompleteStressReportSaysSoInEveryFile) {
    using namespace catoptric::report;
    StressResults stress;
    stress.complete = false;
    stress.asked = 27;
    stress.stopped = kDeviceLostError;
    stress.rows = {{.id = "N1", .pictures = {{"N1-found", 4, 3, "a PNG"}}}};
    StressWriter writer(folder / "out");
    writer.write(stress);
    EXPECT_EQ(catoptric::read_file(folder / "out/images/N1-found.png"), "a PNG");
    const std::string why = "1 of 27 rows: Vulkan: cannot run frame 7: ";
    const json document = json::parse(catoptric::read_file(folder / "out/stress.json"));
    EXPECT_EQ(document["complete"], false);
    EXPECT_EQ(document["incomplete"], why + "\"lost\"");
    EXPECT_EQ(document["rows_asked"], 27);
    for (const char* file : {"stress.html", "stress.md"})
        EXPECT_THAT(catoptric::read_file(folder / "out" / file), HasSubstr("Incomplete, " + why));
    fs::remove_all(folder / "out/images");
    stress.complete = true;
    writer.write(stress);
    EXPECT_EQ(list_image_files(), std::vector<std::string>{}) << "pictures are written once";
    for (const char* file : {"stress.html", "stress.md", "stress.json"})
        EXPECT_THAT(catoptric::read_file(folder / "out" / file), Not(HasSubstr("ncomplete,")));
}

} // namespace
