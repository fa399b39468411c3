// Tests of `catoptric sweep`: results equal those of `compare`, whether one process or several
// processes that are killed run the pieces. All other results are refused.
#include "cli/program.hpp"
#include "support/csv.hpp"

#include <fmt/format.h>

#include <map>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

using nlohmann::json;

class Sweep : public CommandLineTest {
protected:
    static json make_small_sweep() {
        return {{"scenes", {"cornell-mirrors"}},
                {"techniques", {"naive:bounces=0", "parallax:face=16,shadow=none"}},
                {"options", {{"size", "32x32"}, {"frames", 2}, {"warmup", 1}}},
                {"views", {{"count", 6}, {"seed", 3}}},
                {"timing", {{"repeats", 0}}}};
    }
    test::ProcessResult plan_sweep(const json& sweep, const std::string& folder_name) const {
        write_input_file("sweep.json", sweep.dump(1));
        return run_cli({"sweep", "plan", "sweep.json", "-o", folder_name});
    }
    void expect_success(const Words& words) const {
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
    }
    void plan_run_and_merge(const json& sweep, const std::string& folder_name,
                            const std::string& merged_name) const {
        const test::ProcessResult planned = plan_sweep(sweep, folder_name);
        ASSERT_EQ(planned.exit_code, 0) << planned.err;
        expect_success({"sweep", "run", folder_name, "--quiet"});
        expect_success({"sweep", "merge", folder_name, "-o", merged_name, "--quiet"});
    }
    json read_output_json(const std::string& name) const {
        return json::parse(read_output_file(name));
    }
    /// Returns the ids of all pieces in the sweep's plan.json.
    std::vector<std::string> list_piece_ids(const std::string& folder_name) const {
        std::vector<std::string> ids;
        const json plan = read_output_json(folder_name + "/plan.json");
        for (const json& piece : plan["pieces"]) ids.push_back(piece["id"]);
        return ids;
    }
    /// Expects that `sweep plan` refuses the sweep, with this exit code and a message that contains
    /// `words`.
    void expect_plan_refused(const json& sweep, int exit_code, const Words& parts) const {
        expect_exit_code(plan_sweep(sweep, "refused"), exit_code, parts);
        EXPECT_FALSE(std::filesystem::exists(folder / "refused"));
    }
};

TEST_F(Sweep, ErrorsEqualThoseOfCompareOverTheSameViews) {
    json sweep = make_small_sweep();
    sweep["scenes"] = {"cornell-mirrors", "room"};
    plan_run_and_merge(sweep, "sweep", "merged");
    const json merged = read_output_json("merged/merged.json");
    ASSERT_EQ(merged["groups"].size(), 2u);
    for (const json& group : merged["groups"]) {
        const test::ProcessResult ended = run_cli(
            {"compare", group["scene"], "-o", "out", "--size", "32x32", "--frames", "2", "--warmup",
             "1", "--views", "6", "--seed", "3", "--json", "--techniques", "naive:bounces=0",
             "parallax:face=16,shadow=none"});
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
        const json compared = json::parse(ended.out);
        EXPECT_EQ(group["views"], 6);
        for (std::size_t row = 0; row < 2; ++row)
            for (const char* metric : {"flip", "rmse", "mae", "off", "p99"}) {
                const json& found = group["rows"][row]["error"][metric];
                const json& wanted = compared["rows"][row]["views"]["error"][metric];
                EXPECT_EQ(found["median"], wanted["median"]) << metric;
                EXPECT_EQ(found["ci95"], wanted["ci95"]) << metric;
                double sum = 0, largest = 0;
                for (const json& value : wanted["values"]) {
                    sum += value.get<double>();
                    largest = std::max(largest, value.get<double>());
                }
                EXPECT_NEAR(found["mean"].get<double>(), sum / 6, 1e-12) << metric;
                EXPECT_EQ(found["largest"].get<double>(), largest) << metric;
            }
    }
    const std::string table = read_output_file("merged/errors.csv");
    EXPECT_EQ(std::ranges::count(table, '\n'), 1 + 2 * 6 * 2);
    EXPECT_THAT(table, testing::HasSubstr("scene,view,seed,time,label,"));
    // The summary has a line for each row, with the errors of merged.json.
    std::istringstream summary(read_output_file("merged/summary.csv"));
    std::string line;
    std::getline(summary, line);
    const std::vector<std::string> header = test::split_csv_fields(line);
    for (const json& group : merged["groups"])
        for (const json& row : group["rows"]) {
            ASSERT_TRUE(std::getline(summary, line)) << row["label"];
            const std::vector<std::string> cells = test::split_csv_fields(line);
            ASSERT_EQ(cells.size(), header.size()) << line;
            std::map<std::string, std::string> found;
            for (std::size_t i = 0; i < cells.size(); ++i) found[header[i]] = cells[i];
            EXPECT_EQ(found["scene"], group["scene"]);
            EXPECT_EQ(found["label"], row["label"]);
            EXPECT_EQ(found["views"], "6");
            for (const std::string metric : {"flip", "rmse", "mae"})
                for (const std::string part : {"mean", "median", "largest"})
                    EXPECT_NEAR(std::stod(found[metric + "_" + part]), row["error"][metric][part],
                                1e-6)
                        << metric << ' ' << part;
        }
    EXPECT_FALSE(std::getline(summary, line));
}

