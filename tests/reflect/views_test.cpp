// Tests of the errors that a comparison measures over drawn views.
#include "compare.hpp"
#include "measure/light_edges.hpp"
#include "measure/views.hpp"
#include "report/comparison.hpp"
#include "support/rendering.hpp"

#include <gmock/gmock.h>

#include <atomic>

namespace {

using namespace catoptric;

study::CompareRequest make_views_request(const std::vector<std::string>& rows) {
    study::CompareRequest request;
    request.base = test::make_test_request(test::make_lit_room(2, 1), rows, {32, 32});
    request.studies = {{"views", 6}};
    return request;
}

/// As in a single view, a row that equals the reference at its own sample count must have no error
/// in any view.
TEST(ComparedViews, RowIsComparedAtItsOwnSampleCount) {
    const report::Comparison found = study::compare(
        test::get_test_engine(), make_views_request({"raytrace:depth=16,samples=4",
                                                     "raytrace:depth=16", "raytrace:depth=0"}));
    ASSERT_EQ(found.rows.size(), 3u);
    for (const report::Row& row : found.rows) {
        ASSERT_EQ(row.views.size(), 6u) << row.label;
        for (const measure::Errors& errors : row.views) {
            EXPECT_GT(errors.error.pixels, 0u);
            EXPECT_EQ(errors.error.pixels,
                      errors.error_first_order.pixels + errors.error_mirror_in_mirror.pixels);
            EXPECT_EQ(errors.error_per_mirror.size(), 2u);
            if (row.is_reference)
                EXPECT_EQ(errors.error_all.rmse, 0) << row.label;
            else
                EXPECT_GT(errors.error.flip, 0) << row.label;
        }
    }
    EXPECT_TRUE(found.rows[0].is_reference);
    EXPECT_TRUE(found.complete);
}

TEST(ComparedViews, FinishedViewsAreKeptWhenStopped) {
    study::CompareRequest request = make_views_request({"naive:bounces=0", "reuse:face=32"});
    std::atomic<int> signal{0};
    request.watcher.stop = &signal;
    std::vector<std::string> labels;
    request.watcher.on_row = [&](const std::string& label, std::size_t index, std::size_t count) {
        labels.push_back(label);
        EXPECT_LT(index, count);
        if (label == "view 3 of 6: reuse:face=32") signal = 2;
    };
    // Numbers of known views of the first row, noted each time a row is finished.
    std::vector<std::size_t> known;
    request.on_finished_row = [&](const report::Comparison& so_far) {
        EXPECT_FALSE(so_far.complete);
        known.push_back(so_far.rows.front().views.size());
    };
    const report::Comparison found = study::compare(test::get_test_engine(), request);
    EXPECT_THAT(labels,
                testing::IsSupersetOf({"view 1 of 6: reference", "view 2 of 6: naive:bounces=0",
                                       "view 3 of 6: reuse:face=32"}));
    EXPECT_THAT(known, testing::ElementsAre(0, 0, 1, 2));
    ASSERT_TRUE(found.stopped);
    EXPECT_EQ(found.stopped->failure, Failure::interrupted);
    EXPECT_FALSE(found.complete);
    ASSERT_EQ(found.rows.size(), 2u);
    EXPECT_EQ(found.rows[0].views.size(), 3u);
    EXPECT_EQ(found.rows[1].views.size(), 2u);
    for (const report::Row& row : found.rows) {
        ASSERT_TRUE(row.worst);
        EXPECT_LT(row.worst->view, row.views.size());
        EXPECT_EQ(row.worst->display.width, 32 + 4 + 32);
    }
}

/// Every row that reads captures must report its error at light edges: the error of mirror pixels
/// that looked within one texel of a lamp's outline. Rows report this error with and without
/// `--causes`, and also for plans whose cube maps have different edge lengths.
TEST(ComparedLightEdges, EveryRowThatReadsCapturesHasLightEdges) {
    study::CompareRequest request = make_views_request(
        {"secant:face=16", "secant:face=auto", "naive:bounces=0",
         "1=secant:face=64 2=secant:face=16", "secant:face=64"});
    request.base.size = {96, 96};
    request.studies.clear();
    const report::Comparison found = study::compare(test::get_test_engine(), request);
    ASSERT_EQ(found.rows.size(), 5u);
    for (const report::Row& row : found.rows) {
        EXPECT_EQ(row.light_edges == nullptr, row.lookup == nullptr) << row.label;
        if (!row.light_edges) continue;
        const measure::LightEdgeErrors& edges = *row.light_edges;
        const double whole = row.error.rmse * row.error.rmse;
        EXPECT_NEAR(edges.rmse * edges.rmse + edges.rest_rmse * edges.rest_rmse, whole,
                    1e-12 * whole)
            << row.label;
        EXPECT_GT(edges.pixels, 0) << row.label;
        EXPECT_LT(edges.pixels, .5) << row.label;
        EXPECT_GT(edges.share, 0) << row.label;
    }
    EXPECT_FALSE(found.rows[2].light_edges);
    ASSERT_TRUE(found.rows[0].light_edges && found.rows[1].light_edges &&
                found.rows[3].light_edges && found.rows[4].light_edges);
    // Larger texels put more pixels within a texel of a light edge. The plan has one mirror with
    // large texels and one with small texels.
    EXPECT_GT(found.rows[0].light_edges->pixels, found.rows[3].light_edges->pixels);
    EXPECT_GT(found.rows[3].light_edges->pixels, found.rows[4].light_edges->pixels);
}

} // namespace
