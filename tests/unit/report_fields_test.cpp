// Tests that a report stores every figure under the figure's own name. The test writes a row in
// which no two figures are equal, reads each figure by its name and compares.
#include "report/writer.hpp"

#include "measure/causes.hpp"
#include "measure/light_edges.hpp"
#include "measure/lookup.hpp"
#include "measure/statistics.hpp"
#include "report/tables.hpp"
#include "report_sample.hpp"
#include "support/csv.hpp"

#include <gmock/gmock.h>
#include <memory>
#include <nlohmann/json.hpp>

#include <map>
#include <set>
#include <sstream>

namespace {

using namespace catoptric::report;
using catoptric::measure::Difference;
using catoptric::measure::LightEdgeErrors;
using catoptric::measure::LookupSummary;
using catoptric::measure::Mean;
using catoptric::measure::SampleSummary;
using nlohmann::json;

/// A figure of the test row, with its JSON pointer and its CSV column. The column "name#2" means
/// the third number of the list in column "name".
struct ReportedFigureField {
    std::string pointer, column;
    double value;
};

/// Builds a row in which every figure has a different value.
class DistinctRowFiller {
public:
    Row row;
    std::vector<ReportedFigureField> fields;

    DistinctRowFiller() {
        row.technique = "parallax";
        row.label = "parallax:face=64";
        row.image = "parallax-face64";
        fill_next_value(row.scene_passes, "/scene_passes", "scene_passes");
        fill_next_value(row.scene_draws, "/scene_draws", "scene_draws");
        fill_next_value(row.gpu_ms, "/gpu_ms", "gpu_ms");
        fill_next_value(row.cpu_record_ms, "/cpu_record_ms", "cpu_record_ms");
        fill_next_value(row.wall_ms, "/wall_ms", "wall_ms");
        fill_next_value(row.host_ms, "/host_ms", "host_ms");
        fill_next_value(row.frame_ms, "/frame_ms", "frame_ms");
        fill_next_value(row.wait_ms, "/wait_ms", "wait_ms");
        fill_next_value(row.cpu_ms, "/cpu_ms", "cpu_ms");
        fill_next_value(row.waited, "/waited", "waited");
        fill_next_value(row.host_parts.update, "/host_parts/update", "host_parts_update");
        fill_next_value(row.host_parts.hierarchy, "/host_parts/hierarchy", "host_parts_hierarchy");
        fill_next_value(row.host_parts.compile, "/host_parts/compile", "host_parts_compile");
        fill_next_value(row.host_parts.record, "/host_parts/record", "host_parts_record");
        fill_next_value(row.closure, "/closure", "closure");
        row.passes.resize(2);
        for (std::size_t i = 0; i < 2; ++i) {
            row.passes[i].name = i == 0 ? "shadow" : "view";
            fill_next_value(row.passes[i].gpu_ms, "/passes/" + std::to_string(i) + "/gpu_ms",
                            "passes_" + row.passes[i].name + "_gpu_ms");
        }
        fill_next_value(row.error, "/error", "mirrors");
        fill_next_value(row.error_first_order, "/error_first_order", "first_order");
        fill_next_value(row.error_mirror_in_mirror, "/error_mirror_in_mirror", "mirror_in_mirror");
        fill_next_value(row.error_non_mirror, "/error_non_mirror", "non_mirror");
        fill_next_value(row.error_all, "/error_all", "all");
        fill_next_value(row.error_dielectrics, "/error_dielectrics", "dielectrics");
        fill_next_value(row.error_rough, "/error_rough", "rough");
        row.error_per_mirror.resize(2);
        for (std::size_t i = 0; i < 2; ++i)
            fill_next_value(row.error_per_mirror[i], "/error_per_mirror/" + std::to_string(i),
                            "mirror_" + std::to_string(i + 1));
        fill_next_value(row.memory_bytes, "/memory_bytes", "memory_bytes");
        row.rays.emplace();
        fill_next_value(row.rays->primary, "/rays/primary", "rays_primary");
        fill_next_value(row.rays->mirror, "/rays/mirror", "rays_mirror");
        fill_next_value(row.rays->shadow, "/rays/shadow", "rays_shadow");
        fill_next_value(row.saturated_texels.emplace(), "/saturated_texels", "saturated_texels");
        fill_next_value(row.traced_fraction.emplace(), "/traced_fraction", "traced_fraction");
        fill_next_value(row.mean, "/mean", "mean");
        fill_next_value(row.mean_clamped, "/mean_clamped", "mean_clamped");
        row.lookup = std::make_shared<LookupSummary>();
        set_distinct_lookup_errors(*row.lookup);
        row.light_edges = std::make_shared<LightEdgeErrors>();
        fill_light_edges(*row.light_edges);
        row.causes = std::make_shared<catoptric::measure::Causes>();
        fill_error_causes(*row.causes);
        row.causes->largest.resize(row.display.pixels.size());
        row.auto_face.emplace().needs.resize(2);
        fill_next_value(row.auto_face->edge, "/auto_face/edge", "auto_face_edge");
        fill_next_value(row.auto_face->needs[0], "/auto_face/needs/0", "auto_face_needs#0");
        fill_next_value(row.auto_face->needs[1], "/auto_face/needs/1", "auto_face_needs#1");
    }

private:
    /// Sets a figure to the next value. Integers count up. Other figures are multiples of 1/1024:
    /// exact in binary, and distinct when printed with four decimals.
    template <typename Number>
    void fill_next_value(Number& figure, const std::string& pointer, const std::string& column) {
        ++count_;
        figure = static_cast<Number>(std::is_integral_v<Number> ? count_ : count_ / 1024.0);
        fields.push_back({pointer, column, static_cast<double>(figure)});
    }
    static std::string column_part_name(const std::string& column, const char* name) {
        return column + "_" + name;
    }
    void fill_next_value(SampleSummary& times, const std::string& pointer,
                         const std::string& column) {
        fill_next_value(times.median, pointer + "/median", column_part_name(column, "median"));
        fill_next_value(times.p05, pointer + "/p05", column_part_name(column, "p05"));
        fill_next_value(times.p95, pointer + "/p95", column_part_name(column, "p95"));
        fill_next_value(times.mad, pointer + "/mad", column_part_name(column, "mad"));
        fill_next_value(times.n, pointer + "/n", column_part_name(column, "n"));
        fill_next_value(times.ci95.low, pointer + "/ci95/0", column_part_name(column, "ci95_low"));
        fill_next_value(times.ci95.high, pointer + "/ci95/1",
                        column_part_name(column, "ci95_high"));
        times.rounds.resize(2);
        fill_next_value(times.rounds[0], pointer + "/rounds/0",
                        column_part_name(column, "rounds#0"));
        fill_next_value(times.rounds[1], pointer + "/rounds/1",
                        column_part_name(column, "rounds#1"));
        times.samples.resize(2);
        fill_next_value(times.samples[0], pointer + "/samples/0",
                        column_part_name(column, "samples#0"));
        fill_next_value(times.samples[1], pointer + "/samples/1",
                        column_part_name(column, "samples#1"));
    }
    void fill_next_value(Difference& error, const std::string& pointer, const std::string& column) {
        fill_next_value(error.pixels, pointer + "/pixels", column_part_name(column, "pixels"));
        fill_next_value(error.nonfinite, pointer + "/nonfinite",
                        column_part_name(column, "nonfinite"));
        fill_next_value(error.rmse, pointer + "/rmse", column_part_name(column, "rmse"));
        fill_next_value(error.mae, pointer + "/mae", column_part_name(column, "mae"));
        fill_next_value(error.flip, pointer + "/flip", column_part_name(column, "flip"));
        fill_next_value(error.psnr.emplace(), pointer + "/psnr", column_part_name(column, "psnr"));
        fill_next_value(error.p99, pointer + "/p99", column_part_name(column, "p99"));
        fill_next_value(error.max, pointer + "/max", column_part_name(column, "max"));
        fill_next_value(error.off, pointer + "/off", column_part_name(column, "off"));
        fill_next_value(error.longest_line, pointer + "/longest_line",
                        column_part_name(column, "longest_line"));
        fill_next_value(error.max_x, pointer + "/max_at/0", column_part_name(column, "max_at_x"));
        fill_next_value(error.max_y, pointer + "/max_at/1", column_part_name(column, "max_at_y"));
    }
    void fill_next_value(Mean& mean, const std::string& pointer, const std::string& column) {
        fill_next_value(mean.rgb.x, pointer + "/0", column_part_name(column, "r"));
        fill_next_value(mean.rgb.y, pointer + "/1", column_part_name(column, "g"));
        fill_next_value(mean.rgb.z, pointer + "/2", column_part_name(column, "b"));
    }
    void set_distinct_lookup_errors(LookupSummary& lookup) {
        fill_next_value(lookup.pixels, "/lookup/pixels", "lookup_pixels");
        fill_next_value(lookup.mean_degrees, "/lookup/mean_degrees", "lookup_mean_degrees");
        fill_next_value(lookup.p95_degrees, "/lookup/p95_degrees", "lookup_p95_degrees");
        fill_next_value(lookup.p99_degrees, "/lookup/p99_degrees", "lookup_p99_degrees");
        fill_next_value(lookup.wrong_object, "/lookup/wrong_object", "lookup_wrong_object");
        fill_next_value(lookup.unknown, "/lookup/unknown", "lookup_unknown");
        fill_next_value(lookup.miss, "/lookup/miss", "lookup_miss");
        fill_next_value(lookup.p95_residual, "/lookup/p95_residual", "lookup_p95_residual");
    }
    void fill_light_edges(LightEdgeErrors& edges) {
        fill_next_value(edges.rmse, "/light_edges/rmse", "light_edges_rmse");
        fill_next_value(edges.rest_rmse, "/light_edges/rest_rmse", "light_edges_rest_rmse");
        fill_next_value(edges.share, "/light_edges/share", "light_edges_share");
        fill_next_value(edges.pixels, "/light_edges/pixels", "light_edges_pixels");
    }
    void fill_error_causes(Causes& causes) {
        fill_next_value(causes.squared_error, "/causes/squared_error", "causes_squared_error");
        fill_next_value(causes.rest_rmse, "/causes/rest_rmse", "causes_rest_rmse");
        // This share is also a figure of the row itself, in `light_edges`.
        fields.push_back(
            {"/causes/at_light_edges", "causes_at_light_edges", row.light_edges->share});
        fill_next_value(causes.squared_error_per_mirror.emplace_back(),
                        "/causes/squared_error_per_mirror/0", "causes_squared_error_per_mirror#0");
        causes.list.resize(2);
        for (std::size_t i = 0; i < 2; ++i) {
            CauseShare& cause = causes.list[i];
            const std::string at = "/causes/list/" + std::to_string(i);
            cause.name = i == 0 ? "one" : "other";
            const std::string column = "causes_list_" + cause.name;
            fill_next_value(cause.share, at + "/share", column + "_share");
            fill_next_value(cause.share_first_order, at + "/share_first_order",
                            column + "_share_first_order");
            fill_next_value(cause.share_mirror_in_mirror, at + "/share_mirror_in_mirror",
                            column + "_share_mirror_in_mirror");
            fill_next_value(cause.share_per_mirror.emplace_back(), at + "/share_per_mirror/0",
                            column + "_share_per_mirror#0");
            fill_next_value(cause.squared_error, at + "/squared_error", column + "_squared_error");
            fill_next_value(cause.alone, at + "/alone", column + "_alone");
            fill_next_value(cause.alone_per_mirror.emplace_back(), at + "/alone_per_mirror/0",
                            column + "_alone_per_mirror#0");
        }
    }

