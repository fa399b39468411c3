#include "measure/lag.hpp"
#include "measure/settling.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace catoptric::measure {
namespace {

std::optional<int> find_settled_frame_of_errors(const std::vector<double>& errors) {
    return find_settled_frame(errors, 0.5);
}

TEST(Settling, SettledFrameIsTheFirstAfterWhichErrorsStayInBounds) {
    EXPECT_EQ(find_settled_frame_of_errors({3, 2, 0.4, 0.1}), 3);
    EXPECT_EQ(find_settled_frame_of_errors({0, 0, 0}), 1);
    EXPECT_EQ(find_settled_frame_of_errors({2, 0.5}), 2) << "at the bound is within";
    EXPECT_EQ(find_settled_frame_of_errors({2, 0.1, 0.6, 0.1}), 4) << "once within is not enough";
}

TEST(Settling, SettledFrameIsUnknownIfTheLastErrorIsOutOfBounds) {
    EXPECT_EQ(find_settled_frame_of_errors({0.1, 0.1, 2}), std::nullopt);
    EXPECT_EQ(find_settled_frame_of_errors({}), std::nullopt);
    constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(find_settled_frame_of_errors({0.1, kNotANumber}), std::nullopt);
    EXPECT_EQ(find_settled_frame_of_errors({kNotANumber, 0.1}), 2);
}

} // namespace
} // namespace catoptric::measure
