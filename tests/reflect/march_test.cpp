// The march by equal angles finds the first crossing.
#include "support/searches.hpp"

namespace {

using namespace catoptric;

TEST(March, IsWorthItsSteps) {
    test::expect_worth(
        "march",
        {.first_order = .58, .all = .43, .coarse = .49, .mirror_in_mirror = .25, .angle = .06});
}

} // namespace
