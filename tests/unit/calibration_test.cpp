// Tests of calibrations: a fit to few rows that starts from the costs of a similar device, and the
// user's file from which engines read it.
#include "measure/balance.hpp"
#include "measure/calibration.hpp"
#include "measure/least_squares.hpp"
#include "report/costs.hpp"
#include "session/calibration.hpp"
#include "session/profile.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <random>

namespace {

using namespace catoptric;
using testing::HasSubstr;

TEST(LeastSquares, SolutionHasNoNegativeValueAndForgetsARemovedEquation) {
    measure::LeastSquares equations(2);
    equations.add(std::vector{1.0, 0.0}, 3);
    equations.add(std::vector{0.0, 2.0}, -4); // its best value would be -2
    EXPECT_THAT(equations.solve(), testing::ElementsAre(testing::DoubleNear(3, 1e-9), 0));
    equations.add(std::vector{1.0, 1.0}, 100);
    equations.add(std::vector{1.0, 1.0}, 100, -1);
    EXPECT_THAT(equations.solve(), testing::ElementsAre(testing::DoubleNear(3, 1e-9), 0));
}

constexpr WorkKind kKinds[] = {WorkKind::mirror_rays, WorkKind::node_lanes, WorkKind::colour_lanes,
                               WorkKind::materials,   WorkKind::fragments,  WorkKind::bytes,
                               WorkKind::frames,      WorkKind::draws};
constexpr double kTypicalNs[] = {30, 33, 276, 37, 1.4, .025, 8e5, 9e4};

measure::DeviceCosts make_typical_costs() {
    measure::DeviceCosts costs{.device = "typical"};
    for (std::size_t i = 0; i < std::size(kKinds); ++i)
        costs.units.push_back({kKinds[i], kTypicalNs[i], {}, ""});
    return costs;
}

/// Returns rows of a device whose costs are `factors` times the typical ones. Random counts take
/// about a millisecond of each kind; times are wrong by at most the share `noise`.
std::vector<measure::TimedWork> draw_rows(std::size_t count, std::span<const double> factors,
                                          double noise, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto draw = [&] { return double(random() >> 11) * 0x1p-53; };
    std::vector<measure::TimedWork> rows;
    for (std::size_t row = 0; row < count; ++row) {
        measure::TimedWork& one = rows.emplace_back();
        one.name = "row " + std::to_string(row);
        for (std::size_t i = 0; i < std::size(kKinds); ++i) {
            const auto units = static_cast<std::uint64_t>(1 + draw() * 2e6 / kTypicalNs[i]);
            one.counts[kKinds[i]] = units;
            one.ms += double(units) * kTypicalNs[i] * factors[i] * 1e-6;
        }
        one.ms *= 1 + noise * (2 * draw() - 1);
    }
    return rows;
}

double find_ns(const measure::DeviceCosts& costs, WorkKind kind) {
    for (const measure::UnitCost& unit : costs.units)
        if (unit.kind == kind) return unit.ns;
    return 0;
}

TEST(Calibration, GroupsOfKindsScaleBetweenDevices) {
    // Rays take a tenth, shading twice, raster work four times, commands half of the typical time.
    const std::vector<double> factors{.1, .1, 2, 2, 4, 4, .5, .5};
    const measure::DeviceCosts costs = measure::calibrate_costs("d", draw_rows(12, factors, 0, 3),
                                                                make_typical_costs());
    for (std::size_t i = 0; i < std::size(kKinds); ++i)
        EXPECT_NEAR(find_ns(costs, kKinds[i]) / kTypicalNs[i], factors[i], .05 * factors[i])
            << kWorkKinds[static_cast<std::size_t>(kKinds[i])].name;
    EXPECT_EQ(costs.origin, measure::CostOrigin::fitted);
    EXPECT_EQ(costs.fit->share_within(1.05), 1);
}

TEST(Calibration, KindsOfAGroupMayDifferIfTheRowsSaySo) {
    const std::vector<double> factors{1, 1, 1, 6, 1, 1, 1, 1};
    const measure::DeviceCosts costs = measure::calibrate_costs("d", draw_rows(40, factors, 0, 4),
                                                                make_typical_costs());
    EXPECT_NEAR(find_ns(costs, WorkKind::materials) / 37, 6, .5);
    EXPECT_NEAR(find_ns(costs, WorkKind::colour_lanes) / 276, 1, .2);
}

TEST(Calibration, KindThatNoRowHasKeepsTheScaleOfItsGroup) {
    const std::vector<double> factors(std::size(kKinds), 3);
    std::vector<measure::TimedWork> rows = draw_rows(12, factors, 0, 5);
    for (measure::TimedWork& row : rows) {
        row.ms -= double(*row.counts[WorkKind::bytes]) * .025 * 3 * 1e-6;
        row.counts[WorkKind::bytes] = 0;
    }
    const measure::DeviceCosts costs = measure::calibrate_costs("d", rows, make_typical_costs());
    EXPECT_NEAR(find_ns(costs, WorkKind::bytes) / .025, 3, .1);
}

/// With few noisy rows, a fit that starts from a similar device predicts other rows better than a
/// fit that starts from nothing.
TEST(Calibration, FewNoisyRowsPredictOthersBetterThanAFreeFit) {
    const std::vector<double> factors{.3, .4, 1.5, 2.2, .8, .7, 1.1, 1.4};
    double calibrated = 0, free = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        const std::vector<measure::TimedWork> rows = draw_rows(10, factors, .25, seed);
        const measure::DeviceCosts with = measure::calibrate_costs("d", rows, make_typical_costs()),
                                   without = measure::fit_costs("d", rows, kKinds);
        for (const measure::TimedWork& row : draw_rows(40, factors, 0, 100 + seed)) {
            const auto error = [&](const measure::DeviceCosts& costs) {
                return std::abs(std::log(measure::predict_time(costs, row.counts).ms / row.ms));
            };
            calibrated += error(with), free += error(without);
        }
    }
    EXPECT_LT(calibrated, .8 * free);
}

