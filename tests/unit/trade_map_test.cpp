// Tests of the map of the trade: times at its points by hand, and the rows on its front.
#include "measure/trade_map.hpp"

#include <gmock/gmock.h>

#include <limits>

namespace {

using namespace catoptric;
using namespace catoptric::measure;

constexpr double kMapAtRest = std::numeric_limits<double>::infinity();

DeviceCosts make_map_costs() {
    return {.device = "card",
            .units = {{WorkKind::camera_rays, 2, {1, 4}, ""},
                      {WorkKind::fragments, 1, {1, 3}, ""},
                      {WorkKind::passes, 1000, {}, ""}}};
}

WorkCounts map_counts(std::uint64_t rays, std::uint64_t fragments, std::uint64_t passes) {
    WorkCounts counts;
    counts[WorkKind::camera_rays] = rays;
    counts[WorkKind::fragments] = fragments;
    counts[WorkKind::passes] = passes;
    return counts;
}

Row map_row(double flip) {
    Row row;
    row.error.flip = row.error.rmse = flip;
    row.error.pixels = 1;
    return row;
}

TEST(TradeMap, TimeIsCountTimesCostAtThePoint) {
    const MapWork work{map_counts(100, 5000, 10), map_counts(100, 1000, 2)};
    // Four times the pixels, captures each 4th frame, raster work twice as dear: rays 400 x 2 ns,
    // fragments (4 x 1000 + 4000 / 4) x 2 x 1 ns, passes (2 + 8 / 4) x 1000 ns.
    const PredictedTime time = map_time(make_map_costs(), work, {4, 4, 2});
    EXPECT_DOUBLE_EQ(time.ms, (800 + 10'000 + 4000) * 1e-6);
    EXPECT_DOUBLE_EQ(time.low, (800 + 10'000 + 4000) * 1e-6);  // below both ends
    EXPECT_DOUBLE_EQ(time.high, (400 + 30'000 + 4000) * 1e-6); // cheap rays, dear other work
    EXPECT_DOUBLE_EQ(map_time(make_map_costs(), work, {}).ms, (200 + 5000 + 10'000) * 1e-6);
    EXPECT_DOUBLE_EQ(map_time(make_map_costs(), work, {1, kMapAtRest, 1}).ms,
                     (200 + 1000 + 2000) * 1e-6);
}

TEST(TradeMap, WorkThatAFrameAtRestAddsIsNotNegative) {
    const MapWork work{map_counts(0, 10, 1), map_counts(0, 20, 1)};
    EXPECT_DOUBLE_EQ(map_time(make_map_costs(), work, {}).ms, (20 + 1000) * 1e-6);
}

TEST(TradeMap, EachKindHasOneClass) {
    std::size_t rays = 0, raster = 0, fixed = 0;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) {
        const auto kind = static_cast<WorkKind>(i);
        EXPECT_FALSE(is_ray_work(kind) && is_raster_work(kind)) << kWorkKinds[i].name;
        rays += is_ray_work(kind), raster += is_raster_work(kind);
        fixed += !grows_with_pixels(kind);
    }
    EXPECT_EQ(rays, 7u);
    EXPECT_EQ(raster, 10u);
    EXPECT_EQ(fixed, 6u);
    EXPECT_TRUE(is_raster_work(WorkKind::search_lanes));
    EXPECT_FALSE(is_raster_work(WorkKind::invocations));
}

TEST(TradeMap, CapturesWinWhereTheyAreKept) {
    // Row 0 draws captures, row 1 traces rays without an error, row 2 errs as row 0 but is dearer.
    const std::vector<Row> rows{map_row(.04), map_row(0), map_row(.04)};
    const std::vector<std::optional<MapWork>> work{
        MapWork{map_counts(0, 100'000, 6), map_counts(0, 1000, 2)},
        MapWork{map_counts(10'000, 0, 1), map_counts(10'000, 0, 1)},
        MapWork{map_counts(0, 200'000, 6), map_counts(0, 2000, 2)}};
    const DeviceCosts costs = make_map_costs();
    EXPECT_EQ(map_best(costs, rows, work, {}, .05), 1u);
    EXPECT_EQ(map_best(costs, rows, work, {1, 8, 1}, .05), 0u);
    EXPECT_EQ(map_best(costs, rows, work, {1, 8, 1}, .03), 1u); // row 0 errs too much
    EXPECT_EQ(map_best(costs, rows, work, {1, 8, 4}, .05), 1u); // raster work is too dear
    EXPECT_EQ(map_best(costs, rows, {std::nullopt, std::nullopt, std::nullopt}, {}, 1),
              std::nullopt);
    EXPECT_THAT(map_front(costs, rows, work, {}), testing::ElementsAre(1));
    EXPECT_THAT(map_front(costs, rows, work, {1, 8, 1}), testing::ElementsAre(0, 1));
}

} // namespace
