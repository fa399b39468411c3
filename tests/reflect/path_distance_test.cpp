// Tests of the distance of a reference to path tracing.
#include "scene/classify.hpp"
#include "study/path_distance.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <iostream>

namespace {

using namespace catoptric;

constexpr double kAmpleSeconds = 1000; ///< precision ends the measurement earlier

/// Measures the distance of a reference, and counts the frames that this takes.
struct DistanceRun {
    std::optional<measure::PathDistance> distance;
    int frames = 0;
    std::vector<std::string> warnings;
};

DistanceRun measure_distance(session::Engine& engine, const scene::Scene& scene, double seconds,
                             const std::string& reference = "raytrace:depth=16",
                             const uvec2& size = {16, 16}) {
    session::Request base = test::make_test_request(scene, {"naive:face=16"}, size);
    base.ambient = 0;
    session::Session session(engine, scene);
    DistanceRun run;
    run.distance = study::measure_path_distance(
        engine, session, base, reference, seconds, {.on_frame = [&](int, int) { ++run.frames; }},
        [&](const std::string& warning) { run.warnings.push_back(warning); });
    if (run.distance)
        std::cout << "[ MEASURED ] FLIP " << run.distance->flip << ", noise " << run.distance->noise
                  << ", whole picture " << run.distance->flip_all << " and "
                  << run.distance->noise_all << ", " << run.distance->paths << " paths\n";
    return run;
}

scene::Scene make_room_with_lamp() {
    scene::Scene room = test::make_lit_room(1, 1);
    scene::find_mirrors(room);
    return room;
}

scene::Scene make_black_furnace() {
    scene::Scene furnace = test::make_furnace_scene(1);
    scene::find_mirrors(furnace);
    return furnace;
}

TEST(PathDistance, LampInAClosedRoomLeavesTheReferenceFarAway) {
    const DistanceRun run = measure_distance(test::get_test_engine(), make_room_with_lamp(),
                                             kAmpleSeconds);
    ASSERT_TRUE(run.distance && run.distance->is_known()) << run.distance->unknown;
    EXPECT_GT(measure::distance_interval(*run.distance).low, .1);
    EXPECT_TRUE(measure::is_precise(*run.distance));
    EXPECT_GT(run.distance->flip_all, .1);
    EXPECT_EQ(run.distance->paths % 8, 0) << "both halves have as many frames of four paths";
    EXPECT_EQ(run.frames, run.distance->paths / 4 + 1) << "and the reference has one frame";
}

/// The walls emit light and reflect none, so ray tracing shows all light.
TEST(PathDistance, MirrorBallInABlackFurnaceHasNoDistance) {
    const DistanceRun run = measure_distance(test::get_test_engine(), make_black_furnace(),
                                             kAmpleSeconds);
    ASSERT_TRUE(run.distance && run.distance->is_known()) << run.distance->unknown;
    EXPECT_LT(run.distance->flip, 1e-4);
    EXPECT_LT(run.distance->flip_all, 1e-4);
    EXPECT_EQ(run.distance->paths, 8) << "one frame of each half is precise";
}

/// The reference of a rough scene has noise of its own, which must not count as a distance.
TEST(PathDistance, NoiseOfARoughReferenceIsNoDistance) {
    scene::Scene furnace = make_black_furnace();
    test::make_mirrors_rough(furnace, .1f); // little noise, so few paths
    const DistanceRun run = measure_distance(test::get_test_engine(), furnace, kAmpleSeconds,
                                             "raytrace:depth=16,rays=64");
    ASSERT_TRUE(run.distance && run.distance->is_known()) << run.distance->unknown;
    EXPECT_LE(measure::distance_interval(*run.distance).low, 0);
    EXPECT_LT(run.distance->flip, .05);
}

TEST(PathDistance, PathTracedReferenceHasNone) {
    const DistanceRun run = measure_distance(test::get_test_engine(), make_black_furnace(), 0,
                                             "raytrace:indirect=paths,rays=2");
    EXPECT_FALSE(run.distance);
    EXPECT_EQ(run.frames, 0);
}

TEST(PathDistance, ReachedLimitOfTimeIsNotKnown) {
    constexpr double kTinySeconds = 1e-9; // the first frame takes longer
    const DistanceRun run = measure_distance(test::get_test_engine(), make_room_with_lamp(),
                                             kTinySeconds);
    ASSERT_TRUE(run.distance);
    EXPECT_FALSE(run.distance->is_known());
    EXPECT_THAT(run.distance->unknown,
                testing::AllOf(testing::HasSubstr("a frame of 4 paths a pixel took"),
                               testing::HasSubstr("1e-09 s are the limit")));
    EXPECT_EQ(run.distance->command, "catoptric compare room -o DIR --truth paths --techniques "
                                     "raytrace:depth=16");
    EXPECT_EQ(run.frames, 2) << "one frame of paths and one of the reference";
}

TEST(PathDistance, RasterisedReferenceIsNotKnown) {
    const DistanceRun run = measure_distance(test::get_test_engine(), make_room_with_lamp(),
                                             kAmpleSeconds, "naive:face=16");
    ASSERT_TRUE(run.distance);
    EXPECT_EQ(run.distance->unknown, "the reference is not ray traced");
    EXPECT_EQ(run.frames, 0);
}

TEST(PathDistance, PictureHasAtMost64x64PixelsInTheShapeOfTheComparison) {
    for (const auto& [size, wanted] : std::vector<std::pair<uvec2, uvec2>>{
             {{512, 512}, {64, 64}}, {{1920, 1080}, {85, 48}}, {{20, 10}, {20, 10}}}) {
        const DistanceRun run = measure_distance(test::get_test_engine(), make_black_furnace(), 0,
                                                 "raytrace", size);
        EXPECT_EQ(run.distance->width, static_cast<int>(wanted.x));
        EXPECT_EQ(run.distance->height, static_cast<int>(wanted.y));
        EXPECT_EQ(run.frames, 0) << "a limit of 0 s";
    }
}

TEST(PathDistance, SignalEndsIt) {
    session::Request base = test::make_test_request(make_room_with_lamp(), {"naive:face=16"},
                                                    {16, 16});
    session::Session session(test::get_test_engine(), base.scene);
    std::atomic<int> signal{0};
    int frames = 0;
    const session::Watcher watcher{.on_frame = [&](int, int) { signal = ++frames == 2 ? 15 : 0; },
                                   .stop = &signal};
    test::expect_error(
        [&] {
            study::measure_path_distance(test::get_test_engine(), session, base,
                                         "raytrace:depth=16", kAmpleSeconds, watcher,
                                         [](const std::string&) {});
        },
        Failure::terminated, {"stopped by signal 15"});
    EXPECT_EQ(frames, 2);
}

class KeptPathDistance : public test::InFolder {
protected:
    DistanceRun measure_with_cache(const scene::Scene& scene, double seconds = kAmpleSeconds,
                                   const std::string& reference = "raytrace:depth=16") {
        return measure_distance(engine_, scene, seconds, reference);
    }

private:
    session::Engine engine_{{.device = test::read_wanted_device_name(), .cache = folder}};
};

TEST_F(KeptPathDistance, SecondRunTracesNoPath) {
    const DistanceRun first = measure_with_cache(make_black_furnace()),
                      again = measure_with_cache(make_black_furnace());
    EXPECT_GT(first.frames, 0);
    EXPECT_FALSE(first.distance->is_kept);
    EXPECT_EQ(again.frames, 0);
    EXPECT_TRUE(again.distance->is_kept);
    EXPECT_EQ(again.distance->flip, first.distance->flip);
    EXPECT_EQ(again.distance->noise, first.distance->noise);
    EXPECT_EQ(again.distance->flip_all, first.distance->flip_all);
    EXPECT_EQ(again.distance->paths, first.distance->paths);
    EXPECT_EQ(again.distance->command, first.distance->command);
    EXPECT_TRUE(measure_with_cache(make_black_furnace(), 0).distance->is_kept)
        << "a kept result needs no time";
    EXPECT_EQ(
        measure_with_cache(make_black_furnace(), kAmpleSeconds, "raytrace:depth=16,samples=64")
            .frames,
        0)
        << "samples do not change the light";

    scene::Scene brighter = make_black_furnace();
    for (scene::Material& material : brighter.materials) material.emission *= 1.5f;
    EXPECT_GT(measure_with_cache(brighter).frames, 0) << "another scene";
    EXPECT_GT(measure_with_cache(make_black_furnace(), kAmpleSeconds, "raytrace:depth=3").frames, 0)
        << "another reference";
}

TEST_F(KeptPathDistance, BrokenFileIsSaidAndReplaced) {
    measure_with_cache(make_black_furnace());
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "paths"))
        files.push_back(entry.path());
    ASSERT_EQ(files.size(), 1u);
    for (const std::string broken : {"", "{", "{}", R"({"schema":"catoptric/path-distance/1"})"}) {
        std::ofstream(files[0], std::ios::binary) << broken;
        const DistanceRun said = measure_with_cache(make_black_furnace());
        EXPECT_THAT(said.warnings, testing::ElementsAre(
                                       testing::AllOf(testing::HasSubstr(files[0].string()),
                                                      testing::HasSubstr("it is measured again"))))
            << broken;
        EXPECT_GT(said.frames, 0);
        EXPECT_EQ(measure_with_cache(make_black_furnace()).frames, 0) << "a new file was written";
    }
}

TEST_F(KeptPathDistance, FolderThatCannotBeWrittenToIsSaid) {
    std::ofstream(folder / "paths") << "not a folder";
    const DistanceRun run = measure_with_cache(make_black_furnace());
    EXPECT_TRUE(run.distance->is_known());
    EXPECT_THAT(run.warnings, testing::ElementsAre(testing::HasSubstr(
                                  "each comparison of this scene measures the distance")));
}

} // namespace
