#pragma once

#include "report/tables.hpp"

#include <string>
#include <vector>

// Tables and sentences about errors over drawn views. Each is empty if no views were drawn.
namespace catoptric::report {

/// Returns each row's metrics over the mirrors, as median and interval, and its worst view.
Table views_table(const Comparison& comparison);
/// Returns the order of the rows by each headline metric, and which of them tie.
std::vector<std::string> views_in_words(const Comparison& comparison);
/// Returns "view 3 of 30: --camera ... --time ...", the options with which `render` shows the view
/// again.
std::string view_text(const Comparison& comparison, const measure::WorstView& worst);
/// Returns the file name of a row's picture at its worst view, from its Row::image.
std::string worst_image(const std::string& image);

} // namespace catoptric::report
