#include "report/writer.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "measure/picture_file.hpp"
#include "report/html.hpp"
#include "report_sample.hpp"
#include "support/folder.hpp"
#include "support/special_values.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <limits>
#include <regex>

namespace {

namespace fs = std::filesystem;

std::size_t count_texts(const std::string& text, const std::string& searched) {
    std::size_t count = 0;
    for (std::size_t at = text.find(searched); at != text.npos; at = text.find(searched, at + 1))
        ++count;
    return count;
}
using catoptric::Error;
using catoptric::Failure;
using catoptric::report::Comparison;
using namespace catoptric::report::sample;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

TEST(ReportJson, JsonReportHasTheDocumentedFieldsInOrder) {
    const std::string text = catoptric::report::to_json(make_usual_comparison());
    const auto document = nlohmann::ordered_json::parse(text);
    std::vector<std::string> names;
    for (const auto& [name, value] : document.items()) names.push_back(name);
    EXPECT_THAT(names, ElementsAre("schema", "version", "commit", "date", "command", "complete",
                                   "device", "scene", "setup", "size", "frames", "warmup", "rounds",
                                   "timing", "load", "time", "ambient", "exposure", "flip_source",
                                   "together", "warnings", "reference", "model", "views", "rows",
                                   "pareto", "judged_time", "verdict"));
    EXPECT_EQ(document["schema"], "catoptric/compare/1");
    EXPECT_EQ(document["size"], json::parse("[4, 3]"));
    EXPECT_EQ(document["command"], json::parse(R"(["catoptric", "compare", "-o", "out"])"));
    EXPECT_EQ(document["reference"]["settings"], json::parse(R"({"depth": 16, "shadow": "ray"})"));
    EXPECT_EQ(document["pareto"], json::parse("[0, 2, 3]"));
    EXPECT_EQ(document["warnings"], json::array());
}

TEST(ReportJson, JsonRowHasTheDocumentedFields) {
    const json document = json::parse(catoptric::report::to_json(make_usual_comparison()));
    const json& first = document["rows"][0];
    for (const char* name : {"technique",
                             "settings",
                             "label",
                             "scene_passes",
                             "scene_draws",
                             "gpu_ms",
                             "cpu_record_ms",
                             "wall_ms",
                             "host_ms",
                             "host_parts",
                             "frame_ms",
                             "passes",
                             "error",
                             "error_first_order",
                             "error_mirror_in_mirror",
                             "error_non_mirror",
                             "error_all",
                             "error_dielectrics",
                             "error_rough",
                             "error_per_mirror",
                             "memory_bytes",
                             "traced_fraction",
                             "rays",
                             "mean",
                             "mean_clamped",
                             "image",
                             "model"})
        EXPECT_TRUE(first.contains(name)) << name;
    EXPECT_EQ(first["settings"], json::parse(R"({"bounces": 0, "face": 256})"));
    EXPECT_EQ(first["gpu_ms"]["samples"].size(), 3U);
    EXPECT_EQ(first["error"]["mask"], "mirrors");
    EXPECT_EQ(first["error_per_mirror"][1]["mirror"], 2);
    EXPECT_EQ(first["passes"][0]["name"], "shadow");
    EXPECT_EQ(first["image"], "images/naive0.png");
    EXPECT_EQ(document["rows"][3]["rays"],
              json::parse(R"({"primary": 12, "mirror": 6, "shadow": 18})"));
}

TEST(ReportJson, JsonReportWritesNullForMissingNumbers) {
    Comparison made = make_usual_comparison();
    made.rows[0].error.rmse = test::kDoubleNan;
    made.rows[0].gpu_ms.p95 = std::numeric_limits<double>::infinity();
    made.reference_gpu_ms = {};
    const json document = json::parse(catoptric::report::to_json(made));
    EXPECT_TRUE(document["rows"][0]["error"]["rmse"].is_null());
    EXPECT_TRUE(document["rows"][0]["gpu_ms"]["p95"].is_null());
    EXPECT_TRUE(document["rows"][0]["rays"].is_null());
    EXPECT_TRUE(document["rows"][0]["traced_fraction"].is_null());
    EXPECT_TRUE(document["rows"][0]["error_mirror_in_mirror"]["flip"].is_null());
    EXPECT_TRUE(document["rows"][0]["mean"][0].is_null());
    EXPECT_EQ(document["rows"][3]["error"]["rmse"], 0);
    EXPECT_TRUE(document["rows"][3]["error"]["psnr"].is_null());
    EXPECT_EQ(document["rows"][1]["error"]["psnr"], 20);
    EXPECT_EQ(document["rows"][1]["error"]["off"], made.rows[1].error.off);
    EXPECT_EQ(document["rows"][1]["error"]["longest_line"], made.rows[1].error.longest_line);
    EXPECT_TRUE(document["rows"][0]["error_mirror_in_mirror"]["longest_line"].is_null());
    EXPECT_TRUE(document["reference"]["gpu_ms"].is_null());
}

TEST(ReportJson, JsonReportStoresTheEdgeThatAnAutomaticFaceChose) {
    Comparison made = make_usual_comparison();
    made.rows[1].settings = {make_choice_setting("face", "auto", true)};
    made.rows[1].auto_face = {.edge = 64, .needs = {39.5, 0}};
    const json document = json::parse(catoptric::report::to_json(made));
    EXPECT_EQ(document["rows"][1]["settings"]["face"], "auto");
    EXPECT_EQ(document["rows"][1]["auto_face"], json::parse(R"({"edge": 64, "needs": [39.5, 0]})"));
    EXPECT_TRUE(document["rows"][0]["auto_face"].is_null());
}

TEST(ReportJson, JsonReportMarksFailedRowsAndAcceptsInvalidUtf8) {
    Comparison made = make_usual_comparison();
    made.rows[1].error.nonfinite = 2;
    made.clear_ms = make_time_samples(0.5);
    made.scene.name = "bytes that are no UTF-8: \xff\xfe";
    const json document = json::parse(catoptric::report::to_json(made));
    EXPECT_EQ(document["rows"][1]["failed"], true);
    EXPECT_FALSE(document["rows"][0].contains("failed"));
    EXPECT_EQ(document["clear_ms"]["median"], 0.5);
}

TEST(ReportJson, ReportOfARunWithoutRowsIsValid) {
    const Comparison nothing;
    const json document = json::parse(catoptric::report::to_json(nothing));
    EXPECT_EQ(document["rows"], json::array());
    EXPECT_EQ(document["command"], json::array());
    EXPECT_EQ(document["reference"]["settings"], json::object());
    EXPECT_THAT(report_text_of_comparison(nothing), HasSubstr("no front"));
    EXPECT_THAT(catoptric::report::to_html(nothing), HasSubstr("</html>"));
}

TEST(ReportCsv, CsvReportQuotesFieldsAndEndsLinesByTheStandard) {
    Comparison made = make_usual_comparison();
    made.rows[0].label = "naive:bounces=0,face=512";
    made.rows[1].model = "say \"everything\"\nor not";
    const std::string csv = catoptric::report::to_csv(made, catoptric::report::CsvColumns::all);
    EXPECT_THAT(csv, HasSubstr("\"naive:bounces=0,face=512\",\"bounces=0, face=256\","));
    EXPECT_THAT(csv, HasSubstr("\"say \"\"everything\"\"\nor not\""));
    EXPECT_TRUE(
        csv.starts_with("technique,label,settings,model,place_first,place_last,scene_passes,"));
    EXPECT_TRUE(csv.ends_with("\r\n"));
    EXPECT_THAT(csv, Not(HasSubstr("nan")));
}

TEST(ReportCsv, EveryCsvLineHasTheSameNumberOfFields) {
    Comparison made = make_usual_comparison();
    made.rows[2].error_per_mirror.clear();
    const std::string csv = catoptric::report::to_csv(made, catoptric::report::CsvColumns::all);
    std::vector<std::ptrdiff_t> commas;
    bool quoted = false;
    commas.push_back(0);
    for (const char c : csv) {
        if (c == '"') quoted = !quoted;
        if (c == ',' && !quoted) ++commas.back();
        if (c == '\n' && !quoted) commas.push_back(0);
    }
    ASSERT_EQ(commas.size(), 6U); // the header, four rows and an empty rest
    for (int line = 1; line < 5; ++line) EXPECT_EQ(commas[line], commas[0]);
}

TEST(ReportHtml, HtmlReportEscapesTextAndLoadsNothingFromOutside) {
    Comparison made = make_usual_comparison();
    made.scene.name = "<script>alert('x')</script>\" onload=\"&";
    made.warnings = {"<img src=x>"};
    made.rows[0].label = "naive:<b>";
    made.rows[1].label = "</script><script>alert('y')</script>";
    const std::string html = catoptric::report::to_html(made);
    EXPECT_THAT(html, Not(HasSubstr("<script>alert")));
    EXPECT_EQ(count_texts(html, "<script"), 5)
        << "data of comparer and chart, the page's script, the library of charts and its script";
    EXPECT_EQ(count_texts(html, "</script"), 5);
    EXPECT_THAT(
        html,
        HasSubstr("&lt;script&gt;alert(&#39;x&#39;)&lt;/script&gt;&quot; onload=&quot;&amp;"));
    EXPECT_THAT(html, Not(HasSubstr("<img src=x>")));
    EXPECT_THAT(html, Not(HasSubstr("<b>")));
    std::string own = html; // the library names its project in a comment
    const std::string library = catoptric::report::kChartLibrary;
    ASSERT_NE(own.find(library), own.npos);
    own.erase(own.find(library), library.size());
    for (const char* outside : {"http://", "https://", "@import", "url("})
        EXPECT_THAT(own, Not(HasSubstr(outside)));
    for (const char* outside : {"@import", "url("}) EXPECT_THAT(library, Not(HasSubstr(outside)));
}

TEST(ReportHtml, HtmlReportEmbedsThePlotAndEveryPicture) {
    const std::string html = catoptric::report::to_html(make_usual_comparison());
    const std::regex pictures(
        "<img [^>]*alt=\"[^\"]+\" src=\"data:image/png;base64,iVBORw0KGgo[A-Za-z0-9+/]*=*\">");
    EXPECT_EQ(std::distance(std::sregex_iterator(html.begin(), html.end(), pictures),
                            std::sregex_iterator()),
              9);
    EXPECT_THAT(html, HasSubstr("<svg viewBox"));
    EXPECT_THAT(html, HasSubstr("class=\"step\""));
    EXPECT_THAT(html, HasSubstr("id=\"row-3\""));
    EXPECT_THAT(html, Not(HasSubstr("nan")));
}

/// A bar in the plot is as long as the 95 % interval of the row's time. A row without an interval
/// has no bar.
TEST(ReportHtml, HtmlPlotDrawsIntervalsOfTimes) {
    using catoptric::report::to_html;
    Comparison made = make_usual_comparison();
    made.rows[1].gpu_ms = make_time_samples(7, .2);
    made.rows[3].gpu_ms.ci95 = {};
    const std::string html = to_html(made);
    const std::regex bar("class=\"interval\" d=\"M([0-9.]+) [0-9.]+H([0-9.]+)\"");
    std::vector<double> lengths;
    for (std::sregex_iterator at(html.begin(), html.end(), bar), end; at != end; ++at)
        lengths.push_back(std::stod((*at)[2]) - std::stod((*at)[1]));
    ASSERT_EQ(lengths.size(), 3u);
    EXPECT_EQ(lengths[0], 0) << "known exactly";
    EXPECT_GT(lengths[1], 20) << "from 5.6 to 8.4 ms";
    EXPECT_EQ(lengths[2], 0);
}

/// In the plot, three rows that differ in one knob are joined in the order of the knob's values.
/// Two such rows are not joined, and neither are rows that differ in two knobs.
TEST(ReportHtml, HtmlPlotJoinsRowsAlongAKnob) {
    using namespace catoptric::report::sample;
    const auto count_curves = [](const Comparison& made) {
        const std::string html = catoptric::report::to_html(made);
        const std::regex curve("class=\"curve\" d=\"(M[^\"]*)\"");
        std::vector<std::string> found;
        for (std::sregex_iterator at(html.begin(), html.end(), curve), end; at != end; ++at)
            found.push_back((*at)[1]);
        return found;
    };
    Comparison made = make_usual_comparison();
    made.rows = {make_naive_row(2, 4, .2, .2), make_naive_row(4, 16, .1, .1)};
    EXPECT_EQ(count_curves(made).size(), 0u);
    made.rows.push_back(make_naive_row(3, 8, .3, .3));
    ASSERT_EQ(count_curves(made).size(), 1u);
    const std::regex places("M([0-9.]+) [0-9.]+L([0-9.]+) [0-9.]+L([0-9.]+) [0-9.]+");
    std::smatch at;
    const std::string path = count_curves(made).front();
    ASSERT_TRUE(std::regex_match(path, at, places)) << path;
    EXPECT_LT(std::stod(at[1]), std::stod(at[2]));
    EXPECT_NEAR(std::stod(at[2]) - std::stod(at[1]), std::stod(at[3]) - std::stod(at[2]), .2)
        << "4, 8 and 16 ms on a logarithmic axis";
    made.rows[2].settings[1].text = "512";
    EXPECT_EQ(count_curves(made).size(), 0u);
}

class ReportWritingTest : public test::InFolder {
protected:
    Error catch_error_of_writing_report(const fs::path& path) const {
        try {
            catoptric::report::write(make_usual_comparison(), path);
        } catch (const Error& error) {
            return error;
        }
        return Error(Failure::internal, "nothing was thrown");
    }
};

TEST_F(ReportWritingTest, WrittenReportReplacesItsOldFilesAndKeepsOthers) {
    const fs::path out = folder / "out";
    fs::create_directories(out / "images");
    catoptric::write_file(out / "report.json", std::string(1 << 20, 'x'));
    catoptric::write_file(out / "notes.txt", "stays");
    catoptric::report::write(make_usual_comparison(), out / "");
    EXPECT_EQ(catoptric::read_file(out / "report.json"),
              catoptric::report::to_json(make_usual_comparison()));
    EXPECT_EQ(catoptric::read_file(out / "report.md"),
              report_text_of_comparison(make_usual_comparison()));
    EXPECT_EQ(catoptric::read_file(out / "report.html"),
              catoptric::report::to_html(make_usual_comparison()));
    EXPECT_EQ(catoptric::read_file(out / "rows.csv"),
              catoptric::report::to_csv(make_usual_comparison()));
    EXPECT_EQ(catoptric::read_file(out / "notes.txt"), "stays");
    for (const char* name :
         {"reference.png", "naive0.png", "naive0.exr", "naive0-error.png", "raytrace.png"})
        EXPECT_EQ(catoptric::measure::read_picture(out / "images" / name).width, 4) << name;
    EXPECT_EQ(std::distance(fs::directory_iterator(out), fs::directory_iterator()), 6);
    EXPECT_EQ(std::distance(fs::directory_iterator(out / "images"), fs::directory_iterator()), 23);
}

TEST_F(ReportWritingTest, WritingAReportCreatesTheFolderAndItsParents) {
    const fs::path out = folder / "missing" / "too" / "out";
    catoptric::report::write(make_usual_comparison(), out);
    EXPECT_EQ(catoptric::read_file(out / "report.json"),
              catoptric::report::to_json(make_usual_comparison()));
}

TEST_F(ReportWritingTest, WritingAReportFailsIfTheFolderIsAFile) {
    catoptric::write_file(folder / "out", "a file");
    const Error error = catch_error_of_writing_report(folder / "out");
    EXPECT_EQ(error.failure, Failure::cannot_create);
    EXPECT_THAT(error.what(),
                HasSubstr("out/images: the folder cannot be created: Not a directory"));
    EXPECT_EQ(catoptric::read_file(folder / "out"), "a file");
}

} // namespace
