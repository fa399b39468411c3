#pragma once

#include "compare.hpp"
#include "study/compare_row.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

// Functions for rows whose pictures are files, such as pictures of another renderer
// (CompareRequest::pictures).
namespace catoptric::study {

using namespace session;

/// Returns the name, without folder and ending, under which the report stores the pictures of a row
/// of files. `index`: number of the row among the rows of files, from 0.
std::string picture_row_name(const std::string& name, std::size_t index);

/// Returns the name, without ending, of a view's picture in the folder of such a row: "view-000" of
/// the comparison's own camera, and "view-001" of the first drawn view.
std::string view_picture_name(std::size_t view);

/// Returns the file of a row's picture in a view, as view_picture_name counts. `path` is a folder
/// with a picture for each view, or the picture of view 0. Returns nothing for other views of a
/// single picture. Throws `bad_data` unless a folder has exactly one .exr, .hdr or .png of the
/// view.
std::optional<std::string> find_view_picture(const std::string& path, std::size_t view);

/// Throws `usage` for a row without a name, or with the name of another row. Throws `bad_data`, and
/// names the file, if a picture cannot be read, has another size than the comparison or a value
/// that is not finite, and if a folder lacks the picture of a view or has a views.json (`catoptric
/// views`) of other views. Reads every picture to its end.
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

/// Returns warnings about a picture of another renderer, as sentences that begin with `name`. At
/// most one is given: that values in `file` have the wrong curve, that the picture is upside down,
/// or that it differs from the reference more where surfaces reflect nothing than on the mirrors.
/// `rmse`: error on the mirrors.
std::vector<std::string> picture_row_warnings(const std::string& name, const std::string& file,
                                              const measure::Picture& picture, double rmse,
                                              const ComparedReference& truth,
                                              const std::vector<std::uint32_t>& hits,
                                              double exposure);

} // namespace catoptric::study
