// Tests of fitted unit costs and predicted times. A fit must find known costs, predictions must
// follow from costs, and cost files are read or refused.
#include "measure/costs.hpp"
#include "measure/work.hpp"
#include "reflect/technique.hpp"
#include "report/costs.hpp"
#include "support/refusal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace {

using namespace catoptric;

WorkCounts make_work_counts(std::uint64_t rays, std::uint64_t fragments, std::uint64_t passes) {
    WorkCounts counts;
    counts[WorkKind::camera_rays] = rays;
    counts[WorkKind::fragments] = fragments;
    counts[WorkKind::passes] = passes;
    return counts;
}

constexpr WorkKind kFittedWorkKinds[] = {WorkKind::camera_rays, WorkKind::fragments,
                                         WorkKind::passes};

/// Returns made-up rows of a device on which a ray costs 100 ns, a fragment 2 ns and a pass 50 us.
/// The rows' times have random errors of at most the share `noise`.
std::vector<measure::TimedWork> draw_random_cost_samples(std::size_t count, double noise) {
    std::mt19937_64 random(7);
    const auto draw = [&](double most) { return most * double(random() >> 11) * 0x1p-53; };
    std::vector<measure::TimedWork> samples;
    for (std::size_t i = 0; i < count; ++i) {
        const WorkCounts counts = make_work_counts(
            std::uint64_t(draw(1e6)), std::uint64_t(draw(1e7)), 1 + std::uint64_t(draw(30)));
        const double ms = 1e-6 * (100 * double(*counts[WorkKind::camera_rays]) +
                                  2 * double(*counts[WorkKind::fragments]) +
                                  5e4 * double(*counts[WorkKind::passes]));
        samples.push_back(
            {"row " + std::to_string(i), counts, ms * (1 + noise * (2 * draw(1) - 1))});
    }
    return samples;
}

double unit_cost_of_kind(const measure::DeviceCosts& costs, WorkKind kind) {
    for (const measure::UnitCost& unit : costs.units)
        if (unit.kind == kind) return unit.ns;
    return 0;
}

TEST(Costs, FitRecoversTheCostsOfALinearDevice) {
    const measure::DeviceCosts costs = measure::fit_costs("d", draw_random_cost_samples(40, 0),
                                                          kFittedWorkKinds);
    EXPECT_NEAR(unit_cost_of_kind(costs, WorkKind::camera_rays), 100, 1e-3);
    EXPECT_NEAR(unit_cost_of_kind(costs, WorkKind::fragments), 2, 1e-5);
    EXPECT_NEAR(unit_cost_of_kind(costs, WorkKind::passes), 5e4, 1);
    ASSERT_TRUE(costs.fit);
    EXPECT_EQ(costs.fit->share_within(1.0001), 1);
    EXPECT_EQ(costs.origin, measure::CostOrigin::fitted);
}

TEST(Costs, FitOfNoisyTimesIsNear) {
    const measure::DeviceCosts costs = measure::fit_costs("d", draw_random_cost_samples(60, .1),
                                                          kFittedWorkKinds);
    EXPECT_NEAR(unit_cost_of_kind(costs, WorkKind::camera_rays), 100, 5);
    EXPECT_NEAR(unit_cost_of_kind(costs, WorkKind::fragments), 2, .2);
    EXPECT_EQ(costs.fit->share_within(1.2), 1);
    EXPECT_LT(costs.fit->share_within(1.01), 1);
}

TEST(Costs, NoCostIsNegative) {
    // In these samples, rows with more fragments take less time. The best cost of a fragment would
    // therefore be negative, which is not allowed.
    std::vector<measure::TimedWork> samples;
    for (std::uint64_t i = 1; i <= 8; ++i)
        samples.push_back({"row", make_work_counts(1000, 1000 * i, 1), 10.0 - double(i)});
    const measure::DeviceCosts costs = measure::fit_costs("d", samples, kFittedWorkKinds);
    for (const measure::UnitCost& unit : costs.units) EXPECT_GT(unit.ns, 0);
    EXPECT_EQ(unit_cost_of_kind(costs, WorkKind::fragments), 0);
}

TEST(Costs, RowIsPredictedByTheOtherRows) {
    std::vector<measure::TimedWork> samples = draw_random_cost_samples(20, 0);
    samples[4].ms *= 3; // the time of a row is predicted without using this time
    const measure::DeviceCosts costs = measure::fit_costs("d", samples, kFittedWorkKinds);
    EXPECT_NEAR(costs.fit->left_out_ms[4], samples[4].ms / 3, 1e-6 * samples[4].ms);
}