    int count_ = 0;
};

Comparison make_comparison_of_distinct_figures(const DistinctRowFiller& filler) {
    Comparison made = sample::make_comparison({filler.row});
    made.scene.camera = {"eye level", {1, 2, 3}, {4, 5, 6}, {0, 0, 1}, 37.5};
    made.time = 0.25, made.exposure = -1, made.device.threads = 2;
    return made;
}

/// Returns the CSV cells that identify the run of `make_comparison_of_distinct_figures`, by column.
std::map<std::string, std::string> list_identity_cells() {
    return {{"plan", "parallax:face=64"},
            {"scene", "cornell-mirrors"},
            {"scene_hash", "deadbeef"},
            {"scene_triangles", "16394"},
            {"scene_mirrors", "4"},
            {"camera", "eye level"},
            {"camera_eye_x", "1"},
            {"camera_eye_y", "2"},
            {"camera_eye_z", "3"},
            {"camera_target_x", "4"},
            {"camera_target_y", "5"},
            {"camera_target_z", "6"},
            {"camera_up_x", "0"},
            {"camera_up_y", "0"},
            {"camera_up_z", "1"},
            {"camera_vertical_fov_degrees", "37.5"},
            {"time", "0.25"},
            {"width", "4"},
            {"height", "3"},
            {"ambient", "0.05"},
            {"exposure", "-1"},
            {"frames", "20"},
            {"warmup", "8"},
            {"rounds", "6"},
            {"load_start", "0.25"},
            {"load_end", "1.5"},
            {"timing", "isolated"},
            {"together", "0"},
            {"reference", "raytrace:depth=16"},
            {"device", "Card"},
            {"device_type", "discrete"},
            {"threads", "2"},
            {"driver", "Driver 1"},
            {"api", "Vulkan 1.3"},
            {"version", "0.1.0"},
            {"commit", "abc1234"},
            {"date", "2026-11-24T03:05:10Z"}};
}

TEST(ReportFields, JsonReportHoldsTheCamera) {
    const json document = json::parse(
        to_json(make_comparison_of_distinct_figures(DistinctRowFiller())));
    EXPECT_EQ(document["scene"]["camera"],
              json::parse(R"({"name": "eye level", "eye": [1, 2, 3], "target": [4, 5, 6],
                              "up": [0, 0, 1], "vertical_fov_degrees": 37.5,
                              "orthographic_height": null})"));
}

TEST(ReportFields, JsonReportHoldsRoundsAndLoad) {
    const json document = json::parse(
        to_json(make_comparison_of_distinct_figures(DistinctRowFiller())));
    EXPECT_EQ(document["rounds"], 6);
    EXPECT_EQ(document["load"], json::parse("[0.25, 1.5]"));
    EXPECT_EQ(document["rows"][0]["noisy"], false);
    Comparison made = sample::make_usual_comparison();
    made.load_start = std::nan("");
    made.rows[0].gpu_ms = catoptric::measure::summarise(std::vector<double>{1, 2});
    const json without = json::parse(to_json(made));
    EXPECT_TRUE(without["load"][0].is_null());
    EXPECT_TRUE(without["rows"][0]["gpu_ms"]["ci95"].is_null());
    EXPECT_EQ(without["rows"][0]["gpu_ms"]["rounds"], json::array());
}

TEST(ReportFields, SetupTimesAreInJsonAndAboveTheRows) {
    Comparison made = make_comparison_of_distinct_figures(DistinctRowFiller());
    made.setup = std::make_shared<SetupFacts>(SetupFacts{1.5, 2.25, 33.5, 444.5, 6, "used"});
    EXPECT_EQ(json::parse(to_json(made))["setup"],
              json::parse(R"({"load_ms": 1.5, "upload_ms": 2.25, "hierarchy_ms": 33.5,
                              "compile_ms": 444.5, "pipelines": 6, "pipeline_cache": "used"})"));
    const std::string line = "load 1.50 ms; upload 2.25 ms; hierarchy 33.5 ms; "
                             "6 pipelines 444 ms, with the cache on disk";
    for (const std::string& page : {to_markdown(made), to_html(made)}) {
        ASSERT_NE(page.find(line), page.npos) << page.substr(0, 4000);
        EXPECT_LT(page.find(line), page.find("Every row"));
        EXPECT_EQ(page.find(line), page.rfind(line)) << "told once";
    }
    made.setup = std::make_shared<SetupFacts>(SetupFacts{{}, 2.25, 0, 444.5, 6, "made"});
    EXPECT_TRUE(json::parse(to_json(made))["setup"]["load_ms"].is_null());
    EXPECT_EQ(describe_setup(*made.setup), "upload 2.25 ms; no hierarchy; 6 pipelines 444 ms, the "
                                           "cache on disk was empty");
    made.setup->pipeline_cache = "none";
    EXPECT_THAT(describe_setup(*made.setup), testing::EndsWith("444 ms, no cache on disk"));
}

/// Collects the JSON pointers of all numbers in a document.
void collect_numbers(const json& document, const std::string& at, std::vector<std::string>& found) {
    if (document.is_number()) found.push_back(at);
    if (document.is_object())
        for (const auto& [name, value] : document.items())
            collect_numbers(value, at + "/" + name, found);
    if (document.is_array())
        for (std::size_t i = 0; i < document.size(); ++i)
            collect_numbers(document[i], at + "/" + std::to_string(i), found);
}

TEST(ReportFields, JsonReportHoldsEachFigureUnderItsName) {
    const DistinctRowFiller filler;
    const json row = json::parse(to_json(make_comparison_of_distinct_figures(filler)))["rows"][0];
    std::vector<std::string> wanted{"/error_per_mirror/0/mirror", "/error_per_mirror/1/mirror"};
    for (const ReportedFigureField& field : filler.fields) {
        ASSERT_TRUE(row.contains(json::json_pointer(field.pointer))) << field.pointer;
        EXPECT_EQ(row.at(json::json_pointer(field.pointer)), field.value) << field.pointer;
        wanted.push_back(field.pointer);
    }
    std::vector<std::string> found;
    collect_numbers(row, "", found);
    EXPECT_THAT(found, testing::UnorderedElementsAreArray(wanted)) << "a figure nobody looks at";
}

/// Returns the number in a CSV column. "name#i" means entry i of the list in column "name".
double find_number_in_csv_column(const std::map<std::string, std::string>& line,
                                 const std::string& column) {
    const std::size_t hash = column.find('#');
    std::istringstream list(line.at(column.substr(0, hash)));
    double number = 0;
    for (int i = hash == column.npos ? 0 : std::stoi(column.substr(hash + 1)); i >= 0; --i)
        list >> number;
    EXPECT_FALSE(list.fail()) << column;
    return number;
}

/// Returns whether a test of this program has registered this metric.
bool is_test_registered_metric_name(const std::string& name) {
    return name.find("test_only") != name.npos || name.starts_with("(test)");
}

TEST(ReportFields, CsvReportHoldsEachFigureInItsColumn) {
    const DistinctRowFiller filler;
    const std::string csv = to_csv(make_comparison_of_distinct_figures(filler), CsvColumns::all);
    const std::vector<std::string> names = test::split_csv_fields(csv),
                                   cells = test::split_csv_fields(csv.substr(csv.find('\n') + 1));
    ASSERT_EQ(names.size(), cells.size());
    std::map<std::string, std::string> found;
    for (std::size_t i = 0; i < names.size(); ++i)
        EXPECT_TRUE(found.emplace(names[i], cells[i]).second) << names[i] << " is there twice";
    std::set<std::string> wanted;
    for (const ReportedFigureField& field : filler.fields) {
        wanted.insert(field.column.substr(0, field.column.find('#')));
        EXPECT_EQ(find_number_in_csv_column(found, field.column), field.value) << field.column;
    }
    for (const char* name :
         {"technique", "label", "settings", "model", "place_first", "place_last", "moves", "noisy",
          "failed", "image", "on_front", "is_reference", "incomplete"})
        wanted.insert(name);
    for (const auto& [name, field] : list_identity_cells()) {
        wanted.insert(name);
        EXPECT_EQ(found[name], field) << name;
    }
    std::erase_if(found, [](const auto& one) { return is_test_registered_metric_name(one.first); });
    std::set<std::string> there;
    for (const auto& [name, field] : found) there.insert(name);
    EXPECT_EQ(there, wanted);
    EXPECT_EQ(found["failed"], "1"); // the row failed, because it has pixels that are not finite
    EXPECT_EQ(found["on_front"], "0");
    EXPECT_EQ(found["moves"], "0");
    EXPECT_EQ(found["noisy"], "0");
}

/// Returns the cells of a table's row, by column name.
std::map<std::string, std::string> cells_of_table_row_by_column(const ReportTable& table,
                                                                std::size_t row) {
    std::map<std::string, std::string> cells;
    for (std::size_t i = 0; i < table.columns.size(); ++i)
        cells[table.columns[i].name] = table.rows.at(row).at(i);
    return cells;
}

std::string format_with_decimals(double value, int decimals) {
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return text;
}

TEST(ReportFields, ReportTablesHoldEachFigureInItsColumn) {
    DistinctRowFiller filler;
    filler.row.memory_bytes = 5 << 20;
    const Row& row = filler.row;
    const auto error = [](double value) { return format_with_decimals(value, 4); };
    const auto ms = [](double value) { return format_with_decimals(value, 4); };
    const auto degrees = [](double value) { return format_with_decimals(value, 2); };
    const auto percent = [](double share) { return format_with_decimals(100 * share, 2); };

    std::map<std::string, std::string> cells = cells_of_table_row_by_column(
        rows_table(make_comparison_of_distinct_figures(filler)), 0);
    const std::map<std::string, std::string> wanted{
        {"Row", row.label},
        {"R", std::to_string(row.scene_passes)},
        {"Draws", std::to_string(row.scene_draws)},
        {"ms", ms(row.gpu_ms.median)},
        {"95 %", ms(row.gpu_ms.ci95.low) + "–" + ms(row.gpu_ms.ci95.high)},
        {"Place", "1"},
        {"cpu ms", ms(row.cpu_ms.median)},
        {"cpu 95 %", ms(row.cpu_ms.ci95.low) + "–" + ms(row.cpu_ms.ci95.high)},
        {"wall ms", ms(row.wall_ms.median)},
        {"FLIP", error(row.error.flip)},
        {"off, %", percent(row.error.off)},
        {"MAE", error(row.error.mae)},
        {"rmse", error(row.error.rmse)},
        {"rmse, light edges", error(row.light_edges->rmse)},
        {"rmse, rest", error(row.light_edges->rest_rmse)},
        {"Longest line", format_with_decimals(row.error.longest_line, 0)},
        {"PSNR dB", format_with_decimals(*row.error.psnr, 1)},
        {"p99", error(row.error.p99)},
        {"FLIP, first order", error(row.error_first_order.flip)},
        {"FLIP, mirror in mirror", error(row.error_mirror_in_mirror.flip)},
        {"FLIP, not a mirror", error(row.error_non_mirror.flip)},
        {"FLIP, all", error(row.error_all.flip)},
        {"FLIP, smooth dielectrics", error(row.error_dielectrics.flip)},
        {"rmse, smooth dielectrics", error(row.error_dielectrics.rmse)},
        {"FLIP, rough surfaces", error(row.error_rough.flip)},
        {"rmse, rough surfaces", error(row.error_rough.rmse)},
        {"rmse, first order", error(row.error_first_order.rmse)},
        {"rmse, mirror in mirror", error(row.error_mirror_in_mirror.rmse)},
        {"rmse, not a mirror", error(row.error_non_mirror.rmse)},
        {"rmse, all", error(row.error_all.rmse)},
        {"MiB", "5.0"},
        {"Remark", "failed"}};
    for (const auto& [title, value] : {std::pair("record ms", row.cpu_record_ms.median),
                                       {"host ms", row.host_ms.median},
                                       {"frame ms", row.frame_ms.median},
                                       {"wait ms", row.wait_ms.median}}) {
        EXPECT_NEAR(std::stod(cells[title]), value, 1e-3) << title;
        cells.erase(title);
    }
    std::erase_if(cells, [](const auto& one) { return is_test_registered_metric_name(one.first); });
    EXPECT_EQ(cells, wanted);

    EXPECT_EQ(
        cells_of_table_row_by_column(mirror_table(make_comparison_of_distinct_figures(filler)), 0),
        (std::map<std::string, std::string>{{"Row", row.label},
                                            {"Mirror 1", error(row.error_per_mirror[0].flip)},
                                            {"Mirror 2", error(row.error_per_mirror[1].flip)}}));

    // A row that lacks the error of a mirror has as many cells as the others.
    Comparison two_rows = make_comparison_of_distinct_figures(filler);
    two_rows.rows.push_back(two_rows.rows.front());
    two_rows.rows[1].error_per_mirror.pop_back();
    const ReportTable by_mirror = mirror_table(two_rows);
    ASSERT_EQ(by_mirror.rows.size(), 2u);
    EXPECT_EQ(by_mirror.rows[0].size(), by_mirror.columns.size());
    EXPECT_EQ(by_mirror.rows[1].size(), by_mirror.columns.size());

    const LookupSummary& lookup = *row.lookup;
    EXPECT_EQ(
        cells_of_table_row_by_column(lookup_table(make_comparison_of_distinct_figures(filler)), 0),
        (std::map<std::string, std::string>{
            {"Row", row.label},
            {"Pixels", std::to_string(lookup.pixels)},
            {"Mean, degrees", format_with_decimals(lookup.mean_degrees, 3)},
            {"95 %", degrees(lookup.p95_degrees)},
            {"99 %", degrees(lookup.p99_degrees)},
            {"Wrong object, %", percent(lookup.wrong_object)},
            {"Unknown, %", percent(lookup.unknown)},
            {"Miss, %", percent(lookup.miss)},
            {"Traced, %", percent(*row.traced_fraction)}}));
}

/// The errors by which rows are ranked come first, in the same order in tables and in JSON.
TEST(ReportFields, ErrorsThatRankRowsComeFirst) {
    const Comparison made = make_comparison_of_distinct_figures(DistinctRowFiller());
    std::vector<std::string> titles;
    for (const TableColumn& column : rows_table(made).columns) titles.push_back(column.name);
    const auto first = std::ranges::find(titles, "FLIP");
    ASSERT_GE(titles.end() - first, 7);
    EXPECT_THAT(std::vector(first, first + 7),
                testing::ElementsAre("FLIP", "off, %", "MAE", "rmse", "rmse, light edges",
                                     "rmse, rest", "Longest line"));
    std::vector<std::string> names;
    const auto document = nlohmann::ordered_json::parse(to_json(made));
    for (const auto& [name, value] : document["rows"][0]["error"].items()) names.push_back(name);
    ASSERT_GE(names.size(), 7u);
    names.resize(7);
    EXPECT_THAT(names, testing::ElementsAre("mask", "pixels", "flip", "off", "mae", "rmse",
                                            "longest_line"));
}

/// JSON names the technique of each mirror for every row. The table of plans has only rows that are
/// plans.
TEST(ReportFields, ReportNamesTheTechniqueOfEachMirrorOfAPlan) {
    using namespace catoptric::report::sample;
    Row one = make_row("reuse", 5, .1, .2), plan = make_row("1=reuse 2=secant:face=64", 7, .1, .1);
    plan.technique = "plan";
    one.plan = {
        {1, "left", "reuse", {make_number_setting("face", 256)}, "one technique was asked for"}};
    plan.plan = {{1, "left", "reuse", {make_number_setting("face", 256)}, "rule '1'"},
                 {2,
                  "right",
                  "secant",
                  {make_number_setting("face", 64, true), make_choice_setting("colour", "half")},
                  "rule '2'"}};
    const Comparison both = make_comparison({one, plan});
    const ReportTable table = plan_table(both);
    ASSERT_EQ(table.rows.size(), 2u);
    EXPECT_EQ(table.rows[1],
              (std::vector<std::string>{plan.label, "2", "right", "secant:face=64", "rule '2'"}));
    EXPECT_TRUE(plan_table(make_comparison({one})).rows.empty());
    const auto rows = json::parse(to_json(both))["rows"];
    EXPECT_EQ(rows[0]["plan"][0]["why"], "one technique was asked for");
    EXPECT_EQ(rows[1]["plan"][1],
              json::parse(R"({"mirror": 2, "name": "right", "technique": "secant",
                                        "settings": {"face": 64, "colour": "half"},
                                        "why": "rule '2'"})"));
}

} // namespace