// As in `compare`, the seed of drawn views is also the seed of random rays.
TEST_F(Sweep, ErrorsOfRowsWithNoiseEqualThoseOfCompare) {
    json sweep = make_small_sweep();
    const std::string mirror = "ball*=.9,roughness=.3", row = "raytrace:rays=2,first=raster",
                      reference = "raytrace:depth=4,rays=4";
    sweep["techniques"] = {row};
    sweep["options"]["mirror"] = mirror, sweep["options"]["reference"] = reference;
    plan_run_and_merge(sweep, "sweep", "merged");
    const test::ProcessResult ended = run_cli({"compare",
                                               "-o",
                                               "out",
                                               "--size",
                                               "32x32",
                                               "--frames",
                                               "2",
                                               "--warmup",
                                               "1",
                                               "--views",
                                               "6",
                                               "--seed",
                                               "3",
                                               "--reference-seconds",
                                               "0",
                                               "--mirror",
                                               mirror,
                                               "--reference",
                                               reference,
                                               "--json",
                                               "--techniques",
                                               row});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json compared = json::parse(ended.out), merged = read_output_json("merged/merged.json");
    EXPECT_EQ(merged["groups"][0]["rows"][0]["error"]["flip"]["median"],
              compared["rows"][0]["views"]["error"]["flip"]["median"]);
    EXPECT_EQ(merged["groups"][0]["rows"][0]["error"]["mae"]["median"],
              compared["rows"][0]["views"]["error"]["mae"]["median"]);
}

// A process keeps settled captures for the next piece of the same instant. This must not change the
// errors of any row, whatever pieces the process ran before.
TEST_F(Sweep, ErrorsDoNotDependOnThePiecesBefore) {
    json sweep = make_small_sweep();
    sweep["techniques"] = {"reuse:face=16", "parallax:face=16,rough=rays,rays=2", "secant:face=16",
                           "raytrace:rays=2,first=raster"};
    sweep["options"]["mirror"] = "ball*=.9,roughness=.2";
    sweep["options"]["reference"] = "raytrace:depth=4,rays=2";
    sweep["views"]["cameras-per-instant"] = 3;
    plan_run_and_merge(sweep, "together", "merged-together");
    ASSERT_EQ(plan_sweep(sweep, "alone").exit_code, 0);
    std::vector<std::string> ids = list_piece_ids("alone");
    ASSERT_EQ(ids.size(), 6u);
    for (const std::string& id : ids)
        expect_success({"sweep", "run", "alone", "--quiet", "--piece", id});
    expect_success({"sweep", "merge", "alone", "-o", "merged-alone", "--quiet"});
    EXPECT_EQ(read_output_file("merged-together/errors.csv"),
              read_output_file("merged-alone/errors.csv"));
}

// The id of a piece can be computed by any program, from its content alone.
TEST_F(Sweep, PieceIdsAreTheSha256OfTheirContent) {
    ASSERT_EQ(plan_sweep(make_small_sweep(), "sweep").exit_code, 0);
    const json pieces = read_output_json("sweep/plan.json")["pieces"];
    ASSERT_EQ(pieces.size(), 6u);
    for (const std::size_t index : {0u, 5u}) {
        write_input_file("piece.json", pieces[index]["piece"].dump());
        const test::ProcessResult sum = test::run_process(
            {.command = {"/usr/bin/sha256sum", (folder / "piece.json").string()}});
        EXPECT_EQ(sum.out.substr(0, 64), pieces[index]["id"].get<std::string>());
    }
}

