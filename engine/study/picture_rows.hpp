#pragma once

#include "compare.hpp"
#include "study/compare_row.hpp"

#include <cstddef>
#include <string>
#include <vector>

// Rows whose pictures are files, such as those of another renderer (CompareRequest::pictures).
namespace catoptric::app {

/// Returns the name of such a row's pictures in the report, without folder and ending. `index`: of
/// the row among those of files, from 0.
std::string picture_row_image_name(const std::string& name, std::size_t index);

/// Throws `usage` for a row without a name, or with the name of another row. Throws `bad_data`, and
/// names the file, if a picture cannot be read or has another size than the comparison. Reads the
/// pictures' headers only.
void check_picture_rows(const CompareRequest& request);

/// Reads the picture of a row. Files of floats (EXR, Radiance) hold linear light. A PNG holds what
/// is displayed at `exposure` stops: its light is divided by 2^exposure. Returns a picture of
/// linear light before exposure.
measure::Picture read_row_picture(const std::string& file, double exposure);

/// Returns a row that shows the picture, with its errors and without a time. `hits`: of the same
/// instant, see TechniqueResult::hits.
report::Row make_picture_row(const std::string& name, std::size_t index,
                             const measure::Picture& picture, const ComparedReference& truth,
                             const std::vector<std::uint32_t>& hits, std::size_t mirrors,
                             double exposure);

/// Returns what is suspicious about the row's picture, in sentences: it differs from the reference
/// more beside the mirrors than on them, or less if it is turned upside down.
std::vector<std::string> list_picture_row_warnings(const report::Row& row,
                                                   const ComparedReference& truth,
                                                   const std::vector<std::uint32_t>& hits,
                                                   double exposure);

} // namespace catoptric::app
