// Tests which plans `choose_plan` proves, and which it chooses, from comparisons that are made up.
#include "study/choose.hpp"

#include "compare.hpp"
#include "measure/halves.hpp"
#include "report_sample.hpp"

#include <gmock/gmock.h>

#include <cmath>

namespace {

using namespace catoptric;

/// A plan with its time, milliseconds, and its FLIP in each view.
struct MadeUpPlan {
    std::string text;
    double ms = 0, flip = 0;
};

/// From the slowest plan, which errs least, to the fastest.
const std::vector<MadeUpPlan> kMadeUpPlans{{"raytrace:depth=8", 1229, .001},
                                           {"raytrace:depth=4", 272, .002},
                                           {"hybrid", 52, .003},
                                           {"pyramid", 38, .004},
                                           {"secant", 33, .005},
                                           {"proxy", 28, .006}};

measure::Row make_row_of_plan(const MadeUpPlan& plan, std::size_t views) {
    measure::Row row = report::sample::make_row(plan.text, plan.ms, plan.flip / 2, plan.flip);
    row.gpu_ms.ci95 = {.99 * plan.ms, 1.01 * plan.ms};
    measure::Errors errors;
    errors.error = report::sample::make_difference_of_errors(plan.flip / 2, plan.flip);
    row.views.assign(views, errors);
    return row;
}

/// Noise of the reference in each view.
struct MadeUpNoise {
    double floor = 0; ///< FLIP between the halves; 0: no noise
};

/// Chooses among the made-up plans. The plan `failing`, if any, has an error of 1 in the last
/// `failures` views that prove it.
app::PlanChoice choose_made_up_plan(const std::string& failing = "", std::size_t failures = 0,
                                    const MadeUpNoise& noise = {}, double limit = .1) {
    app::ChooseRequest request;
    for (const MadeUpPlan& plan : kMadeUpPlans) request.base.techniques.push_back(plan.text);
    request.max_error = limit;
    if (noise.floor > 0) request.reference = "raytrace:depth=16,rays=64,indirect=paths";
    return app::choose_plan(
        request, [&](const std::vector<std::string>& plans, int views, std::uint64_t seed, int) {
            measure::Comparison comparison;
            comparison.device.name = "made up";
            if (noise.floor > 0) {
                comparison.noise = std::make_shared<measure::ReferenceNoise>();
                comparison.noise->view_floors.assign(static_cast<std::size_t>(views), noise.floor);
            }
            for (const std::string& text : plans) {
                const auto plan = std::ranges::find(kMadeUpPlans, text, &MadeUpPlan::text);
                measure::Row row = make_row_of_plan(*plan, static_cast<std::size_t>(views));
                if (seed == request.proof_seed && text == failing)
                    for (std::size_t i = 0; i < failures; ++i)
                        row.views[row.views.size() - 1 - i].error.flip = 1;
                for (measure::Errors& view : row.views) view.error.flip_floor = noise.floor;
                comparison.rows.push_back(row);
            }
            return comparison;
        });
}

std::vector<std::string> list_proved_texts(const app::PlanChoice& choice) {
    std::vector<std::string> texts;
    for (const app::PlanProof& proof : choice.proofs) texts.push_back(proof.plan.text);
    return texts;
}

/// A limit at which the errors of the plans are 7, 13, 20, 27, 33 and 40 % of the limit.
constexpr double kNarrowLimit = .015;

/// `secant` and `proxy` are left out, because four plans are proved at most, and the proofs of
/// these two are less likely to succeed.
TEST(ChoosePlan, PlansAreProvedFromTheSlowestToTheFastest) {
    const app::PlanChoice choice = choose_made_up_plan("", 0, {}, kNarrowLimit);
    EXPECT_THAT(list_proved_texts(choice),
                testing::ElementsAre("raytrace:depth=8", "raytrace:depth=4", "hybrid", "pyramid"));
    ASSERT_TRUE(choice.chosen);
    EXPECT_EQ(choice.proofs[*choice.chosen].plan.text, "pyramid");
    EXPECT_EQ(choice.proofs[*choice.chosen].device, "made up");
}

TEST(ChoosePlan, SlowPlansAreNotProvedIfFasterOnesAreAlmostAsLikelyToHold) {
    const app::PlanChoice choice = choose_made_up_plan(); // errors of 1 to 6 % of the limit
    EXPECT_THAT(list_proved_texts(choice), testing::ElementsAre("hybrid", "pyramid", "proxy"));
    ASSERT_TRUE(choice.chosen);
    EXPECT_EQ(choice.proofs[*choice.chosen].plan.text, "proxy");
}

TEST(ChoosePlan, PlanBeforeTheFirstFailedProofIsChosen) {
    const app::PlanChoice choice = choose_made_up_plan("hybrid", 1, {}, kNarrowLimit);
    EXPECT_THAT(list_proved_texts(choice),
                testing::ElementsAre("raytrace:depth=8", "raytrace:depth=4", "hybrid"));
    EXPECT_EQ(choice.proofs.back().failures, 1u);
    EXPECT_FALSE(choice.proofs.back().keeps_error) << "59 views prove 95 % without a failure only";
    ASSERT_TRUE(choice.chosen);
    EXPECT_EQ(choice.proofs[*choice.chosen].plan.text, "raytrace:depth=4");
}

/// The noise of the reference counts as error, and the share is lowered for failures that the noise
/// may hide.
TEST(ChoosePlan, NoiseOfTheReferenceMakesACertificateStricter) {
    const app::PlanChoice clean = choose_made_up_plan(), slight = choose_made_up_plan("", 0, {.01}),
                          strong = choose_made_up_plan("", 0, {.0955});
    ASSERT_TRUE(clean.chosen && slight.chosen && strong.chosen);
    const app::PlanProof &without = clean.proofs[*clean.chosen],
                         &with = slight.proofs[*slight.chosen];
    EXPECT_FALSE(without.noise);
    EXPECT_EQ(with.plan.text, without.plan.text);
    EXPECT_EQ(with.plan.errors.size(), 59u);
    EXPECT_DOUBLE_EQ(with.plan.largest_error, without.plan.largest_error + .01);
    EXPECT_DOUBLE_EQ(with.error_bound, without.error_bound + .01);
    EXPECT_NEAR(without.share_bound, std::pow(.05, 1. / 59), 1e-12);
    EXPECT_NEAR(with.share_bound, 1 - (1 - without.share_bound) / .999, 1e-12);
    ASSERT_TRUE(with.noise);
    EXPECT_DOUBLE_EQ(with.noise->largest_floor, .01);
    EXPECT_DOUBLE_EQ(with.noise->wanted_floor.value_or(0), .02); // a fifth of the limit
    EXPECT_EQ(with.noise->views_above, 0u);
    // With a floor of .0955, plans with a FLIP above .004 exceed the limit of .1.
    EXPECT_EQ(strong.proofs[*strong.chosen].plan.text, "pyramid");
    EXPECT_EQ(strong.proofs[*strong.chosen].noise->views_above, 59u);
}

TEST(ChoosePlan, NoiseAboveTheLimitIsNamedAsTheReason) {
    const app::PlanChoice choice = choose_made_up_plan("", 0, {.2});
    EXPECT_FALSE(choice.chosen);
    EXPECT_THAT(choice.failure,
                testing::HasSubstr("; errors include the noise floor of the reference: median 0.2, "
                                   "at most 0.2, wanted 0.02 (12 views above), which more "
                                   "--reference-seconds lower"));
}

TEST(ChoosePlan, NoPlanIsChosenIfTheFirstProofFails) {
    const app::PlanChoice choice = choose_made_up_plan("raytrace:depth=8", 2, {}, kNarrowLimit);
    EXPECT_FALSE(choice.chosen);
    EXPECT_THAT(choice.failure, testing::StartsWith("raytrace:depth=8 keeps the limits in the "
                                                    "training views, but not in enough of the "
                                                    "fresh ones (2 of 59 fail)"));
}

} // namespace