TEST_F(Sweep, AxesMultiplyAndReachThePictures) {
    json sweep = make_small_sweep();
    sweep["techniques"] = {"parallax:shadow=none"};
    sweep["knobs"] = {{"face", {16, 64}}};
    sweep["axes"] = {{"mirror", {"ball*=.9", json::array({"ball*=.9,roughness=.3"})}},
                     {"size", {"24x24", "32x32"}}};
    sweep["options"].erase("size");
    sweep["options"]["reference"] = "raytrace:depth=4,rays=16";
    sweep.erase("views");
    plan_run_and_merge(sweep, "sweep", "merged");
    const json groups = read_output_json("merged/merged.json")["groups"];
    ASSERT_EQ(groups.size(), 4u);
    std::set<double> errors;
    for (const json& group : groups) {
        EXPECT_EQ(group["views"], 1);
        ASSERT_EQ(group["rows"].size(), 2u);
        for (const json& row : group["rows"]) {
            EXPECT_THAT(row["label"].get<std::string>(), testing::HasSubstr("face="));
            errors.insert(row["error"]["rmse"]["mean"].get<double>());
        }
    }
    EXPECT_EQ(errors.size(), 8u) << "each value of each axis changes the error";
    EXPECT_THAT(read_output_file("merged/summary.csv"),
                testing::StartsWith("scene,option_mirror,option_size,"));
}

