// Tests of ranking the rows of a comparison: faster rows, closer rows, ties and the front.
#include "measure/judge.hpp"
#include "unit/report_sample.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;
using measure::Order;
using report::sample::make_row;
using report::sample::make_time_samples;

/// Returns whether row a beats row b in a comparison in which times differ, so that the two rows
/// alone decide.
bool beats(const measure::Row& a, const measure::Row& b) {
    return measure::RowJudge({make_row("one", 1, 1, 1), make_row("two", 2, 1, 1), a, b})
        .beats(a, b);
}

bool is_faster(const measure::Row& a, const measure::Row& b) {
    return measure::compare_times(a, b) == Order::less;
}

TEST(Judge, RowsOfAMovingSceneAreRankedByWholeFrameTime) {
    measure::Row a = make_row("a", 1, .1, .1), b = make_row("b", 2, .1, .2);
    a.frame_ms = make_time_samples(9), b.frame_ms = make_time_samples(3);
    EXPECT_TRUE(is_faster(a, b));
    EXPECT_TRUE(beats(a, b));
    a.moves = b.moves = true;
    EXPECT_TRUE(is_faster(b, a)) << "the host's work counts";
    EXPECT_FALSE(beats(a, b)) << "it is closer, and slower";
    EXPECT_EQ(measure::find_pareto_front({a, b}), (std::vector<std::size_t>{1, 0}));
}

using Front = std::vector<std::size_t>;

/// make_row_with_equal_times() builds a row with the same time in all rounds.
/// make_row_with_varying_time() builds a row whose time varies by a tenth.
measure::Row make_row_with_equal_times(double ms, double flip) {
    return make_row("row", ms, flip, flip);
}
measure::Row make_row_with_varying_time(double ms, double flip) {
    measure::Row made = make_row_with_equal_times(ms, flip);
    made.gpu_ms = make_time_samples(ms, .1);
    return made;
}

TEST(Judge, FrontEqualsHandComputedFronts) {
    EXPECT_EQ(measure::find_pareto_front(
                  {make_row_with_equal_times(3, 1), make_row_with_equal_times(1, 3),
                   make_row_with_equal_times(2, 2), make_row_with_equal_times(3, 3),
                   make_row_with_equal_times(2, 2.5)}),
              (Front{1, 2, 0}));
    EXPECT_EQ(measure::find_pareto_front({make_row_with_equal_times(5, 5)}), Front{0});
    EXPECT_EQ(measure::find_pareto_front({}), Front{});
    // Of rows with equal times, the row with less error is on the front.
    EXPECT_EQ(measure::find_pareto_front(
                  {make_row_with_equal_times(1, 2), make_row_with_equal_times(1, 1)}),
              Front{1});
    EXPECT_EQ(measure::find_pareto_front(
                  {make_row_with_equal_times(2, 1), make_row_with_equal_times(1, 1)}),
              Front{1}); // if two rows have equal errors, the faster row is on the front
    EXPECT_EQ(measure::find_pareto_front({make_row_with_equal_times(1, 1),
                                          make_row_with_equal_times(2, 2),
                                          make_row_with_equal_times(1, 1)}),
              (Front{0, 2}));
}

/// A row with black mirrors cannot be the fastest row, and cannot be on the front either.
TEST(Judge, RowsWithBlackMirrorsAreNotOnTheFrontAndBeatNoRow) {
    measure::Row black = make_row_with_equal_times(1, .5);
    EXPECT_EQ(measure::find_pareto_front(
                  {black, make_row_with_equal_times(2, .1), make_row_with_equal_times(3, .6)}),
              (Front{0, 1}));
    black.mirrors_black = true;
    EXPECT_EQ(measure::find_pareto_front(
                  {black, make_row_with_equal_times(2, .1), make_row_with_equal_times(3, .6)}),
              Front{1});
    EXPECT_FALSE(beats(black, make_row_with_equal_times(3, .6)));
    EXPECT_FALSE(beats(make_row_with_equal_times(1, .1), black));
    measure::Comparison made;
    made.rows = {black, make_row_with_equal_times(2, .1)};
    made.pareto = measure::find_pareto_front(made.rows);
    EXPECT_EQ(measure::find_closest_row(made), &made.rows[1]);
    EXPECT_EQ(measure::find_fastest_rows(made).rows,
              std::vector<const measure::Row*>{&made.rows[1]});
    ASSERT_EQ(measure::rank_rows(made).black.size(), 1U);
    EXPECT_TRUE(measure::rank_rows(made).beaten_by_beaten.empty());
}