TEST(Calibration, TooFewRowsAndTimesThatAreNotPositiveAreRefused) {
    const std::vector<double> factors(std::size(kKinds), 1);
    std::vector<measure::TimedWork> rows = draw_rows(7, factors, 0, 1);
    const auto calibrate = [&] { measure::calibrate_costs("d", rows, make_typical_costs()); };
    EXPECT_EQ(test::catch_error_text(Failure::usage, calibrate),
              "calibrating a device: wanted at least 8 measured rows, found 7");
    rows = draw_rows(8, factors, 0, 1);
    rows[2].ms = -1;
    EXPECT_EQ(test::catch_error_text(Failure::usage, calibrate),
              "row 'row 2': wanted a time above 0 ms, found -1");
}

measure::DeviceCosts make_costs(std::vector<std::pair<WorkKind, double>> units) {
    measure::DeviceCosts costs;
    for (const auto& [kind, ns] : units) costs.units.push_back({kind, ns, {}, ""});
    return costs;
}

TEST(Balance, LookupsAreComparedWithRaysAndWithCardsForGames) {
    using enum WorkKind;
    const auto processor = measure::find_balance(make_costs({{mirror_rays, 50},
                                                             {node_lanes, 10},
                                                             {colour_lanes, 275},
                                                             {fragments, 2},
                                                             {bytes, .05}}),
                                                 8);
    ASSERT_TRUE(processor);
    EXPECT_DOUBLE_EQ(processor->rays_per_lookup(), 275 / (8 * 50 + 15 * 10.));
    EXPECT_EQ(
        measure::describe_balance(*processor),
        "per second 3.64 M look-ups of subgroups, 1.82 M rays of 15 nodes of subgroups, 500 M "
        "fragments, 20 G bytes; a look-up takes as long as 0.5 rays, unlike cards that games "
        "run on (0.001 to 0.1), so that this device's order of rows need not be theirs");
    const auto card = measure::find_balance(make_costs({{mirror_rays, 1}, {colour_lookups, .005}}));
    EXPECT_EQ(
        measure::describe_balance(*card),
        "per second 200 G look-ups, 1 G rays of 15 nodes, unknown fragments, unknown bytes; a "
        "look-up takes as long as 0.005 rays, as on cards that games run on (0.001 to 0.1)");
    EXPECT_FALSE(measure::find_balance(make_costs({{colour_lookups, .005}})));
    EXPECT_FALSE(measure::find_balance(make_costs({{mirror_rays, 1}})));
}

