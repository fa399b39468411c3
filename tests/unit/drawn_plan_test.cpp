// Tests of the text of the plan that `auto` drew.
#include "study/choose_judge.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

PlanEntry drawn_entry(std::uint32_t mirror, const std::string& technique, const char* face = "") {
    PlanEntry entry{mirror, "", technique, {}, ""};
    if (*face != '\0') entry.settings.push_back({"face", face, std::nullopt, true});
    entry.settings.push_back({"taps", "8", std::nullopt, false});
    return entry;
}

TEST(DrawnPlan, OneTechniqueStandsAloneAndSeveralNameTheirMirrors) {
    EXPECT_EQ(study::describe_drawn_plan({drawn_entry(1, "raytrace"), drawn_entry(2, "raytrace")}),
              "raytrace");
    EXPECT_EQ(study::describe_drawn_plan({drawn_entry(1, "secant", "64"), drawn_entry(2, "planar"),
                                          drawn_entry(3, "secant", "64")}),
              "1,3=secant:face=64 2=planar");
    EXPECT_EQ(
        study::describe_drawn_plan({drawn_entry(1, "secant", "64"), drawn_entry(2, "secant")}),
        "1=secant:face=64 2=secant");
    EXPECT_EQ(study::describe_drawn_plan({}), "");
}

} // namespace
