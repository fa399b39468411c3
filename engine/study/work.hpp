#pragma once

#include "study/study.hpp"

namespace catoptric::study {

using namespace session;

/// Counts the work of one frame of each row whose work is not yet counted.
void count_work(const StudyInput& input);

} // namespace catoptric::study
