// Tests of `catoptric bench`: which times it measures, and how it judges two measurements.
#include "cli/program.hpp"

#include "catoptric/bench_against.hpp"
#include "catoptric/bench_table.hpp"

#include <sys/stat.h>

namespace {

using namespace catoptric;
using nlohmann::json;
using testing::HasSubstr;

/// Returns a file of benchmark results with one round per value of `ms`, in milliseconds.
std::string make_benchmark_file(const std::vector<double>& ms,
                                const std::string& name = "frame/x") {
    json list = json::array();
    for (const double value : ms)
        list.push_back(
            {{"name", name}, {"real_time", value}, {"cpu_time", value}, {"time_unit", "ms"}});
    return json{{"benchmarks", list}}.dump();
}
const std::vector<double> kSixBenchmarkTimes{10, 11, 12, 13, 14, 15},
    kSixSlowerBenchmarkTimes{12, 13, 14, 15, 16, 17};

TEST_F(CommandLineTest, BenchMeasuresFramesAndLoadingAndSetup) {
    const test::ProcessResult ended = run_cli({"bench", "flat", "--techniques", "raytrace:depth=1",
                                               "--size", "16x16", "--frames", "6", "--warmup", "1",
                                               "-o", "out.json", "--quiet"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("medians of 6 rounds"));
    const json document = json::parse(read_output_file("out.json"));
    const bool counted = document["context"]["cycles"] == "user mode, all threads";
    std::map<std::string, int> rounds;
    for (const json& entry : document["benchmarks"]) {
        const std::string name = entry["run_name"];
        EXPECT_THAT(ended.out, HasSubstr(name));
        rounds[name] += entry["run_type"] == "iteration";
        EXPECT_GT(entry["real_time"].get<double>(), 0) << entry;
        EXPECT_GT(entry["cpu_time"].get<double>(), 0) << entry;
        EXPECT_EQ(entry.contains("cycles"), counted);
        if (name == "frame/flat/16x16/raytrace:depth=1" && entry["run_type"] == "iteration") {
            EXPECT_GE(entry["rays"], 16 * 16) << entry;
        }
    }
    EXPECT_THAT(rounds, testing::UnorderedElementsAre(
                            testing::Pair("load/flat", 6), testing::Pair("session/flat", 6),
                            testing::Pair("hierarchy/flat", 6),
                            testing::Pair("frame/flat/16x16/raytrace:depth=1", 6),
                            testing::Pair("host/flat/16x16/raytrace:depth=1", 6)));
    EXPECT_THAT(ended.out,
                HasSubstr(counted ? "Mcycles" : "cycles are not counted (perf_event_open: "));
    // A measurement compared with itself has no slower benchmark.
    const test::ProcessResult same = run_cli({"bench", "--compare", "out.json", "out.json"});
    EXPECT_EQ(same.exit_code, 0) << same.err;
    EXPECT_THAT(same.out, testing::ContainsRegex("counted work: all [0-9]+ counts are equal"));
    // If a run visits more BVH nodes, it counts as worse even if its times are equal.
    json grown = document;
    double nodes = 0;
    for (json& entry : grown["benchmarks"])
        if (entry.contains("work/nodes")) {
            nodes = entry["work/nodes"];
            entry["work/nodes"] = 2 * nodes;
        }
    ASSERT_GT(nodes, 0);
    write_input_file("grown.json", grown.dump());
    const test::ProcessResult more = run_cli({"bench", "--compare", "out.json", "grown.json"});
    EXPECT_EQ(more.exit_code, 1);
    EXPECT_THAT(more.err, HasSubstr("catoptric: more work: frame/flat/16x16/raytrace:depth=1 "
                                    "work/nodes "));
}

TEST_F(CommandLineTest, BenchCompareNamesSlowerBenchmarks) {
    write_input_file("before.json", make_benchmark_file(kSixBenchmarkTimes)),
        write_input_file("after.json", make_benchmark_file(kSixSlowerBenchmarkTimes));
    const test::ProcessResult slower = run_cli({"bench", "--compare", "before.json", "after.json"});
    EXPECT_EQ(slower.exit_code, 1);
    EXPECT_THAT(slower.out, HasSubstr("compared by processor time, ms"));
    EXPECT_THAT(slower.out, testing::ContainsRegex("frame/x +12.500 +14.500 +1.160 +"
                                                   "\\[1.133 - 1.200\\].* slower"));
    EXPECT_THAT(slower.err,
                testing::StartsWith("catoptric: warning: the files hold times, not cycles"));
    EXPECT_THAT(slower.err,
                testing::EndsWith("\ncatoptric: slower: frame/x 1.160 [1.133 - 1.200]\n"));
    const test::ProcessResult faster = run_cli(
        {"bench", "--compare", "after.json", "before.json", "--json", "-o", "out.json", "--quiet"});
    EXPECT_EQ(faster.exit_code, 0) << faster.err;
    EXPECT_EQ(json::parse(faster.out)["benchmarks"][0]["outcome"], "faster");
    EXPECT_EQ(read_output_file("out.json"), faster.out);
}

TEST_F(CommandLineTest, BenchRefusesInvalidOptionsAndFiles) {
    write_input_file("good.json", make_benchmark_file(kSixBenchmarkTimes)),
        write_input_file("bad.json", "{\"benchmarks\": 3}");
    expect_usage_refused({"bench", "--compare", "good.json"}, 2,
                         {"--compare: wanted OLD and NEW, found 1 file"});
    expect_usage_refused({"bench", "--compare", "good.json", "none.json"}, 66, {"none.json: "});
    expect_usage_refused(
        {"bench", "--compare", "bad.json", "good.json"}, 65,
        {"bad.json: wanted an object with a list 'benchmarks'", "found benchmarks: '3'"});
    expect_usage_refused(
        {"bench", "--compare", "good.json", "good.json", "-o", "good.json"}, 2,
        {"good.json: cannot be written: it is the same file as good.json, which is compared"});
    expect_usage_refused({"bench", "-o", "none/out.json", "--techniques", "reuse"}, 73,
                         {"none/out.json: cannot be created: there is no folder"});
    write_input_file("room.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    expect_usage_refused(
        {"bench", "room.obj", "-o", "room.obj", "--quiet", "--techniques", "raytrace", "--mirror",
         "*"},
        2,
        {"room.obj: cannot be written: it is the same file as ", ", which the scene is read from"});
    expect_usage_refused({"bench", "--techniques", "reuse", "flat"}, 2,
                         {"--techniques: wanted a technique, found the scene 'flat'"});
    expect_usage_refused({"bench", "--techniques", "reuse", "reuse"}, 2,
                         {"technique 'reuse' is asked for twice"});
    expect_usage_refused({"bench", "--model", "both"}, 2,
                         {"--model both: wanted everything or required"});
    expect_usage_refused({"bench", "--rounds", "0"}, 2, {"--rounds: wanted a whole number from 1"});
    expect_usage_refused({"bench", "--against", "./none", "--rounds", "5"}, 2,
                         {"rounds: wanted at least 6", "found 5"});
    expect_usage_refused({"bench", "--against", "./none"}, 66,
                         {"./none: cannot be run: No such file"});
    expect_usage_refused({"bench", "--against", "./none", "--compare", "a", "b"}, 2,
                         {"--compare and --against: wanted one of them, found both"});
}

class BenchDeviceCliTest : public CommandLineTest {
protected:
    /// Runs the program with the user's configuration folder inside the folder of the test.
    test::ProcessResult run_cli_with_home_folder(const Words& words) const {
        test::ProcessStartOptions asked = make_process_start(words);
        asked.environment = {{"XDG_CONFIG_HOME", (folder / "mine").string()}};
        return test::run_process(asked);
    }
    json read_device_json(const Words& words) const {
        const test::ProcessResult ended = run_cli_with_home_folder(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_EQ(ended.err, "");
        const json document = json::parse(ended.out);
        return document.contains("device") ? document["device"] : document["devices"][0];
    }
};

TEST_F(BenchDeviceCliTest, TuningWritesAProfileThatLaterRunsUse) {
    const test::ProcessResult tuned = run_cli_with_home_folder({"bench", "flat", "--tune", "--size",
                                                                "16x16", "--frames", "6",
                                                                "--warmup", "0", "--quiet"});
    ASSERT_EQ(tuned.exit_code, 0) << tuned.err;
    EXPECT_THAT(tuned.out, HasSubstr("frame/flat/16x16/raytrace:depth=4, 6 rounds"));
    const std::filesystem::path devices = folder / "mine/catoptric/devices";
    ASSERT_TRUE(std::filesystem::exists(devices)) << tuned.err;
    const std::filesystem::path file = std::filesystem::directory_iterator(devices)->path();
    const json profile = json::parse(read_file_at_path(file));
    json info = read_device_json({"info", "--json"});
    EXPECT_EQ(profile["device"]["driver"], info["driver"]);
    EXPECT_EQ(info["profile"], file.filename().string());
    EXPECT_EQ(info["variants"], profile["variants"]);
    for (const json& one : profile["measured"]) {
        const bool below = one["ci95"][1] < 1;
        EXPECT_EQ(one["taken"], below) << one;
        EXPECT_EQ(profile["variants"][one["variant"]], one[below ? "choice" : "against"]) << one;
        EXPECT_THAT(tuned.out, testing::ContainsRegex(one["variant"].get<std::string>() + " .*" +
                                                      (below ? "  taken" : "not taken")));
    }
    info.erase("lanes"); // `list devices` does not count lanes
    EXPECT_EQ(read_device_json({"list", "devices", "--json"}), info);
    const json none = read_device_json({"info", "--json", "--device-profile", "none"});
    EXPECT_TRUE(none["profile"].is_null());
    EXPECT_EQ(none["variants"]["groups"], "scattered");
}

TEST_F(BenchDeviceCliTest, NamedProfileIsUsedUnlessItIsOfAnotherDevice) {
    const json device = read_device_json({"info", "--json"});
    json profile{{"schema", "catoptric/device-profile/1"},
                 {"variants", {{"hierarchy", "storage"}}}};
    profile["device"] = {
        {"name", device["name"]}, {"driver", device["driver"]}, {"id", device["id"]}};
    write_input_file("p.json", profile.dump());
    const Words render{"render", "flat",  "--technique", "raytrace:depth=1",
                       "--size", "16x16", "--json",      "--quiet"};
    const auto with = [&](Words more) {
        more.insert(more.begin(), render.begin(), render.end());
        return more;
    };
    const json stored = read_device_json(with({"-o", "a.png", "--device-profile", "p.json"}));
    EXPECT_EQ(stored["profile"], "p.json");
    EXPECT_EQ(stored["variants"]["hierarchy"], "storage");
    EXPECT_EQ(read_device_json(with({"-o", "b.png"}))["variants"]["hierarchy"], "texel");
    EXPECT_EQ(read_output_file("a.png"), read_output_file("b.png"));
    expect_usage_refused({"info", "--device-profile", "none.json"}, 66, {"none.json: "});
    profile["device"]["driver"] = "of last year";
    write_input_file("p.json", profile.dump());
    expect_usage_refused(
        {"info", "--device-profile", "p.json"}, 65,
        {"p.json: is another device's or driver's profile: device.driver: wanted '",
         "', found 'of last year'"});
}

TEST_F(BenchDeviceCliTest, AutoComparesPlansByTheUsersCalibration) {
    const json device = read_device_json({"info", "--json"});
    const std::string name = device["name"].get<std::string>() + ", " +
                             device["driver"].get<std::string>();
    const auto explain = [&] {
        const test::ProcessResult ended = run_cli_with_home_folder({"graph", "flat", "--why"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return ended;
    };
    EXPECT_THAT(explain().out, testing::Not(HasSubstr("calibration of this device")));
    // The file's name is that of the profile, which an earlier test reads back.
    std::string file = device["id"].get<std::string>() + "-" + device["driver"].get<std::string>();
    for (char& c : file)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '.' && c != '-') c = '_';
    const std::string path = "mine/catoptric/costs/" + file + ".json";
    const auto write_calibration = [&](const std::string& of, const char* work) {
        write_input_file(path, json{{"schema", "catoptric/costs/1"},
                                    {"device", of},
                                    {"origin", "fitted"},
                                    {"costs", {{{"work", work}, {"ns", 1000}}}}}
                                   .dump());
    };
    std::filesystem::create_directories(folder / "mine/catoptric/costs");
    write_calibration(name, "fragments");
    EXPECT_EQ(read_device_json({"info", "--json"})["calibration"], file + ".json");
    EXPECT_FALSE(
        read_device_json({"info", "--json", "--device-profile", "none"}).contains("calibration"));
    // If only fragments take time, a traced picture takes none; if only nodes do, it takes most.
    const std::string dear_fragments = explain().out;
    EXPECT_THAT(dear_fragments, HasSubstr("calibration of this device"));
    EXPECT_THAT(dear_fragments, HasSubstr("suggested --plan \"raytrace"));
    write_calibration(name, "node_lanes");
    EXPECT_THAT(explain().out, testing::Not(HasSubstr("suggested --plan \"raytrace")));
    write_calibration("another card", "fragments");
    const test::ProcessResult foreign = explain();
    EXPECT_THAT(foreign.out, testing::Not(HasSubstr("calibration of this device")));
    EXPECT_THAT(foreign.err, HasSubstr("is another device's or driver's calibration"));
}

TEST_F(BenchDeviceCliTest, InvalidOptionsAreRefused) {
    expect_usage_refused({"bench", "flat", "--calibrate"}, 2,
                         {"--calibrate: wanted no SCENE, --techniques, --rounds"});
    expect_usage_refused({"bench", "--calibrate", "--frames", "3"}, 2, {"--calibrate: wanted no"});
    expect_usage_refused({"bench", "--calibrate", "--costs"}, 2,
                         {"--calibrate and --costs: wanted one of them, found both"});
    expect_usage_refused({"bench", "--calibrate", "-o", "none/c.json"}, 73, {"none/c.json"});
    expect_usage_refused({"bench", "--tune", "--compare", "a", "b"}, 2,
                         {"--tune and --compare: wanted one of them, found both"});
    expect_usage_refused({"bench", "--tune", "--against", "a"}, 2,
                         {"--tune and --against: wanted one of them, found both"});
    expect_usage_refused({"bench", "--tune", "--device-profile", "a"}, 2,
                         {"--tune and --device-profile: wanted one of them, found both"});
    expect_usage_refused({"bench", "flat", "room", "--tune"}, 2,
                         {"--tune: wanted at most one SCENE"});
    expect_usage_refused({"bench", "--tune", "--frames", "5"}, 2, {"wanted at least 6", "found 5"});
    expect_usage_refused({"bench", "--tune", "-o", "none/p.json"}, 73, {"none/p.json"});
}

TEST(BenchAgainst, EachRoundGetsTheOptionsOfTheCommandLine) {
    // An option is left out by its whole name.
    EXPECT_THAT(cli::round_words({"--framesets=2", "--outputs"}, 5),
                testing::ElementsAre("--framesets=2", "--outputs", "--json", "--quiet", "--rounds",
                                     "1", "--frames", "5"));
    EXPECT_THAT(cli::round_words({"room.glb", "--against", "old/catoptric", "--size=64x64",
                                  "--rounds=8", "-q", "-o", "x.json", "--frames", "99", "--json",
                                  "--techniques", "reuse", "march"},
                                 4),
                testing::ElementsAre("room.glb", "--size=64x64", "--techniques", "reuse", "march",
                                     "--json", "--quiet", "--rounds", "1", "--frames", "4"));
}

class BenchAgainstProgramCliTest : public CommandLineTest {
protected:
    /// Writes an executable script that appends its name and arguments to the file `log`, then runs
    /// the shell text `rest`. Returns the path of the script.
    std::string write_logging_program(const std::string& name, const std::string& rest) const {
        const std::filesystem::path path = folder / name;
        write_input_file(name, "#!/bin/sh\necho \"" + name + " $*\" >> '" +
                                   (folder / "log").string() + "'\n" + rest);
        ::chmod(path.c_str(), 0755);
        return path.string();
    }
    std::string make_measured_json(double ms) const {
        return "echo '" + make_benchmark_file({ms}) + "'\n";
    }
};

TEST_F(BenchAgainstProgramCliTest, ProgramsAlternateTheirOrderAndEachRoundIsKept) {
    const std::array runs = cli::bench_programs(
        {write_logging_program("old", make_measured_json(10)),
         write_logging_program("new", make_measured_json(12))},
        {"flat"}, 6, {});
    EXPECT_EQ(read_output_file("log"),
              "old bench flat\nnew bench flat\nnew bench flat\nold bench flat\n"
              "old bench flat\nnew bench flat\nnew bench flat\nold bench flat\n"
              "old bench flat\nnew bench flat\nnew bench flat\nold bench flat\n");
    const measure::BenchmarkChanges changes = measure::compare_runs(runs[0], runs[1]);
    EXPECT_EQ(cli::describe_slower(changes), "frame/x 1.200 [1.200 - 1.200]");
    EXPECT_EQ(runs[0].benchmarks[0].rounds.size(), 6U);
}

TEST_F(BenchAgainstProgramCliTest, ErrorNamesTheProgramThatFailed) {
    const auto refused = [&](const std::string& rest, const std::string& message) {
        const std::string wrong = write_logging_program("wrong", rest);
        try {
            cli::bench_programs({wrong, wrong}, {}, 6, {});
            ADD_FAILURE() << message;
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::bad_data);
            EXPECT_EQ(error.what(), wrong + message);
        }
    };
    refused("exit 3\n", ": wanted exit code 0, found 3");
    refused("kill -9 $$\n", ": wanted exit code 0, found signal 9");
    refused("echo '[]'\n", ": its stdout: wanted an object with a list 'benchmarks', as 'catoptric "
                           "bench --json' writes it, found a list");
}

TEST_F(BenchAgainstProgramCliTest, SignalEndsTheRunningProgram) {
    const std::string slow = write_logging_program("slow", "exec sleep 600\n");
    const std::atomic<int> stop{15};
    session::Watcher watcher;
    watcher.stop = &stop;
    try {
        cli::bench_programs({slow, slow}, {}, 6, watcher);
        ADD_FAILURE();
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::terminated);
    }
}

} // namespace
