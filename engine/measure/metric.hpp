#pragma once

#include "measure/comparison.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// Table of metrics. A metric is one row: its name, its meaning and the function that computes it.
/// The .cpp that computes a metric registers it, so no other file lists it. JSON, CSV, tables,
/// `diff` and `list metrics` read this table.
namespace catoptric::measure {

/// Position of a pixel, counted from the upper left. A negative x means none.
struct PixelPosition {
    int x = -1, y = -1;
};

struct MetricParts;

/// Value of a metric. A double that is not finite, a time that was never measured and an invalid
/// place count as no value (see is_missing).
using MetricValue = std::variant<std::monostate, bool, double, dvec3, PixelPosition, SampleSummary,
                                 std::vector<double>, std::vector<MetricParts>>;

/// An entry of a list of values, such as the times of passes or the shares of causes.
struct MetricParts {
    std::string_view kind; ///< the field that holds the entry's name, such as "name"
    std::string name;
    std::vector<std::pair<std::string_view, MetricValue>> values;
};

/// Results of studies that have no member of their own in Row, by the name of the metric.
struct Studied {
    std::map<std::string, MetricValue, std::less<>> values;
};
void set_study_metric(Row& row, const std::string& metric, MetricValue value);
/// Returns the row's value of a metric of a study; no value if the study has not set it.
MetricValue study_metric(const Row& row, std::string_view metric);

enum class BetterDirection : std::uint8_t { neither, less, more };

/// Format of a value in a table cell.
enum class ValueFormat : std::uint8_t {
    fixed,         ///< a fixed number of decimals
    error,         ///< error: four decimals, or one digit and an exponent below .00005
    times,         ///< the median, with the decimals of the whole table
    own_times,     ///< the median with three significant digits
    time_interval, ///< the interval of the median, with 95 % confidence
    percent,       ///< a share in percent, with a fixed number of decimals
    mebibytes,
};
enum class TableKind : std::uint8_t { rows, lookup };

/// Column of the report's tables.
struct MetricColumn {
    std::string_view title;
    ValueFormat style = ValueFormat::error;
    int decimals = 0;
    TableKind table = TableKind::rows;
    int order = 0; ///< place among the table's columns; 0 means the metric's order
};

/// Input of a metric of two pictures. If `mask` is empty, all pixels count.
struct PicturePair {
    const Picture &a, &b;
    const Mask& mask;
    std::span<const float> flip_map;
};

/// The mask of pixels that show mirrors (Metric::mask).
inline constexpr std::string_view kMirrorMaskName = "mirrors";

struct Metric {
    /// Name such as "rmse". "lookup/miss" is the field `miss` of the object `lookup` in JSON, and
    /// the column `lookup_miss` in CSV.
    std::string_view name;
    std::string_view unit = {}; ///< "ms", "bytes"; empty for a plain number
    std::string_view help;
    /// Pixels that the metric covers: a name of `row_masks()`, or empty if it is not about
    /// pixels. A metric of a difference has a value for each mask and each mirror, and its `mask`
    /// becomes "each".
    std::string_view mask = {};
    BetterDirection better = BetterDirection::neither;
    int order = 1000;             ///< place in files and lists; equal orders are sorted by name
    bool only_where_true = false; ///< whether JSON leaves this mark out if it is false
    bool each_mask_in_table = false;
    std::vector<MetricColumn> columns = {}; ///< columns in the report's tables; may be empty

    /// Name of the study that fills this metric in Row::studied. Reports show the metric only
    /// if the study was asked for. Empty for other metrics.
    std::string_view study = {};

    /// Marks a metric whose value is the entry of its name in Row::studied.
    struct FromStudy {};
    using RowMetricFunction = MetricValue (*)(const Row&);
    using DifferenceFunction = MetricValue (*)(const Difference&);
    /// Function that computes a metric of two pictures. A value that is not finite counts as no
    /// value. The function is called once for each mask of pixels.
    using PictureMetricFunction = double (*)(const PicturePair&);
    std::variant<FromStudy, RowMetricFunction, DifferenceFunction, PictureMetricFunction> get;
};

/// Registers a metric. Define it at namespace scope: the metric enters the table while the program
/// starts.
struct RegisteredMetric {
    explicit RegisteredMetric(Metric metric);
};

/// Upper limit of Metric::order for metrics of differences, which use orders from 100 on.
inline constexpr int kOrderAfterDifferences = 200;

/// Returns all metrics sorted by `order`, then name. Throws `internal` if two have the same name.
const std::vector<Metric>& metrics();
/// Returns the metrics of a difference, whose mask is "each".
const std::vector<Metric>& difference_metrics();

/// Return the value of a metric. The first overload throws `internal` for a metric of a difference,
/// the second for a metric of a row.
MetricValue metric_value(const Metric& metric, const Row& row);
MetricValue metric_value(const Metric& metric, const Difference& difference);
/// Returns whether reports on the comparison show the metric (see Metric::study).
bool is_shown(const Metric& metric, const Comparison& comparison);
/// Returns whether a value counts as none (see MetricValue).
bool is_missing(const MetricValue& value);

/// Returns the values of the metrics that are computed from pictures, in the order of
/// Difference::others.
std::vector<double> picture_metrics(const PicturePair& compared);

/// Set of pixels over which each row has a difference.
struct RowMask {
    std::string_view field; ///< field in JSON, such as "error_first_order"
    std::string_view name;  ///< name of the mask, such as "first_order"
    /// Title of the mask in tables. Empty for the mask of all mirror pixels, to which tables refer
    /// without a title.
    std::string_view title;
    Difference Errors::*error;
    /// Whether tables show the columns of this mask only if some row has pixels in the mask.
    bool only_where_some = false;
};
std::span<const RowMask> row_masks();
/// Returns whether tables have columns of this mask.
bool has_table_columns(const RowMask& mask, const Comparison& comparison);

} // namespace catoptric::measure
