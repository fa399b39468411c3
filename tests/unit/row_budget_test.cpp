// Tests of finding the best row within a budget of time or error, and of the sentence that names
// this row.
#include "measure/budget.hpp"

#include "report/tables.hpp"
#include "unit/report_sample.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

using namespace catoptric;
using report::sample::make_row;
using report::sample::make_time_samples;
using testing::HasSubstr;

/// Returns rows in order from fast rows with large error to slow rows with small error, and a row
/// with black mirrors.
measure::Comparison make_rows_of_rising_quality() {
    measure::Comparison made;
    made.device.name = "card";
    made.rows = {make_row("black", 1, .5, .4), make_row("fast", 3, .2, .2),
                 make_row("middle", 5, .1, .1), make_row("slow", 9, .01, .01)};
    made.rows[0].mirrors_black = true;
    return made;
}

std::string label_of_row_or_none(const measure::Row* found) {
    return found == nullptr ? "" : found->label;
}

std::string label_of_best_row_within_budget(double max_ms, double max_flip) {
    measure::Comparison made = make_rows_of_rising_quality();
    made.max_ms = max_ms, made.max_flip = max_flip;
    return label_of_row_or_none(measure::find_best_rows(made).row);
}

TEST(RowBudget, TimeBudgetChoosesTheClosestRowInTime) {
    EXPECT_EQ(label_of_best_row_within_budget(4, NAN), "fast");
    EXPECT_EQ(label_of_best_row_within_budget(5, NAN), "middle");
    EXPECT_EQ(label_of_best_row_within_budget(100, NAN), "slow");
    EXPECT_EQ(label_of_best_row_within_budget(2, NAN), "")
        << "rows with black mirrors do not count";
}

TEST(RowBudget, ErrorBudgetChoosesTheFastestRowThatIsCloseEnough) {
    EXPECT_EQ(label_of_best_row_within_budget(NAN, .15), "middle");
    EXPECT_EQ(label_of_best_row_within_budget(NAN, .1), "middle");
    EXPECT_EQ(label_of_best_row_within_budget(NAN, .3), "fast");
    EXPECT_EQ(label_of_best_row_within_budget(NAN, .001), "");
}

TEST(RowBudget, BudgetOfRmseChoosesTheFastestRowThatIsCloseEnough) {
    measure::Comparison made = make_rows_of_rising_quality();
    for (measure::Row& row : made.rows) row.error.rmse = .1;
    made.rows[3].error.rmse = .02; // the slow row
    made.max_rmse = .05;
    EXPECT_EQ(label_of_row_or_none(measure::find_best_rows(made).row), "slow");
    EXPECT_THAT(report::describe_budget(made), HasSubstr("Within rmse 0.05 on card: slow"));
    made.max_flip = .15, made.max_rmse = .1;
    EXPECT_EQ(label_of_row_or_none(measure::find_best_rows(made).row), "middle")
        << "the fast row keeps rmse alone";
    made.rows[1].error.rmse = .03, made.max_flip = NAN, made.max_rmse = .01;
    const measure::BestRows none = measure::find_best_rows(made);
    EXPECT_EQ(none.row, nullptr);
    EXPECT_EQ(label_of_row_or_none(none.nearest), "slow") << "the closest by rmse";
}

TEST(RowBudget, BothBudgetsChooseTheFastestRowThatKeepsBoth) {
    EXPECT_EQ(label_of_best_row_within_budget(10, .15), "middle");
    EXPECT_EQ(label_of_best_row_within_budget(4, .15), "");
    EXPECT_EQ(label_of_best_row_within_budget(10, .01), "slow");
}

TEST(RowBudget, RowOnTheLimitOfTimeIsUndecided) {
    measure::Comparison made = make_rows_of_rising_quality();
    made.rows[2].gpu_ms = make_time_samples(5, .1); // rounds from 4.5 to 5.5 ms
    made.max_ms = 5.2;
    const measure::BestRows found = measure::find_best_rows(made);
    EXPECT_EQ(label_of_row_or_none(found.row), "fast");
    ASSERT_EQ(found.undecided.size(), 1u);
    EXPECT_EQ(label_of_row_or_none(found.undecided[0]), "middle");
    made.max_flip = .05;
    EXPECT_TRUE(measure::find_best_rows(made).undecided.empty()) << "too far off";
}

TEST(RowBudget, RowsThatCannotBeToldApartAreNamed) {
    measure::Comparison made = make_rows_of_rising_quality();
    made.rows.push_back(make_row("other", 5, .1, .1)); // this row is the faster one in every second
                                                       // round
    made.rows[2].gpu_ms = make_time_samples(5, .1), made.rows[4].gpu_ms = make_time_samples(5, -.1);
    made.max_flip = .15;
    const measure::BestRows found = measure::find_best_rows(made);
    EXPECT_EQ(label_of_row_or_none(found.row), "middle");
    EXPECT_TRUE(found.equal.empty());
    ASSERT_EQ(found.open.size(), 1u);
    EXPECT_EQ(label_of_row_or_none(found.open[0]), "other");
    EXPECT_EQ(report::describe_budget(made),
              "Within FLIP 0.15 on card: cannot tell which of 2 rows has the least time: middle "
              "(5.00 ms [4.50 - 5.50], FLIP 0.1000); other (5.00 ms [5.50 - 4.50], FLIP 0.1000).");
    // With too few frames for an interval, the sentence says what to do.
    made.frames = 2;
    for (const std::size_t i : {2, 4})
        made.rows[i].gpu_ms.ci95 = {}, made.rows[i].gpu_ms.rounds = {};
    EXPECT_THAT(report::describe_budget(made),
                testing::EndsWith("Times have no interval after 2 frames: wanted --frames 6 or "
                                  "more."));
}

TEST(RowBudget, FailedRowsAreNeverChosen) {
    measure::Comparison made = make_rows_of_rising_quality();
    made.rows[3].error.nonfinite = 1;
    made.max_flip = .05;
    EXPECT_EQ(measure::find_best_rows(made).row, nullptr);
}

TEST(RowBudget, SentenceNamesRowDeviceAndWhatComesNearest) {
    measure::Comparison made = make_rows_of_rising_quality();
    EXPECT_EQ(report::describe_budget(made), "");
    made.max_ms = 6;
    EXPECT_EQ(report::describe_budget(made),
              "Within 6 ms on card: middle (5.00 ms [5.00 - 5.00], FLIP 0.1000) has the least "
              "FLIP.");
    made.max_flip = .05;
    EXPECT_THAT(report::describe_budget(made),
                HasSubstr("No row keeps 6 ms and FLIP 0.05 on card. The closest row within the "
                          "time is middle (5.00 ms"));
    made.max_ms = 2;
    EXPECT_THAT(report::describe_budget(made),
                HasSubstr("The row with the least median time is fast (3.00 ms"));
    made.max_ms = NAN, made.max_flip = .001;
    EXPECT_THAT(report::describe_budget(made),
                HasSubstr("No row keeps FLIP 0.001 on card. The closest row is slow (9.00 ms"));
    made.rows.clear();
    EXPECT_THAT(report::describe_budget(made), HasSubstr("no row could be judged"));
}

} // namespace
