// The march by equal angles finds the first crossing.
#include "support/searches.hpp"

namespace {

using namespace catoptric;

TEST(March, IsWorthItsSteps) { test::expect_worth("march", {.first_order = .75, .all = .70, .angle = .06}); }

} // namespace
