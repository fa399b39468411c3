#pragma once

#include "measure/costs.hpp"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Functions that read and write files of unit costs, schema "catoptric/costs/1", and of times
/// measured elsewhere, schemas "catoptric/times/1" and "catoptric/row-times/1".
namespace catoptric::report {

/// Returns the costs as JSON. A fit is written with the measured and the predicted time of each
/// row.
std::string to_json(const measure::DeviceCosts& costs);
/// Reads costs. Members of a fit are ignored. Throws `bad_data` with `file`, the place, the
/// expected and the found value.
measure::DeviceCosts read_device_costs(const std::string& text, const std::string& file);
/// Reads the file of costs, at most 16 MiB, or the known costs of this name if there is no such
/// file. Throws as `read_device_costs` does, and for a file that cannot be read.
measure::DeviceCosts read_costs_file(const std::filesystem::path& file);

/// The costs of a device that this library holds.
struct KnownCosts {
    std::string name; ///< as in docs/costs, without ".json"
    std::string_view text;
};
/// Returns the costs in docs/costs, sorted by name.
const std::vector<KnownCosts>& list_known_costs();

/// Times of rows that were measured on another device, by techniques of this program.
struct OtherDeviceTimes {
    std::string device, note;
    std::vector<WorkKind> kinds; ///< the kinds of work whose costs are to be fitted
    struct TimedRow {
        std::string technique;
        double ms = 0;
    };
    std::vector<TimedRow> rows;
};
/// Throws as `read_costs_file` does.
OtherDeviceTimes read_times_file(const std::filesystem::path& file);

/// Times that another renderer took for the pictures of its rows (`compare --row`).
struct RowTimes {
    std::string device, note;
    struct TimedRow {
        std::string row;        ///< name of the row
        std::vector<double> ms; ///< times of frames, above 0
    };
    std::vector<TimedRow> rows;
};
/// Throws as `read_costs_file` does.
RowTimes read_row_times(const std::filesystem::path& file);

} // namespace catoptric::report
