#pragma once

#include "report/tables.hpp"

#include <string>
#include <vector>

// What errors over drawn views read like. Without such views there is nothing of it.
namespace catoptric::report {

/// Every row's figures over the mirrors, median and interval, and its worst view.
Table views_table(const Comparison& comparison);
/// The order of the rows by each headline figure, and which of them tie.
std::vector<std::string> views_in_words(const Comparison& comparison);
/// "view 3 of 30: --camera ... --time ...": what `render` takes to show it again.
std::string view_text(const Comparison& comparison, const measure::WorstView& worst);
/// File name of a row's picture at its worst view, from its Row::image.
std::string worst_image(const std::string& image);

} // namespace catoptric::report
