// Test of sweeps: results of two drivers are merged only on request, and the merged tables then
// state how far the pictures of the drivers differ.
#include "cli/program.hpp"
#include "drivers/second_driver.hpp"

#include <iostream>

namespace {

using json = nlohmann::json;

class SecondDriverSweepTest : public CommandLineTest {
protected:
    /// Runs `count` pieces of the sweep in this environment. The first of these pieces is piece
    /// number `first`.
    void
    run_sweep_pieces_with_environment(std::size_t first, std::size_t count,
                                      const std::map<std::string, std::string>& environment) const {
        test::ProcessStartOptions start = make_process_start({"sweep", "run", "sweep", "--quiet"});
        const json plan = json::parse(read_output_file("sweep/plan.json"));
        for (std::size_t i = first; i < first + count; ++i) {
            start.command.emplace_back("--piece");
            start.command.push_back(plan["pieces"][i]["id"]);
        }
        start.environment = environment;
        const test::ProcessResult ended = test::run_process(start);
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
    }
};

TEST_F(SecondDriverSweepTest, PicturesOfTwoDriversAreMergedOnRequestWithTheirDifference) {
    const auto second = test::find_second_driver_environment();
    if (!second) GTEST_SKIP() << test::kNoSecondDriverMessage;
    const json sweep{{"scenes", {"cornell-mirrors", "flat"}},
                     {"techniques", {"parallax:face=64", "secant:face=64"}},
                     {"options", {{"size", "96x96"}, {"frames", 2}, {"warmup", 1}}},
                     {"views", {{"count", 6}, {"seed", 11}}},
                     {"timing", {{"repeats", 0}}}};
    write_input_file("sweep.json", sweep.dump());
    ASSERT_EQ(run_cli({"sweep", "plan", "sweep.json", "-o", "sweep"}).exit_code, 0);
    // Pieces are listed scene by scene, so each of the two drivers runs pieces of both scenes.
    run_sweep_pieces_with_environment(0, 3, {}), run_sweep_pieces_with_environment(3, 3, *second);
    run_sweep_pieces_with_environment(6, 3, *second), run_sweep_pieces_with_environment(9, 3, {});
    expect_usage_refused({"sweep", "merge", "sweep", "-o", "merged"}, 65,
                         {"2 identities", "driver: ", "Mesa 22", "Mesa 25", "--across-identities"});
    EXPECT_FALSE(std::filesystem::exists(folder / "merged"));
    const test::ProcessResult ended = run_cli(
        {"sweep", "merge", "sweep", "-o", "merged", "--across-identities"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json merged = json::parse(read_output_file("merged/merged.json"));
    EXPECT_EQ(merged["identities"].size(), 2u);
    const json& difference = merged["identity_difference"];
    std::cout << "[ MEASURED ] two drivers: " << difference << '\n';
    EXPECT_EQ(difference["pixels"], 2 * 3 * 96 * 96) << "two scenes, two rows and the reference";
    EXPECT_LE(difference["share"].get<double>(), .005);
}

} // namespace