/// A row whose picture comes from a file can be the row with the least error, but has no place in
/// the order of time.
TEST(Judge, RowsWithoutATimeTakeNoPlaceFromOthers) {
    measure::Comparison made;
    measure::Row file = make_row_with_equal_times(1, .01);
    file.label = "file";
    file.gpu_ms = {};
    file.gpu_ms.median = NAN;
    made.rows = {make_row_with_equal_times(2, .1), file, make_row_with_equal_times(3, .05)};
    made.pareto = measure::find_pareto_front(made.rows);
    EXPECT_EQ(made.pareto, (Front{0, 2}));
    EXPECT_EQ(measure::find_rank_range(made, made.rows[2]).last, 2u);
    EXPECT_EQ(measure::find_rank_range(made, made.rows[1]).first, 0u);
    EXPECT_EQ(measure::find_fastest_rows(made).rows,
              std::vector<const measure::Row*>{&made.rows[0]});
    EXPECT_EQ(measure::find_closest_row(made), &made.rows[1]);
    const measure::RowRanking ranking = measure::rank_rows(made);
    EXPECT_EQ(ranking.untimed, std::vector<const measure::Row*>{&made.rows[1]});
    EXPECT_TRUE(ranking.beaten_by_beaten.empty());
    EXPECT_EQ(measure::find_ray_tracing_verdict(made).others(), 2u);
}

TEST(Judge, RowsDifferInTimeOnlyIfEveryRoundAgrees) {
    EXPECT_TRUE(is_faster(make_row_with_equal_times(10, 1), make_row_with_varying_time(12, 1)))
        << "10.8 at least";
    EXPECT_FALSE(is_faster(make_row_with_equal_times(10, 1), make_row_with_varying_time(11, 1)))
        << "9.9 in three rounds";
    EXPECT_FALSE(is_faster(make_row_with_varying_time(11, 1), make_row_with_equal_times(10, 1)));
    EXPECT_EQ(
        measure::compare_times(make_row_with_equal_times(10, 1), make_row_with_varying_time(11, 1)),
        Order::unknown);
    EXPECT_EQ(
        measure::compare_times(make_row_with_equal_times(10, 1), make_row_with_equal_times(10, 1)),
        Order::equal);
    // The same rounds are slow for both rows. Rows are compared round by round, so a slow moment of
    // the machine does not hide the difference.
    EXPECT_TRUE(is_faster(make_row_with_varying_time(10, 1), make_row_with_varying_time(10.6, 1)));
    EXPECT_NEAR(measure::time_ratio_interval(make_row_with_varying_time(10.5, 1),
                                             make_row_with_varying_time(10, 1))
                    .low,
                1.05, 1e-12);

    EXPECT_TRUE(beats(make_row_with_equal_times(10, 1), make_row_with_varying_time(12, 1)));
    EXPECT_FALSE(beats(make_row_with_equal_times(10, 1), make_row_with_varying_time(11, 1)));
    EXPECT_FALSE(beats(make_row_with_varying_time(11, .9), make_row_with_equal_times(10, 1)))
        << "closer, but whether it takes as long cannot be told";
    EXPECT_TRUE(beats(make_row_with_varying_time(10.4, .9), make_row_with_varying_time(10, 1)))
        << "closer, and equal in time";
    EXPECT_FALSE(beats(make_row_with_varying_time(12, .9), make_row_with_equal_times(10, 1)))
        << "closer, but slower";
    EXPECT_FALSE(beats(make_row_with_equal_times(10, 1.1), make_row_with_varying_time(12, 1)));
    EXPECT_EQ(measure::find_pareto_front(
                  {make_row_with_varying_time(11, 1), make_row_with_equal_times(10, 1)}),
              (Front{1, 0}));
    EXPECT_EQ(measure::find_pareto_front({make_row_with_equal_times(10, 1),
                                          make_row_with_equal_times(10.4, .9),
                                          make_row_with_equal_times(12, .9)}),
              Front{1});
}

