// Tests of `catoptric bench --calibrate`: what it measures, and where it writes.
#include "cli/program.hpp"

namespace {

using nlohmann::json;
using testing::HasSubstr;

class Calibrate : public CommandLineTest {
protected:
    test::ProcessResult run_at_home(const Words& words) const {
        test::ProcessStartOptions asked = make_process_start(words);
        asked.environment = {{"XDG_CONFIG_HOME", (folder / "mine").string()}};
        return test::run_process(asked);
    }
};

TEST_F(Calibrate, CostsOfThisDeviceAreWrittenAndUsed) {
    const test::ProcessResult ended = run_at_home({"bench", "--calibrate", "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json costs = json::parse(ended.out);
    const std::filesystem::path file =
        std::filesystem::directory_iterator(folder / "mine/catoptric/costs")->path();
    EXPECT_EQ(json::parse(read_file_at_path(file)), costs);
    EXPECT_THAT(ended.err, HasSubstr("written: " + file.string()));
    const json device = json::parse(run_at_home({"info", "--json"}).out)["device"];
    EXPECT_EQ(costs["device"],
              device["name"].get<std::string>() + ", " + device["driver"].get<std::string>());
    EXPECT_EQ(device["calibration"], file.filename().string());
    EXPECT_THAT(run_at_home({"list", "devices"}).out, HasSubstr(", calibrated"));
    // Frames, rays and look-ups always take time on a processor.
    EXPECT_GE(costs["costs"].size(), 8u);
    for (const json& cost : costs["costs"]) EXPECT_GT(cost["ns"].get<double>(), 0) << cost;
    ASSERT_EQ(costs["fit"]["rows"], 30);
    for (const json& row : costs["fit"]["left_out"])
        EXPECT_GT(row["measured_ms"].get<double>(), 0) << row;
    // `auto` and the map use them.
    EXPECT_THAT(run_at_home({"graph", "flat", "--why"}).out,
                HasSubstr("calibration of this device"));
    const test::ProcessResult compared = run_at_home(
        add_small_frame_options({"compare", "flat", "-o", "out", "--map", "--techniques",
                                 "reuse:face=16", "raytrace:depth=1"}));
    ASSERT_EQ(compared.exit_code, 0) << compared.err;
    EXPECT_THAT(read_output_file("out/report.md"), HasSubstr(", calibrated (fitted)"));
    EXPECT_THAT(read_output_file("out/report.html"), HasSubstr(", calibrated"));
}

} // namespace