TEST(Balance, ShippedCostsSayWhichDevicesAreUnlikeCardsForGames) {
    for (const auto& [name, is_usual] : {std::pair{"gtx-680", true},
                                         {"gtx-1080-ti", true},
                                         {"rtx-2080-ti", true},
                                         {"h200", false},
                                         {"llvmpipe-22.3", false}}) {
        const double rays =
            measure::find_balance(report::read_costs_file(name), 8)->rays_per_lookup();
        EXPECT_EQ(rays < measure::kGameCardBalance.high, is_usual) << name << ": " << rays;
        EXPECT_GT(rays, measure::kGameCardBalance.low) << name;
    }
}

class CalibrationFileTest : public test::InFolder {
protected:
    session::DeviceInfo device{
        .name = "A device", .driver = "driver 1", .type = "cpu", .id = "10de-2330"};
    void write_calibration(const std::string& name) {
        measure::DeviceCosts costs{.device = name, .origin = measure::CostOrigin::fitted};
        costs.units = {{WorkKind::fragments, 1234, {}, "calibration"}};
        write_text(report::to_json(costs));
    }
    void write_text(const std::string& text) {
        std::ofstream(folder / session::profile_file_name(device)) << text;
    }
};

TEST_F(CalibrationFileTest, EngineComparesPlansByTheDevicesOwnCosts) {
    EXPECT_EQ(session::choose_unit_costs(folder, device).costs.file, "llvmpipe-22.3");
    EXPECT_EQ(device.calibration + device.warning, "") << "there is none";
    write_calibration("A device, driver 1");
    const require::DeviceUnitCosts costs = session::choose_unit_costs(folder, device);
    EXPECT_EQ(costs.costs.ns[WorkKind::fragments], 1234);
    EXPECT_EQ(costs.costs.ns[WorkKind::draws], 0);
    EXPECT_EQ(costs.note, "calibration of this device");
    EXPECT_EQ(device.calibration, session::profile_file_name(device));
    EXPECT_EQ(device.warning, "");
}

TEST_F(CalibrationFileTest, FileOfAnotherDeviceOrABrokenOneGivesAWarning) {
    const std::string file = (folder / session::profile_file_name(device)).string();
    const auto expect_warning = [&](const std::string& start) {
        device.warning.clear(), device.calibration.clear();
        EXPECT_EQ(session::choose_unit_costs(folder, device).costs.file, "llvmpipe-22.3");
        EXPECT_EQ(device.calibration, "");
        EXPECT_THAT(device.warning, testing::StartsWith(file + ": " + start));
        EXPECT_THAT(device.warning, HasSubstr("'bench --calibrate' writes a new calibration"));
    };
    write_calibration("A device, driver 2");
    expect_warning("is another device's or driver's calibration: wanted 'A device, driver 1', "
                   "found 'A device, driver 2'");
    write_text("{");
    expect_warning("");
    write_text("{}");
    expect_warning("schema: wanted ");
    device.warning = "the profile is broken";
    session::choose_unit_costs(folder, device);
    EXPECT_THAT(device.warning, testing::StartsWith("the profile is broken; " + file));
}

} // namespace
