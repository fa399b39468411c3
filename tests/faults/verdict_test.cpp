// What a user is told of when all calls succeed and the device does not do them, or does them in an
// order that makes its clock lie.
#include "faults/faults.hpp"

namespace {

class Verdict : public Faults {};

/// A software driver takes a stamp that no barrier follows after the next pass's work.
TEST_F(Verdict, AnExecutionBarrierFollowsEachStamp) {
    const Words words{"compare",  "-o", "out",          "--size",   "32x32",    "--frames", "2",
                      "--warmup", "0",  "--techniques", "parallax", "raytrace", "hybrid"};
    const Watched watched = watch(words, std::nullopt);
    ASSERT_EQ(watched.ended.exit_code, 0) << watched.ended.err;
    EXPECT_GT(watched.counts.at("vkCmdWriteTimestamp2").calls, 30);
    EXPECT_EQ(watched.loose_stamps, 0);
    Words pipelined = words;
    pipelined.insert(pipelined.end() - 4, {"--timing", "pipelined"});
    EXPECT_GT(watch(pipelined, std::nullopt).loose_stamps, 0)
        << "the layer sees none that is loose";
}

/// A frame whose rays are never traced fails its property, and the run with it. What its picture
/// then holds is whatever the memory held, so that what is measured may be no number (null).
TEST_F(Verdict, StressWithAFailedRowExitsWithOne) {
    const Words words{"stress", "--json", "--size", "32x32", "--only", "N4"};
    const Watched sound = watch(words, std::nullopt);
    ASSERT_EQ(sound.ended.exit_code, 0) << sound.ended.err;
    const Watched broken = watch(words, Fault{"vkCmdDispatch", 5, 1});
    EXPECT_EQ(broken.ended.exit_code, 1) << broken.ended.err;
    const nlohmann::json rows = nlohmann::json::parse(broken.ended.out)["rows"];
    EXPECT_EQ(rows[0]["verdict"], "fail");
    const nlohmann::json& measured = rows[0]["measured"];
    EXPECT_TRUE(measured.is_null() || measured > rows[0]["threshold"]) << rows[0];
}

} // namespace