/// Workers that are killed again and again must write the same results as one process that is never
/// killed. Each kill may only cost the piece in work.
TEST_F(Sweep, KilledWorkersLoseAtMostThePieceInWork) {
    json sweep = make_small_sweep();
    sweep["views"]["count"] = 12;
    plan_run_and_merge(sweep, "whole", "merged-whole");
    ASSERT_EQ(plan_sweep(sweep, "shared").exit_code, 0);
    constexpr int kKillsOfEachWorker = 3;
    std::string begun[2];
    const auto work = [&](int worker) {
        for (int kill = 0; kill < kKillsOfEachWorker; ++kill) {
            test::ProcessStartOptions start = make_process_start({"sweep", "run", "shared", "-v"});
            start.signal = SIGKILL, start.signal_at = "begun: ";
            start.signal_after = std::chrono::milliseconds(40 + 130 * kill + 70 * worker);
            begun[worker] += test::run_process(start).err;
        }
        const test::ProcessResult ended = run_cli({"sweep", "run", "shared", "-v"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        begun[worker] += ended.err;
    };
    std::thread other(work, 1);
    work(0);
    other.join();
    // The last process to be killed may have left pieces to other processes, so one more run
    // finishes the sweep.
    expect_success({"sweep", "run", "shared", "--quiet"});
    std::map<std::string, int> starts;
    for (const std::string& text : begun) {
        std::istringstream lines(text);
        for (std::string line; std::getline(lines, line);)
            if (const std::size_t at = line.find("begun: "); at != std::string::npos)
                ++starts[line.substr(at + 7)];
    }
    std::size_t started = 0;
    for (const auto& [id, times] : starts) started += static_cast<std::size_t>(times);
    EXPECT_EQ(starts.size(), 12u);
    EXPECT_LE(started, 12u + 2 * kKillsOfEachWorker);
    expect_success({"sweep", "check", "shared"});
    expect_success({"sweep", "merge", "shared", "-o", "merged-shared", "--quiet"});
    for (const char* name : {"merged.json", "errors.csv", "summary.csv"})
        EXPECT_EQ(read_output_file(std::string("merged-shared/") + name),
                  read_output_file(std::string("merged-whole/") + name))
            << name;
}

TEST_F(Sweep, CheckNamesMissingBrokenAndUnknownResults) {
    ASSERT_EQ(plan_sweep(make_small_sweep(), "sweep").exit_code, 0);
    const std::vector<std::string> ids = list_piece_ids("sweep");
    expect_success({"sweep", "run", "sweep", "--quiet", "--piece", ids[0], "--piece", ids[1],
                    "--piece", ids[2]});
    const auto result_file = [](const std::string& id) { return "sweep/results/" + id + ".json"; };
    write_input_file(result_file(ids[1]), read_output_file(result_file(ids[0])));
    write_input_file(result_file(ids[2]), "{\"rows\": [");
    write_input_file("sweep/results/mine.json", "{}");
    const test::ProcessResult ended = run_cli({"sweep", "check", "sweep", "--json"});
    EXPECT_EQ(ended.exit_code, 1) << ended.err;
    const json state = json::parse(ended.out);
    EXPECT_EQ(state["pieces"], 6);
    EXPECT_EQ(state["finished"], 1);
    EXPECT_EQ(state["missing"].get<std::vector<std::string>>(),
              std::vector<std::string>(ids.begin() + 3, ids.end()));
    ASSERT_EQ(state["broken"].size(), 2u);
    EXPECT_EQ(state["broken"][0]["id"], ids[1]);
    EXPECT_EQ(state["broken"][1]["id"], ids[2]);
    EXPECT_EQ(state["unknown"], json::array({"mine.json"}));
    EXPECT_THAT(run_cli({"sweep", "check", "sweep"}).out,
                testing::AllOf(testing::HasSubstr("1 of 6 pieces have a result"),
                               testing::HasSubstr("missing: " + ids[3]),
                               testing::HasSubstr("found another document")));
    expect_usage_refused({"sweep", "merge", "sweep", "-o", "merged"}, 65,
                         {"wanted the results of 6 pieces, found 1", "sweep check"});
    EXPECT_FALSE(std::filesystem::exists(folder / "merged"));
    // A broken result is never replaced without a message, because a person may want to inspect the
    // file.
    expect_usage_refused({"sweep", "run", "sweep", "--piece", ids[1]}, 65, {"another document"});
    std::filesystem::remove(folder / result_file(ids[1]));
    expect_success({"sweep", "run", "sweep", "--quiet", "--piece", ids[1]});
}

/// A result file with a wrong member is reported by its file name, and is never merged.
TEST_F(Sweep, ResultsWithWrongMembersAreBroken) {
    json sweep = make_small_sweep();
    sweep.erase("views");
    sweep["timing"]["repeats"] = 1, sweep["options"]["frames"] = 6;
    plan_run_and_merge(sweep, "sweep", "merged");
    const std::vector<std::string> ids = list_piece_ids("sweep");
    ASSERT_EQ(ids.size(), 2u);
    const auto refuse = [&](std::size_t piece, const std::function<void(json&)>& change,
                            const std::string& part) {
        const std::string file = "sweep/results/" + ids[piece] + ".json",
                          good = read_output_file(file);
        json result = json::parse(good);
        change(result);
        write_input_file(file, result.dump());
        expect_usage_refused({"sweep", "merge", "sweep", "-o", "x"}, 65, {"2 pieces, found 1"});
        EXPECT_THAT(run_cli({"sweep", "check", "sweep"}).out,
                    testing::AllOf(testing::HasSubstr(ids[piece] + ".json"),
                                   testing::HasSubstr(part), testing::HasSubstr("delete")));
        write_input_file(file, good);
    };
    refuse(
        0, [](json& r) { r = 3; }, "wanted the result of piece");
    refuse(
        0, [](json& r) { r["schema"] = "x"; }, "sweep-result/1");
    refuse(
        0, [](json& r) { r["rows"][0] = 3; }, "rows[0]: the label");
    refuse(
        0, [](json& r) { std::swap(r["rows"][0], r["rows"][1]); }, "rows[0]: the label");
    refuse(
        0, [](json& r) { r["rows"][1].erase("error"); }, "rows[1]: errors");
    refuse(
        0, [](json& r) { r["rows"][1]["error"]["flip"] = "none"; }, "a number or null as flip");
    refuse(
        0, [](json& r) { r["rows"][1]["error"].erase("mae"); }, "a number or null as mae");
    refuse(
        0, [](json& r) { r["identity"]["device"] = 5; }, "an identity");
    refuse(
        1, [](json& r) { r["machine"] = 5; }, "a machine");
    refuse(
        1, [](json& r) { r.erase("date"); }, "a date");
    refuse(
        1, [](json& r) { r["rows"][0]["rounds"] = nullptr; }, "rows[0]: times");
    refuse(
        1, [](json& r) { r["rows"][0]["noisy"] = 1; }, "rows[0]: times");
    expect_success({"sweep", "merge", "sweep", "-o", "again", "--quiet"});
    EXPECT_EQ(read_output_file("again/merged.json"), read_output_file("merged/merged.json"));
    // Plans with an incomplete piece, or without pieces, are refused.
    const json plan = read_output_json("sweep/plan.json");
    json empty = plan;
    empty["pieces"] = json::array(), empty["common"] = json::array();
    write_input_file("sweep/plan.json", empty.dump());
    expect_usage_refused({"sweep", "merge", "sweep", "-o", "x"}, 65,
                         {"sweep/plan.json.pieces: wanted a list that is not empty, found a list"});
    for (const char* member : {"kind", "scene", "scene_hash", "options", "techniques", "view"}) {
        json changed = plan;
        changed["pieces"][0]["piece"].erase(member);
        write_input_file("piece.json", changed["pieces"][0]["piece"].dump());
        changed["pieces"][0]["id"] =
            test::run_process({.command = {"/usr/bin/sha256sum", (folder / "piece.json").string()}})
                .out.substr(0, 64);
        write_input_file("sweep/plan.json", changed.dump());
        expect_usage_refused({"sweep", "check", "sweep"}, 65, {"plan.json", member});
    }
}

TEST_F(Sweep, FinishedPieceEndsAtOnceWithoutADevice) {
    ASSERT_EQ(plan_sweep(make_small_sweep(), "sweep").exit_code, 0);
    const std::vector<std::string> ids = list_piece_ids("sweep");
    expect_success({"sweep", "run", "sweep", "--quiet", "--piece", ids[0]});
    const auto run_without_driver = [&](const std::string& id) {
        test::ProcessStartOptions start = make_process_start(
            {"sweep", "run", "sweep", "--piece", id});
        start.environment = {{"VK_DRIVER_FILES", "/nonexistent"},
                             {"VK_ICD_FILENAMES", "/nonexistent"}};
        return test::run_process(start);
    };
    EXPECT_EQ(run_without_driver(ids[0]).exit_code, 0);
    EXPECT_EQ(run_without_driver(ids[1]).exit_code, 69);
}

// A driver with another vector width rounds differently, so results of two vector widths are merged
// only on request.
TEST_F(Sweep, ResultsOfTwoKindsOfMachinesAreMergedOnlyOnRequest) {
    const json sweep = make_small_sweep();
    ASSERT_EQ(plan_sweep(sweep, "sweep").exit_code, 0);
    const std::vector<std::string> ids = list_piece_ids("sweep");
    for (const auto& [width, begin] : std::map<std::string, std::size_t>{{"128", 0}, {"256", 3}}) {
        test::ProcessStartOptions start = make_process_start({"sweep", "run", "sweep", "--quiet"});
        for (std::size_t i = begin; i < begin + 3; ++i) {
            start.command.emplace_back("--piece");
            start.command.push_back(ids[i]);
        }
        // The driver's shader cache does not distinguish vector widths, so each width gets a cache
        // of its own.
        start.environment = {{"LP_NATIVE_VECTOR_WIDTH", width},
                             {"MESA_SHADER_CACHE_DIR", (folder / ("cache" + width)).string()}};
        const test::ProcessResult ended = test::run_process(start);
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
    }
    expect_usage_refused({"sweep", "merge", "sweep", "-o", "merged"}, 65,
                         {"2 identities", "lanes: 4, 8", "--across-identities"});
    EXPECT_FALSE(std::filesystem::exists(folder / "merged"));
    const test::ProcessResult ended = run_cli(
        {"sweep", "merge", "sweep", "-o", "merged", "--across-identities"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.err, testing::HasSubstr("differ by more than 1/255"));
    const json merged = read_output_json("merged/merged.json");
    EXPECT_EQ(merged["identities"].size(), 2u);
    const json& difference = merged["identity_difference"];
    EXPECT_EQ(difference["pixels"], 3 * 32 * 32) << "two rows and the reference";
    EXPECT_LE(difference["share"].get<double>(), .005);
    // The list of common pictures is written last. Common pictures without this list are ignored.
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "sweep/common"))
        if (entry.path().filename() == "pictures.json") {
            const std::string list = read_file_at_path(entry.path());
            std::filesystem::remove(entry.path());
            expect_usage_refused({"sweep", "merge", "sweep", "-o", "x", "--across-identities"}, 65,
                                 {"no common picture", "lanes: 4, 8"});
            std::ofstream(entry.path()) << list;
            break;
        }
    // A common picture that was changed after the run must be detected.
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "sweep/common"))
        if (entry.path().filename() == "0.png") {
            expect_success({"render", "room", "--size", "68x32", "-o", entry.path().string(),
                            "--quiet", "--technique", "raytrace"});
            break;
        }
    expect_success({"sweep", "merge", "sweep", "-o", "changed", "--across-identities"});
    EXPECT_GT(read_output_json("changed/merged.json")["identity_difference"]["share"].get<double>(),
              .1);
}

