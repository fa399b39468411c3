#pragma once

#include "report/comparison.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

// Number formats of the report, the same in Markdown and HTML. A missing value reads "–".
namespace catoptric::report {

inline constexpr std::string_view kEmptyCell = "–";
/// Words for an error that the noise of the reference hides (measure/halves.hpp).
inline constexpr std::string_view kBelowNoise = "below the noise";

/// Returns a cell of a CSV file with escaped text from any source, quoted where RFC 4180 needs it.
/// Text that a spreadsheet program would execute begins with an apostrophe.
std::string escape_csv(const std::string& field);
/// Returns the shortest text that reads back as the same number; empty if it is not finite.
std::string format_csv_number(double value);
/// Returns the value with this many decimals, or "–" for NaN and infinities.
std::string format_fixed(double value, int decimals);
/// Returns an error in 0..1 with four decimals, "0" for exactly 0, or one digit and an exponent
/// below 0.00005. Returns kBelowNoise for a negative estimate.
std::string format_error(double error);
/// Returns the FLIP of a difference, with kBelowNoise if it is no larger than that of the
/// noise.
std::string format_flip(const measure::Difference& error);
/// Returns milliseconds with three significant digits.
std::string format_ms(double ms);
/// Returns the decimals with which the fastest row still has three significant digits. A table uses
/// one number of decimals so that its columns line up.
int ms_decimals(const Comparison& comparison);
/// Returns ", by processor time" if the rows are judged by it, and otherwise an empty text.
std::string describe_judged_time(const Comparison& comparison);
/// Returns 1000 / ms with three significant digits, or "–" if no time passed.
std::string format_fps(double ms);
std::string format_mebibytes(std::uint64_t bytes);
/// Returns the path of a picture of the comparison, relative to the report's folder.
std::string image_path(const Comparison& comparison, const std::string& file);
/// Returns text such as "bounces=3, face=256".
std::string format_settings(const Row& row);
/// Returns how many of the requested rows a run has, and why it has no more: "4 of 8 rows: ...".
std::string describe_incomplete_run(std::size_t rows, std::size_t asked,
                                    const std::optional<Error>& stopped);
/// Returns which phase of a comparison that ended early is not finished, such as "; 1 of 3 rounds".
/// Empty if it ended between rows or is complete.
std::string describe_unfinished_phase(const Comparison& comparison);
/// Returns how much of a comparison, including its lag, is finished, and why it ended early. Empty
/// if the comparison is complete.
std::string describe_incomplete_run(const Comparison& comparison);
/// The result is one line.
std::string escape_markdown(const std::string& text);
std::string join_texts(const std::vector<std::string>& parts, std::string_view between);
std::string join_labels(const std::vector<const Row*>& rows, std::string_view between = ", ");
/// Returns "view 3 of 30: --camera ... --time ...", the options with which `render` shows the view
/// again.
std::string describe_worst_view(const Comparison& comparison, const measure::WorstView& worst);
/// Returns the file name of a row's picture at its worst view, from its Row::image.
std::string worst_view_image(const std::string& image);
/// Returns the first part of the names of the files that show a row's largest lag, such as
/// "lag-reuse", from the row's label. Returns an empty text if the comparison has no such row.
/// kLagPictureNames lists the ends of these names.
std::string find_lag_image(const Comparison& comparison, const measure::LagRow& row);
/// Returns the same from the row's Row::image.
std::string lag_image_name(const std::string& image);
/// Ends of the names of a row's lag pictures: the moving scene, the row's picture of the scene at
/// rest, and the reference.
inline constexpr std::array<std::string_view, 3> kLagPictureNames{"-moving", "-still",
                                                                  "-reference"};

} // namespace catoptric::report
