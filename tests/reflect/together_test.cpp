// Tests of several techniques in one frame: each must render the picture of a separate run, and all
// passes share one timeline.
#include "scene/built_in.hpp"
#include "support/rendering.hpp"

#include <set>

namespace {

using namespace catoptric;

TEST(Together, PicturesEqualThoseOfSeparateRuns) {
    std::vector<std::string> techniques;
    for (const session::TechniqueInfo& technique : session::techniques())
        techniques.push_back(
            test::technique_with_knobs(technique, {{"face", "64"}, {"shadow_map", "256"}}));
    techniques.push_back("naive:bounces=1,face=32"); // `naive` a second time, with other settings
    session::Request request = test::make_test_request(scene::make_cornell(), techniques, {96, 80});
    request.warmup = 1, request.frames = 2;
    request.animate = true;
    const session::RunResult together = session::run(test::get_test_engine(), request);
    ASSERT_EQ(together.parts.size(), techniques.size());
    for (std::size_t i = 0; i < techniques.size(); ++i) {
        request.techniques = {techniques[i]};
        const session::TechniqueResult alone = std::move(
            session::run(test::get_test_engine(), request).parts.front());
        const session::TechniqueResult& part = together.parts[i];
        EXPECT_TRUE(test::have_equal_pixel_bytes(part.hdr, alone.hdr)) << techniques[i];
        EXPECT_TRUE(test::have_equal_pixel_bytes(part.display, alone.display)) << techniques[i];
        EXPECT_EQ(part.hits, alone.hits) << techniques[i];
        EXPECT_EQ(part.scene_passes, alone.scene_passes) << techniques[i];
        EXPECT_EQ(part.rays.has_value(), alone.rays.has_value());
        if (part.rays && alone.rays) {
            EXPECT_EQ(part.rays->mirror, alone.rays->mirror);
        }
    }
}

TEST(Together, AllPassesLieOnOneTimeline) {
    session::Request request = test::make_test_request(scene::make_cornell(),
                                                       {"reuse:face=64", "raytrace"}, {64, 64});
    const session::RunResult result = session::run(test::get_test_engine(), request);
    ASSERT_EQ(result.frames.size(), 1u);
    std::set<std::string> names;
    double time = 0;
    for (const session::PassTime& pass : result.frames.front().passes) {
        EXPECT_TRUE(names.insert(pass.name).second) << pass.name;
        EXPECT_GE(pass.begin_ms, time) << pass.name;
        time = pass.end_ms;
    }
    const std::string reuse = result.parts[0].prefix, traced = result.parts[1].prefix;
    EXPECT_NE(reuse, traced);
    for (const std::string& name :
         {reuse + "shadow", reuse + "capture/1", reuse + "capture/4", reuse + "view",
          reuse + "compose", traced + "raytrace", traced + "compose"})
        EXPECT_TRUE(names.contains(name)) << name;
    EXPECT_DOUBLE_EQ(time, result.frames.front().gpu_ms);
}

TEST(Together, TheSameTechniqueTwiceIsRefused) {
    test::expect_error(
        [] {
            session::run(test::get_test_engine(),
                         test::make_test_request(test::make_lit_room(1, 1),
                                                 {"reuse", "reuse:face=256"}, {16, 16}));
        },
        Failure::usage, {"'reuse:face=256'", "asked for twice"});
}

} // namespace