TEST_F(Sweep, TimesAreMergedByMachineAndLeaveOtherFilesAsTheyAre) {
    json sweep = make_small_sweep();
    sweep.erase("views");
    plan_run_and_merge(sweep, "pictures", "merged-pictures");
    sweep["timing"]["repeats"] = 2;
    sweep["options"]["frames"] = 6;
    plan_run_and_merge(sweep, "both", "merged-both");
    EXPECT_EQ(read_output_file("merged-both/summary.csv"),
              read_output_file("merged-pictures/summary.csv"));
    EXPECT_FALSE(std::filesystem::exists(folder / "merged-pictures/times.json"));
    const json times = read_output_json("merged-both/times.json")["times"];
    ASSERT_EQ(times.size(), 2u);
    for (const json& row : times) {
        ASSERT_EQ(row["rounds"].size(), 12u) << "six rounds of two repeats";
        std::vector<double> rounds = row["rounds"];
        std::ranges::sort(rounds);
        EXPECT_DOUBLE_EQ(row["ms"].get<double>(), (rounds[5] + rounds[6]) / 2);
        EXPECT_GE(row["ci95"][0].get<double>(), rounds.front());
        EXPECT_LE(row["ci95"][1].get<double>(), rounds.back());
        EXPECT_GT(rounds.front(), 0);
    }
    EXPECT_THAT(read_output_file("merged-both/times.csv"),
                testing::HasSubstr("scene,label,machine,device,driver,commit,ms,"));
    EXPECT_EQ(read_output_json("merged-both/times.json")["over_machines"], json::array())
        << "one machine";
}