TEST(Judge, CloserRowHasLessFlipOverMirrorsOrOverAllDrawnViews) {
    measure::Row a = make_row_with_equal_times(1, .1), b = make_row_with_equal_times(1, .2);
    // Other metrics do not decide which row is closer.
    a.error.rmse = a.error_all.flip = .5;
    EXPECT_EQ(measure::compare_flip(a, b), Order::less);
    EXPECT_EQ(measure::compare_flip(b, a), Order::more);
    EXPECT_TRUE(beats(a, b));
    // With six drawn views, b is closer in only four, so neither row counts as closer.
    for (int view = 0; view < 6; ++view) {
        a.views.push_back(a), b.views.push_back(b);
        if (view < 4) std::swap(a.views.back().error.flip, b.views.back().error.flip);
    }
    EXPECT_EQ(measure::compare_flip(a, b), Order::unknown);
    EXPECT_EQ(measure::compare_flip(b, a), Order::unknown);
    EXPECT_EQ(measure::find_pareto_front({a, b}), (Front{0, 1}));
    for (measure::Errors& view : a.views) view.error.flip = .3;
    EXPECT_EQ(measure::compare_flip(b, a), Order::less) << "in every view";
    EXPECT_EQ(measure::find_pareto_front({a, b}), (Front{1}));
}

TEST(Judge, RowsWithFewerThanSixRoundsTie) {
    measure::Row a = make_row_with_equal_times(1, 1), b = make_row_with_equal_times(9, 1);
    ASSERT_TRUE(is_faster(a, b));
    b.gpu_ms.rounds.pop_back();
    EXPECT_FALSE(measure::time_ratio_interval(a, b).is_known());
    EXPECT_EQ(measure::compare_times(a, b), Order::unknown);
    EXPECT_EQ(measure::find_pareto_front({a, b}), (Front{0, 1}));
}

TEST(Judge, FailedRowsAreNotOnTheFrontAndBeatNoRow) {
    measure::Row failed = make_row_with_equal_times(1, 0),
                 no_time = make_row_with_equal_times(0, 0),
                 no_error = make_row_with_equal_times(1, 0);
    failed.error.nonfinite = 1;
    no_error.error.rmse = no_error.error.flip = measure::Difference::kNone;
    EXPECT_EQ(
        measure::find_pareto_front({failed, no_time, no_error, make_row_with_equal_times(5, 5)}),
        Front{3});
    EXPECT_FALSE(beats(make_row_with_equal_times(1, 1), no_error));
}

TEST(Judge, TiedRowsShareTheirPlaces) {
    const measure::Comparison made = report::sample::make_comparison(
        {make_row_with_equal_times(10, 1), make_row_with_varying_time(11, 1),
         make_row_with_equal_times(5, 1), make_row_with_equal_times(30, 1)});
    const auto places = [&](std::size_t i) {
        const measure::RankRange found = measure::find_rank_range(made, made.rows[i]);
        return std::pair(found.first, found.last);
    };
    EXPECT_EQ(places(0), (std::pair<std::size_t, std::size_t>(2, 3)));
    EXPECT_EQ(places(1), (std::pair<std::size_t, std::size_t>(2, 3)));
    EXPECT_EQ(places(2), (std::pair<std::size_t, std::size_t>(1, 1)));
    EXPECT_EQ(places(3), (std::pair<std::size_t, std::size_t>(4, 4)));
}

} // namespace
