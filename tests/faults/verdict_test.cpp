// Tests of faults in which all Vulkan calls succeed: the device skips recorded work, or a missing
// barrier makes timestamps wrong.
#include "faults/faults.hpp"

namespace {

class Verdict : public Faults {};

/// Without a barrier after a timestamp, a software driver may take the timestamp after the work of
/// the next pass.
TEST_F(Verdict, ExecutionBarrierFollowsEachTimestamp) {
    const Words words{"compare",  "-o", "out",          "--size",   "32x32",    "--frames", "2",
                      "--warmup", "0",  "--techniques", "parallax", "raytrace", "hybrid"};
    const WatchedRun watched = run_with_fault_layer(words, std::nullopt);
    ASSERT_EQ(watched.ended.exit_code, 0) << watched.ended.err;
    EXPECT_GT(watched.counts.at("vkCmdWriteTimestamp2").calls, 30);
    EXPECT_EQ(watched.loose_stamps, 0);
    Words pipelined = words;
    pipelined.insert(pipelined.end() - 4, {"--timing", "pipelined"});
    EXPECT_GT(run_with_fault_layer(pipelined, std::nullopt).loose_stamps, 0)
        << "the layer sees none that is loose";
}

/// The dispatch that traces rays is left out. The stress row must then fail, and the run too. The
/// picture holds undefined memory, so the measured value may be no number (null).
TEST_F(Verdict, StressWithAFailedRowExitsWithOne) {
    const Words words{"stress", "--json", "--size", "32x32", "--only", "N4"};
    const WatchedRun sound = run_with_fault_layer(words, std::nullopt);
    ASSERT_EQ(sound.ended.exit_code, 0) << sound.ended.err;
    const WatchedRun broken = run_with_fault_layer(words, VulkanCallFault{"vkCmdDispatch", 5, 1});
    EXPECT_EQ(broken.ended.exit_code, 1) << broken.ended.err;
    const nlohmann::json rows = nlohmann::json::parse(broken.ended.out)["rows"];
    EXPECT_EQ(rows[0]["verdict"], "fail");
    const nlohmann::json& measured = rows[0]["measured"];
    EXPECT_TRUE(measured.is_null() || measured > rows[0]["threshold"]) << rows[0];
}

} // namespace
