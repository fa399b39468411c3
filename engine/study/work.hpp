#pragma once

#include "study/study.hpp"

namespace catoptric::study {

using namespace session;

/// Counts the work of one frame of each row whose work is not yet counted.
void count_work(const StudyInput& input);

/// Study::prepare of studies whose results follow from counted work. The report also shows the
/// counts.
void show_work(const CompareRequest& request, int count, report::Comparison& comparison);

} // namespace catoptric::study
