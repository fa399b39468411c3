#pragma once

#include "core/work.hpp"
#include "measure/metric.hpp"

#include <vector>

/// Counted work of rows, as metrics of the study `work`.
namespace catoptric::measure {

/// Name of the metric that holds the work of each pass.
inline constexpr const char* kWorkByPassName = "work_by_pass";

/// Returns the metrics: "work/" with the name of each kind of work, and kWorkByPassName.
std::vector<Metric> work_metrics();
/// Sets the metrics of a row from the work of its passes.
void set_work(Row& row, const std::vector<PassWork>& passes);
/// Returns the row's counts over all passes. Kinds that were not counted have no value.
WorkCounts total_work(const Row& row);
bool has_counted_work(const Row& row);

} // namespace catoptric::measure