// Results of eight pieces on seven machines are written by hand. Machine 0 ran two pieces, and
// counts once, with the median of its pieces.
TEST_F(Sweep, TimesOverMachinesCountEachMachineOnce) {
    json sweep = make_small_sweep();
    sweep.erase("views");
    sweep["timing"]["repeats"] = 8, sweep["options"]["frames"] = 6;
    ASSERT_EQ(plan_sweep(sweep, "sweep").exit_code, 0);
    expect_success({"sweep", "run", "sweep", "--quiet", "--kind", "pictures"});
    const json pieces = read_output_json("sweep/plan.json")["pieces"];
    std::vector<std::string> timing_ids;
    for (const json& piece : pieces)
        if (piece["piece"]["kind"] == "timing") timing_ids.push_back(piece["id"]);
    ASSERT_EQ(timing_ids.size(), 8u);
    expect_success({"sweep", "run", "sweep", "--quiet", "--piece", timing_ids[0]});
    const auto result_file = [](const std::string& id) { return "sweep/results/" + id + ".json"; };
    const json first = read_output_json(result_file(timing_ids[0]));
    for (std::size_t i = 0; i < 8; ++i) {
        json result = first;
        for (const json& piece : pieces)
            if (piece["id"] == timing_ids[i]) result["piece"] = piece["piece"];
        result["machine"] = "machine" + std::to_string(i < 2 ? 0 : i - 1);
        // Machine 0: 10 and 30 ms, so 20. Machines 1 to 6: 1 to 6 ms. The second row takes i + 1
        // times as long as the first.
        const double ms = i < 2 ? 10 + 20.0 * double(i) : double(i) - 1;
        for (std::size_t row = 0; row < 2; ++row)
            result["rows"][row]["rounds"] = std::vector<double>(6, row ? ms * double(i + 1) : ms);
        write_input_file(result_file(timing_ids[i]), result.dump(1));
    }
    expect_success({"sweep", "merge", "sweep", "-o", "merged", "--quiet"});
    const json list = read_output_json("merged/times.json")["over_machines"];
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0]["label"], "naive:bounces=0");
    EXPECT_EQ(list[0]["ms"]["machines"], json({20.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0}));
    EXPECT_EQ(list[0]["ms"]["median"], 4.0);
    EXPECT_EQ(list[0]["ms"]["ci95"], json({1.0, 20.0})) << "of seven values";
    EXPECT_EQ(list[0]["ratio"]["machines"], json(std::vector<double>(7, 1.0)));
    EXPECT_EQ(list[1]["ratio"]["machines"], json({1.5, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0}));
    EXPECT_EQ(list[1]["ratio"]["median"], 5.0);
    EXPECT_EQ(list[1]["ratio"]["least"], 1.5);
    EXPECT_EQ(list[1]["ratio"]["largest"], 8.0);
    EXPECT_THAT(read_output_file("merged/machines.csv"),
                testing::AllOf(testing::HasSubstr("scene,label,device,driver,commit,machines,ms,"),
                               testing::HasSubstr(",7,4,1,20,1,20,1,1,1,1,1,")));
    // A site of results gets each machine's times beside the errors of the views.
    const json results = read_output_json("merged/results.json")["comparisons"];
    ASSERT_EQ(results.size(), 7u);
    EXPECT_EQ(results[3]["machine"], "machine3");
    EXPECT_EQ(results[3]["date"], first["date"]);
    EXPECT_EQ(results[3]["rows"][1]["gpu_ms"]["median"], 15.0);
    const json errors = read_output_json("merged/merged.json")["groups"][0]["rows"][1]["error"];
    EXPECT_EQ(results[3]["rows"][1]["error"]["flip"], errors["flip"]["median"]);
    EXPECT_EQ(results[3]["rows"][1]["error"]["rmse"], errors["rmse"]["median"]);
    EXPECT_EQ(results[3]["pareto"], json({1})) << "black mirrors take less time, but are no answer";
    // Five machines bound no median with 95 % confidence. Times of another identity are apart.
    for (const std::size_t i : {6UL, 7UL}) {
        json result = read_output_json(result_file(timing_ids[i]));
        result["identity"]["driver"] = "another";
        write_input_file(result_file(timing_ids[i]), result.dump(1));
    }
    expect_success({"sweep", "merge", "sweep", "-o", "apart", "--quiet"});
    const json apart = read_output_json("apart/times.json")["over_machines"];
    ASSERT_EQ(apart.size(), 4u);
    for (const json& row : apart) {
        EXPECT_EQ(row["ms"]["ci95"], json());
        EXPECT_EQ(row["ms"]["machines"].size(), row["identity"]["driver"] == "another" ? 2u : 5u);
    }
}