TEST(Costs, FitRefusesTooFewRowsAndTimesThatAreNotPositive) {
    EXPECT_EQ(test::catch_error_text(Failure::usage,
                                     [] {
                                         measure::fit_costs("d", draw_random_cost_samples(2, 0),
                                                            kFittedWorkKinds);
                                     }),
              "fitting the costs of 3 kinds of work: wanted at least as many measured rows, found "
              "2");
    std::vector<measure::TimedWork> samples = draw_random_cost_samples(9, 0);
    samples[3].ms = 0;
    EXPECT_EQ(test::catch_error_text(Failure::usage,
                                     [&] { measure::fit_costs("d", samples, kFittedWorkKinds); }),
              "row 'row 3': wanted a time above 0 ms, found 0");
}

measure::DeviceCosts make_device_costs() {
    measure::DeviceCosts costs{.device = "card", .origin = measure::CostOrigin::literature};
    costs.units = {{WorkKind::camera_rays, 10, {5, 20}, "a paper"},
                   {WorkKind::fragments, 1, {.5, 4}, "a data sheet"},
                   {WorkKind::passes, 1000, {}, ""}};
    return costs;
}

TEST(Costs, TimeIsTheSumOfCountsTimesCosts) {
    const measure::PredictedTime time = measure::predict_time(make_device_costs(),
                                                              make_work_counts(1000, 5000, 3));
    EXPECT_DOUBLE_EQ(time.ms, 1e-6 * (10 * 1000 + 5000 + 3000));
    EXPECT_DOUBLE_EQ(time.low, 1e-6 * (5 * 1000 + .5 * 5000 + 3000));
    EXPECT_DOUBLE_EQ(time.high, 1e-6 * (20 * 1000 + 4 * 5000 + 3000));
}

measure::Row make_costed_row(const std::string& technique, double flip, std::uint64_t rays,
                             std::uint64_t fragments) {
    measure::Row row;
    row.technique = row.label = technique;
    for (const reflect::Technique* known : reflect::techniques())
        if (known->name == technique) row.traits = &known->traits;
    row.error.pixels = 10, row.error.flip = flip, row.error.rmse = flip;
    measure::set_work(row, {{"pass", make_work_counts(rays, fragments, 1)}});
    return row;
}

TEST(Costs, FrontDependsOnTheCostsOfRaysAndOfOtherWork) {
    const std::vector<measure::Row> rows{make_costed_row("raytrace", 0, 1000, 0),
                                         make_costed_row("secant", .02, 0, 6000),
                                         make_costed_row("worse", .03, 0, 7000)};
    const measure::PredictedFront front = measure::predict_front(make_device_costs(), rows);
    // With the given costs, the traced frame costs 10 us and the searched frame 6 us. With cheap
    // rays and dear look-ups, they cost 5 us and 24 us.
    EXPECT_EQ(front.rows, (std::vector<std::size_t>{1, 0}));
    EXPECT_EQ(front.rows_cheap_rays, (std::vector<std::size_t>{0}));
    EXPECT_EQ(front.rows_dear_rays, (std::vector<std::size_t>{1, 0}));
}

TEST(Costs, RowWithoutCountsIsNotOnTheFront) {
    measure::Row blank;
    blank.error.pixels = 10, blank.error.flip = 0;
    const measure::PredictedFront front = measure::predict_front(
        make_device_costs(), {blank, make_costed_row("secant", .02, 0, 6000)});
    EXPECT_EQ(front.rows, (std::vector<std::size_t>{1}));
    EXPECT_TRUE(std::isnan(front.times[0].ms));
}

TEST(Costs, FileIsReadBack) {
    const measure::DeviceCosts wanted = make_device_costs();
    const measure::DeviceCosts found = report::read_device_costs(report::to_json(wanted),
                                                                 "costs.json");
    EXPECT_EQ(found.device, wanted.device);
    EXPECT_EQ(found.origin, wanted.origin);
    ASSERT_EQ(found.units.size(), wanted.units.size());
    for (std::size_t i = 0; i < found.units.size(); ++i) {
        EXPECT_EQ(found.units[i].kind, wanted.units[i].kind);
        EXPECT_EQ(found.units[i].ns, wanted.units[i].ns);
        EXPECT_EQ(found.units[i].source, wanted.units[i].source);
        EXPECT_EQ(found.units[i].range.is_known(), wanted.units[i].range.is_known());
    }
}

/// A fit states how far its predictions are off, and its file tells readers.
TEST(Costs, FileTellsTheErrorOfItsFit) {
    EXPECT_FALSE(measure::prediction_error(make_device_costs()).is_known());
    std::vector<measure::TimedWork> samples = draw_random_cost_samples(60, .1);
    const measure::DeviceCosts fitted = measure::fit_costs("d", std::move(samples),
                                                           kFittedWorkKinds);
    const measure::Interval error = measure::prediction_error(
        report::read_device_costs(report::to_json(fitted), "costs.json"));
    EXPECT_GT(error.low, .8);
    EXPECT_LT(error.low, 1);
    EXPECT_GT(error.high, 1);
    EXPECT_LT(error.high, 1.2);
}

