// Tests of GPU timestamps: passes lie in order and add up to the frame, and four times the work
// takes about four times as long. The tests compare ratios only, because times depend on the
// machine.
#include "measure/statistics.hpp"
#include "report/comparison.hpp"
#include "scene/built_in.hpp"
#include "session/access.hpp"
#include "session/frames.hpp"
#include "study/compare_row.hpp"
#include "study/row_run.hpp"
#include "support/rendering.hpp"

#include <algorithm>
#include <iostream>

namespace {

using namespace catoptric;

void expect_passes_in_order(const session::FrameTimes& frame) {
    ASSERT_FALSE(frame.passes.empty());
    double last = 0;
    for (const session::PassTime& pass : frame.passes) {
        EXPECT_GE(pass.begin_ms, last) << pass.name;
        EXPECT_GE(pass.end_ms, pass.begin_ms) << pass.name;
        last = pass.begin_ms;
    }
    EXPECT_DOUBLE_EQ(frame.passes.front().begin_ms, 0);
    EXPECT_DOUBLE_EQ(frame.passes.back().end_ms, frame.gpu_ms);
    EXPECT_GT(frame.wall_ms, 0);
    EXPECT_GT(frame.record_ms, 0);
}

class SessionClosingTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Frames, SessionClosingTest, testing::Values("raytrace", "reuse"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST_P(SessionClosingTest, IsolatedPassesAddUpToTheFrame) {
    session::Request request = test::make_test_request(scene::make_cornell(), {GetParam()},
                                                       {512, 512});
    request.warmup = 2, request.frames = 7;
    const session::RunResult result = session::run(test::get_test_engine(), request);
    const bool cpu = test::get_test_engine().device().type == "cpu";
    std::vector<double> shares, walls;
    for (const session::FrameTimes& frame : result.frames) {
        expect_passes_in_order(frame);
        double sum = 0;
        for (const session::PassTime& pass : frame.passes) sum += pass.ms();
        shares.push_back(sum / (cpu ? frame.wall_ms : frame.gpu_ms));
        walls.push_back(frame.wall_ms);
    }
    // Other programs can interrupt a frame between its passes, which lowers its share. So the least
    // disturbed frame shows whether passes leave out a part of the frame.
    const double largest = std::ranges::max(shares), median = measure::summarise(shares).median;
    std::cout << "[ MEASURED ] passes are " << 100 * median << " % (median) and up to "
              << 100 * largest << " % of a frame of " << measure::summarise(walls).median
              << " ms\n";
    if (cpu && measure::summarise(walls).median < 20)
        GTEST_SKIP() << "frames below 20 ms: the cost of a submit is not small beside them";
    EXPECT_GE(largest, .95);
    EXPECT_LE(median, 1.01);
}

TEST(Timing, PipelinedPassesLieWithinTheFrame) {
    session::Request request = test::make_test_request(test::make_lit_room(2, 1), {"reuse"},
                                                       {64, 64});
    request.timing = session::PassTimingMode::pipelined;
    request.frames = 3;
    for (const session::FrameTimes& frame : session::run(test::get_test_engine(), request).frames)
        for (const session::PassTime& pass : frame.passes) {
            EXPECT_GE(pass.begin_ms, 0) << pass.name;
            EXPECT_GE(pass.ms(), 0) << pass.name;
            EXPECT_LE(pass.end_ms, frame.gpu_ms) << pass.name;
        }
}

TEST(Timing, LongRunKeepsThePassesOfItsLastFrames) {
    session::Request request = test::make_test_request(test::make_lit_room(2, 1),
                                                       {"reuse:face=8,shadow_map=8"}, {8, 8});
    request.warmup = 0, request.frames = static_cast<int>(session::kMaxDetailedFrames) + 2;
    const std::vector<session::FrameTimes> frames =
        session::run(test::get_test_engine(), request).frames;
    ASSERT_EQ(frames.size(), session::kMaxDetailedFrames + 2);
    for (std::size_t i = 0; i < frames.size(); ++i) {
        EXPECT_EQ(frames[i].passes.capacity() == 0, i < 2) << i;
        EXPECT_GT(frames[i].passes_ms, 0) << i;
    }
    double sum = 0;
    for (const session::PassTime& pass : frames.back().passes) sum += pass.ms();
    EXPECT_DOUBLE_EQ(frames.back().passes_ms, sum);
    const report::Row row = [&] {
        report::Row filled;
        study::fill_row_times(filled, {.rounds = {frames}}, "", true);
        return filled;
    }();
    EXPECT_EQ(row.gpu_ms.samples.size(), frames.size());
    ASSERT_FALSE(row.passes.empty());
    EXPECT_EQ(row.passes.front().gpu_ms.samples.size(), session::kMaxDetailedFrames);
    EXPECT_GT(row.passes.front().gpu_ms.median, 0);
}

// If captures take turns, a sample is the mean of a cycle, because most frames draw no capture.
TEST(Timing, SamplesOfTurnsAreMeansOfWholeCycles) {
    std::vector<std::vector<session::FrameTimes>> rounds(4);
    const std::vector<double> ms{9, 1, 2, 12, 3, 6, 9, 0, 3, 100, 200};
    for (std::size_t i = 0; i < ms.size(); ++i) {
        session::FrameTimes& frame = rounds[i / 3].emplace_back();
        frame.gpu_ms = ms[i], frame.wall_ms = 1;
        if (i % 3 == 0)
            frame.passes.push_back({.name = "capture/1", .begin_ms = 0, .end_ms = ms[i]});
        frame.passes.push_back({.name = "view", .begin_ms = 0, .end_ms = 1});
    }
    report::Row row;
    study::fill_row_times(row, {.rounds = rounds, .cycle = 3}, "", true);
    EXPECT_THAT(row.gpu_ms.samples, testing::ElementsAre(4, 7, 4));
    EXPECT_EQ(row.gpu_ms.median, 4);
    ASSERT_EQ(row.passes.size(), 2u);
    EXPECT_THAT(row.passes[0].gpu_ms.samples, testing::ElementsAre(3, 4, 3));
    EXPECT_EQ(row.passes[1].gpu_ms.median, 1);
    study::fill_row_times(row, {.rounds = rounds, .cycle = 64}, "", true);
    EXPECT_EQ(row.gpu_ms.samples.size(), 1u) << "fewer frames than a cycle has";
}

TEST(Timing, FirstRoundIsReplacedByLaterFrames) {
    session::Request request = test::make_test_request(test::make_lit_room(2, 1),
                                                       {"reuse:face=8,shadow_map=8"}, {8, 8});
    request.warmup = 1, request.frames = 5;
    session::Session session(test::get_test_engine(), request.scene);
    const session::Watcher watcher;
    study::RowMeasurement row(session, request, watcher, 3);
    for (const int frames : {3, 2}) row.measure_round(frames);
    EXPECT_EQ(row.frame_number(), 6);
    const std::vector<std::vector<session::FrameTimes>> before = row.rounds();
    row.repeat_first_round();
    EXPECT_EQ(row.frame_number(), 9);
    EXPECT_EQ(row.rounds()[0].front().wall_ms, before[0].front().wall_ms) << "not yet";
    row.replace_first_round();
    const std::vector<std::vector<session::FrameTimes>>& after = row.rounds();
    ASSERT_EQ(after.size(), 2u);
    ASSERT_EQ(after[0].size(), 3u);
    ASSERT_EQ(after[1].size(), 2u);
    EXPECT_NE(after[0].front().wall_ms, before[0].front().wall_ms);
    EXPECT_EQ(after[1].front().wall_ms, before[1].front().wall_ms);
    EXPECT_TRUE(study::must_repeat_first_round("discrete"));
    EXPECT_FALSE(study::must_repeat_first_round("cpu"));
}

TEST(Timing, FourTimesTheWorkTakesAboutFourTimesAsLong) {
    graph::GraphRunner runner(test::get_test_device().device, test::get_test_device().pipelines);
    // This number of work groups keeps a graphics card of 10,000 lanes busy.
    const std::uint32_t kWorkGroupCount = test::get_test_device().device.is_cpu() ? 256 : 16384;
    std::vector<double> one, four;
    for (int frame = 0; frame < 9; ++frame) {
        graph::Graph graph;
        const graph::BufferHandle counts = graph.add_buffer({"counts", 4 * 4 * kWorkGroupCount});
        graph.add_pass("clear")
            .writes(counts, graph::ResourceUse::copy_to)
            .record([=](graph::PassCommands& commands) { commands.fill_buffer(counts, 0); });
        for (int i = 0; i < 4; ++i) {
            const std::uint32_t groups = i % 2 ? 4 * kWorkGroupCount : kWorkGroupCount;
            graph.add_pass((i % 2 ? "four/" : "one/") + std::to_string(i))
                .writes(counts, graph::ResourceUse::storage)
                .record([=](graph::PassCommands& commands) {
                    commands.bind_pipeline(gpu::ComputeState{"tests/spin.comp", {}});
                    commands.bind("Counts", counts);
                    commands.push_constants(4000u);
                    commands.dispatch(groups, 1);
                });
        }
        graph.output(counts);
        const graph::GraphFrameTimes times = test::run_graph(runner, graph);
        if (frame < 2) continue;
        for (const graph::GraphPassTime& pass : times.passes) {
            if (pass.name.starts_with("one")) one.push_back(pass.elapsed_ms());
            if (pass.name.starts_with("four")) four.push_back(pass.elapsed_ms());
        }
    }
    const double ratio = measure::summarise(four).median / measure::summarise(one).median;
    std::cout << "[ MEASURED ] 4x the work: " << ratio << "x (" << measure::summarise(one).median
              << " ms)\n";
    EXPECT_GE(ratio, 2.5);
    EXPECT_LE(ratio, 6);
}

} // namespace
