// Tests of `catoptric results`: pages show the figures of the reports, and depend only on the
// reports.
#include "cli/program.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <map>

namespace {

using nlohmann::json;

/// Returns the time of a row by which its report judges rows.
json& judged_time_of_row(json& report, std::size_t row) {
    return report["rows"][row][report["judged_time"].get<std::string>()];
}

class ResultsSite : public CommandLineTest {
protected:
    /// Returns the report of a comparison of two rows on two scenes. The comparison runs once for
    /// all tests.
    const json& report_of_two_scenes() const {
        static const json report = [&] {
            Words words = add_small_frame_options({"compare", "cornell-mirrors", "flat", "-o",
                                                   "out", "--json", "--techniques", "raytrace",
                                                   "reuse:face=16"});
            const test::ProcessResult ended = run_cli(words);
            EXPECT_EQ(ended.exit_code, 0) << ended.err;
            return json::parse(ended.out);
        }();
        return report;
    }
    json report_of_one_scene() const { return report_of_two_scenes()["scenes"][0]; }

    std::string add_report_to_results_site(const json& report, const std::string& site) const {
        write_input_file("report.json", report.dump());
        const test::ProcessResult ended = run_cli({"results", "add", "report.json", site});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return ended.err;
    }
    void build(const std::string& site) const {
        const test::ProcessResult ended = run_cli({"results", "build", site, "--quiet"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
    }
    /// Returns all pages of a site, by file name.
    std::map<std::string, std::string> read_pages(const std::string& site) const {
        std::map<std::string, std::string> pages;
        for (const auto& entry : std::filesystem::directory_iterator(folder / site))
            if (entry.path().extension() == ".html")
                pages[entry.path().filename().string()] = read_file_at_path(entry.path());
        return pages;
    }
    /// Returns the page whose title contains the given text.
    std::string find_page(const std::string& site, const std::string& title) const {
        for (const auto& [name, text] : read_pages(site))
            if (text.find("<title>Reflections compared: " + title) != std::string::npos)
                return text;
        ADD_FAILURE() << "no page " << title;
        return "";
    }
};

TEST_F(ResultsSite, EachSceneHasAPageWithTheFiguresOfItsReport) {
    EXPECT_THAT(add_report_to_results_site(report_of_two_scenes(), "site"),
                testing::HasSubstr("2 comparisons"));
    EXPECT_THAT(add_report_to_results_site(report_of_two_scenes(), "site"),
                testing::HasSubstr("has this report"));
    build("site");
    EXPECT_EQ(read_pages("site").size(), 3u);
    for (const json& one : report_of_two_scenes()["scenes"]) {
        const std::string page = find_page("site", one["scene"]["name"]);
        const std::string time = one["judged_time"];
        for (const json& row : one["rows"]) {
            EXPECT_THAT(
                page, testing::HasSubstr(row["label"].get<std::string>() + "</th><td>" +
                                         fmt::format("{:.3f}", row[time]["median"].get<double>())));
            const double flip = row["error"]["flip"];
            const std::string cell = flip == 0 ? "<td>0</td>"
                                               : fmt::format("<td>{:.4f}</td>", flip);
            EXPECT_THAT(page, testing::HasSubstr(cell));
        }
        EXPECT_THAT(page, testing::HasSubstr("32x32, 0 s, camera from "));
        EXPECT_THAT(page, testing::HasSubstr(one["device"]["driver"].get<std::string>()));
        EXPECT_THAT(page, testing::Not(testing::HasSubstr("History")));
        const std::size_t front = one["pareto"][0];
        EXPECT_THAT(page,
                    testing::HasSubstr("<tr class=\"front\"><th scope=\"row\" class=\"text\">" +
                                       one["rows"][front]["label"].get<std::string>()));
        // Rows on the front have numbers from the fastest row on, in the plot and in the table.
        std::vector<std::pair<double, std::string>> rows;
        for (const std::size_t index : one["pareto"])
            rows.emplace_back(one["rows"][index][one["judged_time"].get<std::string>()]["median"],
                              one["rows"][index]["label"]);
        std::ranges::stable_sort(rows, {}, &std::pair<double, std::string>::first);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            const std::size_t line = page.find("class=\"text\">" + rows[i].second + "</th>");
            ASSERT_NE(line, std::string::npos);
            EXPECT_THAT(page.substr(line, page.find("</tr>", line) - line),
                        testing::EndsWith(fmt::format("<td>number {}</td>", i + 1)));
            EXPECT_THAT(page,
                        testing::HasSubstr(fmt::format(R"({{"label":{},"name":"{}","front":true}})",
                                                       json(rows[i].second).dump(), i + 1)));
        }
    }
}

TEST_F(ResultsSite, JsonOptionPrintsOneDocument) {
    write_input_file("report.json", report_of_one_scene().dump());
    for (const bool is_known : {false, true}) {
        const test::ProcessResult added = run_cli({"results", "add", "report.json", "s", "--json"});
        ASSERT_EQ(added.exit_code, 0) << added.err;
        const json document = json::parse(added.out);
        EXPECT_EQ(document["schema"], "catoptric/results-added/1");
        EXPECT_EQ(document["known"], is_known);
        EXPECT_EQ(document["comparisons"], 1);
        EXPECT_TRUE(
            std::filesystem::exists(folder / "s/reports" / document["report"].get<std::string>()));
    }
    const test::ProcessResult built = run_cli({"results", "build", "s", "--json"});
    EXPECT_EQ(json::parse(built.out), json::parse(R"({"schema": "catoptric/results-built/1",
        "index": "s/index.html", "pages": 2, "reports": 1})"));
}

/// If a report compares both models (`everything` and `required`), each row's label names its
/// model. Otherwise only the report's member `model` names it.
TEST_F(ResultsSite, LabelsNameTheModelOnce) {
    for (const bool both : {false, true}) {
        json report = report_of_one_scene();
        report["rows"][0]["label"] = std::string("reuse") + (both ? ", model=required" : "");
        report["rows"][0]["model"] = "required";
        const std::string site = both ? "both" : "one";
        add_report_to_results_site(report, site);
        build(site);
        EXPECT_THAT(find_page(site, report["scene"]["name"]),
                    testing::HasSubstr(">reuse, model=required</th>"));
    }
}

TEST_F(ResultsSite, PagesDependOnTheReportsAloneAndShowTheLatest) {
    json old = report_of_one_scene(), late = old;
    old["date"] = "2026-01-02T00:00:00Z", old["commit"] = "0ldc0de";
    late["date"] = "2026-02-03T00:00:00Z", late["commit"] = "1a7ec0de";
    judged_time_of_row(old, 1)["median"] = 111.5;
    judged_time_of_row(late, 1)["median"] = 222.25;
    for (const auto& [site, order] :
         std::map<std::string, std::vector<json>>{{"a", {old, late}}, {"b", {late, old}}}) {
        for (const json& report : order) add_report_to_results_site(report, site);
        build(site);
    }
    EXPECT_EQ(read_pages("a"), read_pages("b"));
    const std::string page = find_page("a", "cornell-mirrors");
    EXPECT_THAT(page, testing::HasSubstr("Latest report: 2026-02-03T00:00:00Z, commit 1a7ec0de"));
    EXPECT_THAT(page, testing::HasSubstr("the latest 2 of 2 reports"));
    EXPECT_LT(page.find("0ldc0de, 2026-01-02"), page.find("1a7ec0de, 2026-02-03"));
    EXPECT_LT(page.find("111.500 / "), page.find("222.250 / "));
    // Older reports judge by device time, and stand apart.
    json older = late;
    older.erase("judged_time");
    add_report_to_results_site(older, "older");
    build("older");
    const bool differs = late["judged_time"] == "cpu_ms";
    EXPECT_EQ(find_page("older", "cornell-mirrors").find(", by processor time"), std::string::npos);
    EXPECT_EQ(page.find(", by processor time") != page.npos, differs);
    // Reports with another light or camera belong to another setting, which has its own page.
    json other = late;
    other["exposure"] = 3;
    other["size"] = {64, 32};
    add_report_to_results_site(other, "a");
    build("a");
    EXPECT_EQ(read_pages("a").size(), 3u);
    for (const auto& entry : std::filesystem::directory_iterator(folder / "a/reports"))
        if (read_file_at_path(entry.path()).find("[64,32]") != std::string::npos)
            std::filesystem::remove(entry.path());
    build("a");
    EXPECT_EQ(read_pages("a"), read_pages("b")) << "pages of removed reports are removed";
}

/// Returns the results.json of a sweep with two sections, as `sweep merge` writes it.
json make_sweep_results() {
    const auto row = [](const char* label, double ms, double flip) {
        return json{{"label", label},
                    {"gpu_ms", {{"median", ms}, {"ci95", {ms - 1, ms + 1}}}},
                    {"error", {{"flip", flip}, {"rmse", flip / 2}}},
                    {"flip_ci95", {flip - .01, flip + .01}}};
    };
    const auto comparison = [&](const char* section, const json& rows, const json& front) {
        return json{{"scene", {{"name", "hall.glb"}, {"hash", section}}},
                    {"device", {{"name", "card"}, {"driver", "d1"}}},
                    {"machine", "m1"},
                    {"commit", "c0ffee"},
                    {"version", "0.1.0"},
                    {"date", "2026-01-02T00:00:00Z"},
                    {"setting", "size 8x8, median of 30 views"},
                    {"section", section},
                    {"rows", rows},
                    {"pareto", front}};
    };
    return {{"schema", "catoptric/sweep-results/1"},
            {"comparisons",
             {comparison("roughness .3", {row("reuse", 4, .25), row("secant", 8, .125)}, {0, 1}),
              comparison("roughness .1", {row("reuse", 6, .5), row("secant", 5, .0625)}, {1})}}};
}

TEST_F(ResultsSite, ASweepHasAPagePerSceneWithASectionPerCombination) {
    EXPECT_THAT(add_report_to_results_site(make_sweep_results(), "site"),
                testing::HasSubstr("2 comparisons"));
    build("site");
    EXPECT_EQ(read_pages("site").size(), 2u) << "overrides change a scene's hash, not its page";
    const std::string page = find_page("site", "hall.glb");
    EXPECT_THAT(page, testing::HasSubstr("sweep, size 8x8, median of 30 views"));
    EXPECT_THAT(page, testing::HasSubstr("card, d1, machine m1"));
    EXPECT_THAT(page,
                testing::HasSubstr("reuse</th><td><b>0.2500</b></td><td>0.5000</td></tr><tr><th "
                                   "scope=\"row\" class=\"text\">secant</th><td><b>0.1250</b>"
                                   "</td><td><b>0.0625</b></td>"))
        << "the overview, with the sections in the order of the sweep";
    EXPECT_LT(page.find("<h3>roughness .3"), page.find("<h3>roughness .1"));
    EXPECT_THAT(page, testing::HasSubstr("<td>5.000</td><td>4.000 to 6.000</td><td>0.0625</td><td>"
                                         "0.0525 to 0.0725</td><td>0.0312</td>"));
    EXPECT_THAT(read_pages("site")["index.html"],
                testing::HasSubstr("reuse (1 of 2), secant (2 of 2)"));
    // Times of another machine stand apart, and an earlier sweep becomes history.
    json other = make_sweep_results();
    other["comparisons"][0]["machine"] = "m2";
    other["comparisons"][1]["date"] = "2025-01-02T00:00:00Z";
    add_report_to_results_site(other, "site");
    build("site");
    const std::string both = find_page("site", "hall.glb");
    EXPECT_THAT(both, testing::HasSubstr("machine m2"));
    EXPECT_THAT(both, testing::HasSubstr("the latest 2 of 2 reports"));
    json broken = make_sweep_results();
    broken["comparisons"][1].erase("section");
    write_input_file("report.json", broken.dump());
    expect_usage_refused({"results", "add", "report.json", "refused"}, 65,
                         {"report.json: comparisons[1].section: wanted text, found nothing"});
    broken["comparisons"] = json::array();
    write_input_file("report.json", broken.dump());
    expect_usage_refused({"results", "add", "report.json", "refused"}, 65,
                         {"comparisons: wanted a list with an element, found a list"});
}

TEST_F(ResultsSite, TextOfReportsCannotBecomeMarkup) {
    json report = report_of_one_scene();
    report["scene"]["name"] = "<script>alert(1)</script>";
    report["device"]["name"] = "\"><img src=x onerror=alert(2)>";
    report["rows"][0]["label"] = "</title><b onclick='alert(3)'>";
    report["commit"] = "<i>";
    add_report_to_results_site(report, "site");
    build("site");
    for (const auto& [name, page] : read_pages("site"))
        for (const char* markup : {"<script>alert", "<img", "<b onclick", "<i>"})
            EXPECT_THAT(page, testing::Not(testing::HasSubstr(markup))) << name;
}

TEST_F(ResultsSite, RefusalsNameTheMember) {
    const auto refuse = [&](const std::function<void(json&)>& change, const Words& parts) {
        json report = report_of_one_scene();
        change(report);
        write_input_file("report.json", report.dump());
        expect_usage_refused({"results", "add", "report.json", "refused"}, 65, parts);
        EXPECT_FALSE(std::filesystem::exists(folder / "refused"));
    };
    refuse([](json& r) { r = 3; }, {"report.json: wanted an object, found '3'"});
    refuse([](json& r) { r["schema"] = "x"; }, {"wanted the schema catoptric/compare/1"});
    refuse([](json& r) { r["complete"] = false; }, {"wanted a complete report"});
    refuse([](json& r) { r["rows"] = json::array(); }, {"report.json: rows: wanted a list"});
    refuse([](json& r) { r["rows"][1].erase("label"); }, {"rows[1].label: wanted text"});
    refuse([](json& r) { judged_time_of_row(r, 0)["median"] = "fast"; },
           {"_ms.median: wanted a number from 0 to 1e+09, found '\"fast\"'"});
    refuse([](json& r) { judged_time_of_row(r, 0)["median"] = 1.7e308; }, {"from 0 to 1e+09"});
    refuse([](json& r) { r["judged_time"] = "wall_ms"; },
           {"judged_time: wanted gpu_ms, frame_ms or cpu_ms, found '\"wall_ms\"'"});
    refuse([](json& r) { r["rows"][0]["error"]["flip"] = 2; }, {"error.flip: wanted a number"});
    refuse([](json& r) { r["date"] = "zzzz"; }, {"date: wanted a date", "'zzzz'"});
    refuse([](json& r) { r["rows"][0]["error"] = 4; }, {"rows[0].error: wanted an object"});
    refuse([](json& r) { r["pareto"] = {9}; }, {"pareto: wanted numbers of rows, found '9'"});
    refuse([](json& r) { r["size"] = {1, -1}; }, {"size: wanted two numbers"});
    refuse([](json& r) { r["scene"]["camera"]["eye"] = {1, 2}; }, {"scene.camera.eye"});
    refuse([](json& r) { r.erase("device"); }, {"device: wanted an object, found nothing"});
    json stopped = report_of_two_scenes();
    stopped["complete"] = false;
    write_input_file("report.json", stopped.dump());
    expect_usage_refused({"results", "add", "report.json", "refused"}, 65, {"a complete report"});
    expect_usage_refused({"results", "add", "none.json", "site"}, 66, {"none.json"});
    expect_usage_refused({"results", "build", "site"}, 66, {"wanted reports, found none"});
    expect_usage_refused({"results"}, 2, {"add or build"});
    expect_usage_refused({"results", "ad", "x"}, 2, {"'ad'", "add"});
    expect_usage_refused({"results", "build"}, 2, {"wanted SITE"});
    add_report_to_results_site(report_of_one_scene(), "site");
    write_input_file("site/reports/broken.json", "{");
    expect_usage_refused({"results", "build", "site"}, 65, {"broken.json"});
    EXPECT_FALSE(std::filesystem::exists(folder / "site/index.html"));
}

} // namespace
