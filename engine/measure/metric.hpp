#pragma once

#include "measure/comparison.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// The table of figures. A figure is one row: what it is called, what it means and how it is got,
/// in the one .cpp where it is computed, which registers itself; nothing else lists it. JSON, CSV,
/// tables, `diff` and `list metrics` read this table.
namespace catoptric::measure {

/// A pixel, from the upper left; x below 0: none.
struct Place {
    int x = -1, y = -1;
};

struct Parts;

/// What a quantity comes to. A double that is not finite, times never measured and a place that is
/// none are there and say nothing.
using Value = std::variant<std::monostate, bool, double, dvec3, Place, Summary, std::vector<double>,
                           std::vector<Parts>>;

/// One of several things of one kind: a pass, a cause.
struct Parts {
    std::string_view kind; ///< "name": the field that holds its name
    std::string name;
    std::vector<std::pair<std::string_view, Value>> values;
};

enum class Better : std::uint8_t { neither, less, more };

/// How a value reads in a table's cell.
enum class Style : std::uint8_t {
    fixed,         ///< so many decimals
    error,         ///< four decimals, a power of ten where that is 0
    times,         ///< the median, at the decimals of the whole table
    own_times,     ///< the median at three digits
    time_interval, ///< of the median, with 95 % confidence
    percent,       ///< of a share, so many decimals
    mebibytes,
};
enum class InTable : std::uint8_t { rows, lookup };

/// A column of the report's tables.
struct Column {
    std::string_view title;
    Style style = Style::error;
    int decimals = 0;
    InTable table = InTable::rows;
    int order = 0; ///< among the table's columns; 0: as the quantity
};

/// What figures of two pictures are computed from; `mask` empty: every pixel counts.
struct Compared {
    const Picture &a, &b;
    const Mask& mask;
    std::span<const float> flip_map;
};

struct Metric {
    /// "rmse"; "lookup/miss" is `miss` within the object `lookup` of JSON and `lookup_miss` in CSV.
    std::string_view name;
    std::string_view unit = {}; ///< "ms", "bytes"; empty: a plain number
    std::string_view help;
    /// Pixels that it is over: a name of `masks()`; empty: it is of no pixels. A figure of a
    /// difference stands once for each of them and for each mirror, and this becomes "each".
    std::string_view mask = {};
    Better better = Better::neither;
    int order = 1000;             ///< place in files and lists; then by name
    bool only_where_true = false; ///< a mark that JSON leaves out where it is false
    bool each_mask_in_table = false;
    std::vector<Column> columns = {}; ///< of the report's tables; may be none

    using OfRow = Value (*)(const Row&);
    using OfDifference = Value (*)(const Difference&);
    /// Computed with every difference; finite or nothing. Costs what it costs for each mask.
    using OfPictures = double (*)(const Compared&);
    std::variant<OfRow, OfDifference, OfPictures> get;
};

/// A namespace-scope Registered puts its quantity into the table while the program starts.
struct Registered {
    explicit Registered(Metric quantity);
};

/// Orders from 100 up to this one are of figures of differences.
inline constexpr int kAfterDifferences = 200;

/// Every quantity by `order`, then name. Two of one name are `Failure::internal`.
const std::vector<Metric>& metrics();
/// Those of a difference: mask "each".
const std::vector<Metric>& difference_metrics();

/// Throws `internal` for a quantity of a difference, and of a row.
Value value_of(const Metric& quantity, const Row& row);
Value value_of(const Metric& quantity, const Difference& difference);
/// Whether there is nothing to say.
bool is_nothing(const Value& value);

/// The quantities that are computed from pictures, in the order of Difference::others.
std::vector<double> other_figures(const Compared& compared);

/// A set of pixels over which each row has a difference.
struct RowMask {
    std::string_view field; ///< of JSON: "error_first_order"
    std::string_view name;  ///< "first_order"
    std::string_view
        title; ///< in tables; empty: the mirrors, of which all speaks unless it says so
    Difference Errors::*error;
    bool only_where_some = false; ///< tables have columns of it only where a row has such pixels
};
std::span<const RowMask> masks();
/// Returns whether tables have columns of this mask.
bool has_columns(const RowMask& mask, const Comparison& comparison);

} // namespace catoptric::measure