std::string costs_error_text(const std::string& text) {
    return test::catch_error_text(Failure::bad_data,
                                  [&] { report::read_device_costs(text, "c.json"); });
}

TEST(Costs, CostMayBeLessThanANanosecond) {
    const measure::DeviceCosts costs = report::read_device_costs(
        R"({"schema": "catoptric/costs/1", "device": "d", "origin": "given",
            "costs": [{"work": "draws", "ns": 0}, {"work": "vertices", "ns": 0.25}]})",
        "c.json");
    ASSERT_EQ(costs.units.size(), 2u);
    EXPECT_EQ(costs.units[0].ns, 0);
    EXPECT_EQ(costs.units[1].ns, .25);
}

TEST(Costs, KnownCostsAreFoundByName) {
    std::vector<std::string> names;
    for (const report::KnownCosts& known : report::list_known_costs()) {
        names.push_back(known.name);
        EXPECT_FALSE(report::read_costs_file(known.name).units.empty()) << known.name;
    }
    EXPECT_TRUE(std::ranges::is_sorted(names));
    EXPECT_EQ(std::ranges::count(names, "gtx-770.times"), 0) << "times are no costs";
    EXPECT_EQ(report::read_costs_file("gtx-1080-ti").device, "GeForce GTX 1080 Ti");
    test::expect_error([] { report::read_costs_file("gtx-1080"); }, Failure::missing_input,
                       {"gtx-1080: there is no such file", "gtx-680", "did you mean 'gtx-"});
}

TEST(Costs, FolderInPlaceOfAFileIsRefused) {
    EXPECT_EQ(test::catch_error_text(Failure::bad_data, [] { report::read_costs_file("."); }),
              ".: wanted a file with costs of a device, found something else");
}

TEST(Costs, FileIsRefusedWithPlaceWantedAndFound) {
    const std::string head = R"({"schema": "catoptric/costs/1", "device": "d", "origin": "given")";
    EXPECT_EQ(
        costs_error_text("{}"),
        "c.json: schema: wanted costs of a device, schema 'catoptric/costs/1', found nothing");
    EXPECT_EQ(costs_error_text(head + "}"),
              "c.json: costs: wanted a list with at least one entry, found nothing");
    EXPECT_EQ(costs_error_text(head + R"(, "costs": [{"work": "fragment", "ns": 1}]})"),
              "c.json: costs[0].work: wanted a kind of work, found 'fragment' (did you mean "
              "'fragments'?)");
    EXPECT_EQ(costs_error_text(head + R"(, "costs": [{"work": "draws", "ns": -1}]})"),
              "c.json: costs[0].ns: wanted nanoseconds of at least 0, found '-1'");
    EXPECT_EQ(
        costs_error_text(head + R"(, "costs": [{"work": "draws", "ns": 3, "range": [4, 5]}]})"),
        "c.json: costs[0].range: wanted a range around ns, 3.000000, found a list");
    EXPECT_EQ(costs_error_text(head + R"(, "costs": [{"work": "draws", "ns": 3},
                                                 {"work": "draws", "ns": 3}]})"),
              "c.json: costs[1].work: 'draws' is given twice");
    EXPECT_EQ(
        costs_error_text(head + R"(, "costs": [{"work": "draws", "ns": 3, "rnage": [2, 4]}]})"),
        "c.json: costs[0]: wanted the members work, ns, range, source, found 'rnage'");
    EXPECT_EQ(costs_error_text(head + R"(, "note": "", "cost": []})"),
              "c.json: wanted the members schema, device, origin, note, costs, fit, found 'cost'");
    EXPECT_EQ(
        costs_error_text(R"({"schema": "catoptric/costs/1", "device": "d", "origin": "felt"})"),
        "c.json: origin: wanted fitted, literature or given, found '\"felt\"'");
}

TEST(Work, CountsOfARowAreReadBack) {
    const std::vector<PassWork> passes{{"a", make_work_counts(1, 2, 1)},
                                       {"b", make_work_counts(3, 4, 1)}};
    measure::Row row;
    EXPECT_FALSE(measure::has_counted_work(row));
    measure::set_work(row, passes);
    EXPECT_TRUE(measure::has_counted_work(row));
    EXPECT_EQ(measure::total_work(row), make_work_counts(4, 6, 2));
    EXPECT_EQ(sum_work(passes, "b"), make_work_counts(3, 4, 1));
}

} // namespace
