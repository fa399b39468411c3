// Tests which plans `choose_plan` proves, and which it chooses, from comparisons that are made up.
#include "study/choose.hpp"

#include "compare.hpp"
#include "report_sample.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;

/// A plan with its time, milliseconds, and its FLIP in each view.
struct MadeUpPlan {
    std::string text;
    double ms = 0, flip = 0;
};

/// From the surest plan to the cheapest. Neighbours differ in time by factors of 4.5, 5.2, 1.4, 1.2
/// and 1.2.
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

/// Chooses among the made-up plans. The plan `failing`, if any, has an error of 1 in the last
/// `failures` views that prove it.
app::PlanChoice choose_made_up_plan(const std::string& failing = "", std::size_t failures = 0) {
    app::ChooseRequest request;
    for (const MadeUpPlan& plan : kMadeUpPlans) request.base.techniques.push_back(plan.text);
    request.max_error = .1;
    return app::choose_plan(
        request, [&](const std::vector<std::string>& plans, int views, std::uint64_t seed, int) {
            measure::Comparison comparison;
            comparison.device.name = "made up";
            for (const std::string& text : plans) {
                const auto plan = std::ranges::find(kMadeUpPlans, text, &MadeUpPlan::text);
                measure::Row row = make_row_of_plan(*plan, static_cast<std::size_t>(views));
                if (seed == request.proof_seed && text == failing)
                    for (std::size_t i = 0; i < failures; ++i)
                        row.views[row.views.size() - 1 - i].error.flip = 1;
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

/// Without `raytrace:depth=4`, a failed proof of `hybrid` would choose a plan that takes 4.5 times
/// as long.
TEST(ChoosePlan, ProvedPlansLeaveNoLargeStepOfTimeThatAPlanCouldFill) {
    const app::PlanChoice choice = choose_made_up_plan();
    EXPECT_THAT(list_proved_texts(choice),
                testing::ElementsAre("raytrace:depth=8", "raytrace:depth=4", "hybrid", "proxy"));
    ASSERT_TRUE(choice.chosen);
    EXPECT_EQ(choice.proofs[*choice.chosen].plan.text, "proxy");
    EXPECT_EQ(choice.proofs[*choice.chosen].device, "made up");
}

TEST(ChoosePlan, PlanBeforeTheFirstFailedProofIsChosen) {
    const app::PlanChoice choice = choose_made_up_plan("hybrid", 1);
    EXPECT_THAT(list_proved_texts(choice),
                testing::ElementsAre("raytrace:depth=8", "raytrace:depth=4", "hybrid"));
    EXPECT_EQ(choice.proofs.back().failures, 1u);
    EXPECT_FALSE(choice.proofs.back().keeps_error) << "59 views prove 95 % without a failure only";
    ASSERT_TRUE(choice.chosen);
    EXPECT_EQ(choice.proofs[*choice.chosen].plan.text, "raytrace:depth=4");
}

TEST(ChoosePlan, NoPlanIsChosenIfTheSurestFails) {
    const app::PlanChoice choice = choose_made_up_plan("raytrace:depth=8", 2);
    EXPECT_FALSE(choice.chosen);
    EXPECT_THAT(choice.failure, testing::StartsWith("raytrace:depth=8 keeps the limits in the "
                                                    "training views, but not in enough of the "
                                                    "fresh ones (2 of 59 fail)"));
}

} // namespace