TEST_F(Sweep, ChangedSceneAndChangedPlanAreRefused) {
    write_input_file("scene.obj",
                     "mtllib scene.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    write_input_file("scene.mtl", "newmtl m\nKd 0 0 0\nKs 1 1 1\nillum 3\nNs 1000000\n");
    json sweep = make_small_sweep();
    sweep["scenes"] = {"scene.obj"};
    sweep.erase("views");
    ASSERT_EQ(plan_sweep(sweep, "sweep").exit_code, 0);
    write_input_file("scene.obj",
                     "mtllib scene.mtl\nv 0 0 0\nv 2 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    expect_usage_refused({"sweep", "run", "sweep", "--quiet"}, 65,
                         {"scene.obj", "the scene was changed after the sweep was planned"});
    std::string plan = read_output_file("sweep/plan.json");
    plan.replace(plan.rfind("naive:bounces=0"), 15, "naive:bounces=1");
    write_input_file("sweep/plan.json", plan);
    expect_usage_refused({"sweep", "run", "sweep"}, 65,
                         {"plan.json.pieces[", "was changed: wanted the id of its content"});
    sweep["techniques"] = {"parallax"};
    const test::ProcessResult again = plan_sweep(sweep, "sweep");
    expect_exit_code(again, 2, {"plan.json: wanted a folder without a plan"});
}

TEST_F(Sweep, RefusalsNameTheMember) {
    const auto refuse = [&](const std::function<void(json&)>& change, int exit_code,
                            const Words& parts) {
        json sweep = make_small_sweep();
        change(sweep);
        expect_plan_refused(sweep, exit_code, parts);
    };
    refuse([](json& s) { s["colour"] = 1; }, 65, {"sweep.json", "wanted schema", "'colour'"});
    refuse([](json& s) { s.erase("scenes"); }, 65, {"sweep.json.scenes", "found nothing"});
    refuse([](json& s) { s["scenes"] = {3}; }, 65, {"sweep.json.scenes: wanted texts, found '3'"});
    refuse([](json& s) { s["scenes"] = {"room", "room"}; }, 65, {"wanted different scenes"});
    refuse([](json& s) { s["scenes"] = {"none.glb"}; }, 66, {"none.glb"});
    refuse([](json& s) { s["techniques"] = {"mirrored"}; }, 2, {"mirrored"});
    refuse([](json& s) { s["knobs"] = {{"hue", {1, 2}}}; }, 2, {"hue"});
    refuse([](json& s) { s["techniques"] = {"--"}; }, 65, {"wanted a technique, found '--'"});
    refuse([](json& s) { s["techniques"] = {"plan:p.json"}; }, 65, {"rules of a plan as text"});
    refuse([](json& s) { s["scenes"] = {"--version"}; }, 65, {"wanted a scene"});
    refuse([](json& s) { s["schema"] = 5; }, 65, {"schema", "catoptric/sweep/1, found '5'"});
    refuse([](json& s) { s["options"]["siez"] = "1x1"; }, 65,
           {"options.siez", "'compare' has no option '--siez'"});
    refuse([](json& s) { s["options"]["version"] = true; }, 65, {"options.version"});
    refuse([](json& s) { s["options"]["size"] = false; }, 65, {"text or a number, found 'false'"});
    refuse([](json& s) { s["options"]["animate"] = false; }, 65, {"wanted true", "'false'"});
    refuse([](json& s) { s["options"]["mirror"] = json::array(); }, 65, {"an empty list"});
    refuse([](json& s) { s["options"]["model"] = "both"; }, 65, {"found both"});
    refuse([](json& s) { s["options"]["reference"] = {"x.exr"}; }, 65, {"found a file"});
    refuse([](json& s) { s["views"] = {{"seed", 7}}; }, 65, {"views", "count of at least 6"});
    refuse(
        [](json& s) {
            for (const char* name : {"exposure", "ambient", "time", "environment-scale"})
                for (int i = 0; i < 60; ++i) s["axes"][name].push_back(i);
        },
        65, {"axes: wanted a sweep of at most 1000000 pieces"});
    refuse([](json& s) { s["options"]["output"] = "x"; }, 65,
           {"sweep.json.options.output", "cannot set this option"});
    for (const char* name : {"figures", "crop", "inline", "cameras-per-instant"})
        refuse([&](json& s) { s["options"][name] = "1"; }, 65,
               {"options." + std::string(name), "cannot set this option"});
    refuse([](json& s) { s["options"]["views"] = 6; }, 65, {"options.views"});
    refuse([](json& s) { s["options"]["reference-seconds"] = 6; }, 65, {"its knob 'rays'"});
    refuse([](json& s) { s["options"]["reference"] = "x.exr"; }, 65, {"wanted a technique"});
    refuse([](json& s) { s["options"]["seed"] = 6; }, 65, {"views.seed"});
    refuse([](json& s) { s["options"]["size"] = nullptr; }, 65, {"options.size", "nothing"});
    refuse([](json& s) { s["axes"] = {{"size", {"8x8", "9x9"}}}; }, 65, {"axes.size", "'options'"});
    refuse([](json& s) { s["axes"] = {{"time", {1, 1}}}; }, 65, {"axes.time", "twice"});
    refuse([](json& s) { s["views"] = {{"count", 0}}; }, 65, {"views.count", "from 1"});
    refuse([](json& s) { s["views"] = {{"count", 3}}; }, 2, {"wanted 1 or at least 6", "found 3"});
    refuse([](json& s) { s["timing"] = {{"repeats", -1}}; }, 65, {"timing.repeats"});
    write_input_file("sweep.json", "{\"scenes\": [\"room\"");
    expect_usage_refused({"sweep", "plan", "sweep.json", "-o", "refused"}, 65,
                         {"sweep.json: JSON: line 1"});
    expect_usage_refused({"sweep", "plan", "sweep.json"}, 2, {"-o DIR"});
    expect_usage_refused({"sweep", "run", "nowhere"}, 66, {"plan.json"});
    expect_usage_refused({"sweep", "walk", "nowhere"}, 2, {"plan", "walk"});
    ASSERT_EQ(plan_sweep(make_small_sweep(), "sweep").exit_code, 0);
    expect_usage_refused({"sweep", "run", "sweep", "--piece", "0123"}, 2, {"--piece", "'0123'"});
    expect_usage_refused({"sweep", "check", "sweep", "--kind", "timings"}, 2, {"--kind"});
    const std::string id = list_piece_ids("sweep").front();
    expect_usage_refused({"sweep", "run", "sweep", "--piece", id, "--kind", "timings"}, 2,
                         {"wanted no --kind"});
    expect_usage_refused({"sweep", "check", "sweep", "--piece", "0123"}, 2, {"--piece"});
}

} // namespace
