#include "sweep_merge.hpp"

#include "core/error.hpp"
#include "measure/interval.hpp"
#include "measure/metric.hpp"
#include "measure/picture.hpp"
#include "report/json.hpp"
#include "report/text.hpp"
#include "sweep_locks.hpp"
#include "sweep_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace catoptric::cli {

namespace {

using OrderedJson = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kPictureGapColumns = 4; // between the row and its reference in a common picture

/// Results of the pieces of one scene with one set of options, in the order of the plan.
struct SweepGroup {
    SweepJson scene, options;
    std::vector<std::string> labels;
    std::vector<const SweepPiece*> picture_pieces, timing_pieces;
    std::vector<SweepJson> pictures, timings; ///< results of these pieces
};

/// Returns whether the identity is new, and adds it.
void add_identity(std::vector<SweepJson>& identities, const SweepJson& identity) {
    if (std::ranges::find(identities, identity) == identities.end()) identities.push_back(identity);
}

/// Returns what differs between identities: "driver: A, B; lanes: 4, 8".
std::string describe_identity_differences(const std::vector<SweepJson>& identities) {
    std::set<std::string> names;
    for (const SweepJson& identity : identities)
        for (const auto& [name, value] : identity.items()) names.insert(name);
    std::string text;
    for (const std::string& name : names) {
        std::set<std::string> values;
        for (const SweepJson& identity : identities)
            values.insert(report::describe_json_value(identity.value(name, SweepJson())));
        if (values.size() > 1)
            text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name,
                                fmt::join(values, ", "));
    }
    return text;
}

/// Counts the pixels of which a channel differs by more than 1/255.
IdentityDifference compare_pictures(const measure::Picture& a, const measure::Picture& b,
                                    const fs::path& file) {
    check(a.width == b.width && a.height == b.height, Failure::bad_data, file.string(),
          ": wanted a picture of ", a.width, "x", a.height, ", found ", b.width, "x", b.height);
    const measure::Picture shown_a = measure::to_display(a), shown_b = measure::to_display(b);
    constexpr float kMoreThanOneStep = 1.5F / 255; // values are multiples of 1/255
    const int gap = (a.width - kPictureGapColumns) / 2;
    IdentityDifference difference;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            if (x >= gap && x < gap + kPictureGapColumns) continue;
            const vec3 apart = glm::abs(shown_a.at(x, y) - shown_b.at(x, y));
            difference.pixels += 1;
            difference.apart += std::max({apart.x, apart.y, apart.z}) > kMoreThanOneStep;
        }
    return difference;
}

/// Compares the common pictures of each pair of identities. Throws `bad_data` if two have none.
IdentityDifference compare_identities(const fs::path& folder, const SweepPlan& plan,
                                      const std::vector<SweepJson>& identities) {
    IdentityDifference whole;
    for (std::size_t i = 0; i < identities.size(); ++i)
        for (std::size_t k = i + 1; k < identities.size(); ++k) {
            const std::size_t before = whole.pixels;
            for (const std::size_t place : plan.common) {
                const SweepPiece& piece = plan.pieces[place];
                for (std::size_t row = 0; row < piece.content["techniques"].size(); ++row) {
                    const std::string name = fmt::format("{}.png", row);
                    const fs::path a = find_common_picture_folder(folder, identities[i], piece.id) /
                                       name,
                                   b = find_common_picture_folder(folder, identities[k], piece.id) /
                                       name;
                    std::error_code ignored;
                    if (!fs::exists(a, ignored) || !fs::exists(b, ignored)) continue;
                    const IdentityDifference found = compare_pictures(measure::read_picture(a),
                                                                      measure::read_picture(b), b);
                    whole.pixels += found.pixels, whole.apart += found.apart;
                }
            }
            check(whole.pixels > before, Failure::bad_data, folder.string(),
                  ": two kinds of machines have no common picture: ",
                  describe_identity_differences({identities[i], identities[k]}));
        }
    return whole;
}

std::vector<SweepGroup> group_results(const fs::path& folder, const SweepPlan& plan) {
    std::vector<SweepGroup> groups;
    for (const SweepPiece& piece : plan.pieces) {
        const SweepJson &scene = piece.content["scene"], &options = piece.content["options"];
        const auto known = std::ranges::find_if(groups, [&](const SweepGroup& group) {
            return group.scene == scene && group.options == options;
        });
        SweepGroup& group = known != groups.end() ? *known : groups.emplace_back();
        group.scene = scene, group.options = options;
        group.labels = piece.content["techniques"].get<std::vector<std::string>>();
        (piece.is_timing() ? group.timing_pieces : group.picture_pieces).push_back(&piece);
        (piece.is_timing() ? group.timings : group.pictures)
            .push_back(read_sweep_result(folder, piece).value());
    }
    return groups;
}

/// Metrics of a difference that are one number.
std::vector<std::string> list_scalar_metric_names() {
    std::vector<std::string> names;
    for (const measure::Metric& metric : measure::list_difference_metrics())
        if (std::holds_alternative<double>(
                measure::metric_value_of_difference(metric, measure::Difference())) ||
            metric.name == "flip")
            names.emplace_back(metric.name);
    return names;
}

/// Returns the metric of a row over its mirrors in each view; NaN where it has no value.
std::vector<double> list_metric_values(const SweepGroup& group, std::size_t row,
                                       const std::string& metric) {
    std::vector<double> values;
    for (const SweepJson& result : group.pictures) {
        const SweepJson value = result["rows"].at(row).at("error").value(metric, SweepJson());
        values.push_back(value.is_number() ? value.get<double>() : NAN);
    }
    return values;
}

/// Mean, median and largest value over views, and the interval of the median.
struct SweepSummary {
    std::size_t views = 0;
    double mean = NAN, median = NAN, largest = NAN;
    measure::Interval ci95;
};

double median_of_sorted(const std::vector<double>& sorted) {
    const std::size_t half = sorted.size() / 2;
    return sorted.size() % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

SweepSummary summarise(std::vector<double> values) {
    std::erase_if(values, [](double value) { return std::isnan(value); });
    SweepSummary summary{.views = values.size()};
    if (values.empty()) return summary;
    std::ranges::sort(values);
    summary.mean = std::accumulate(values.begin(), values.end(), 0.0) /
                   static_cast<double>(values.size());
    summary.median = median_of_sorted(values);
    summary.largest = values.back();
    summary.ci95 = measure::median_confidence_interval(values);
    return summary;
}

OrderedJson make_summary_json(const SweepSummary& summary) {
    return {{"views", summary.views},
            {"mean", report::make_number_json(summary.mean)},
            {"median", report::make_number_json(summary.median)},
            {"ci95", report::make_interval_json(summary.ci95)},
            {"largest", report::make_number_json(summary.largest)}};
}

/// Returns how many different instants the views of a group have.
std::size_t count_instants(const SweepGroup& group) {
    std::set<double> instants;
    for (const SweepPiece* piece : group.picture_pieces)
        instants.insert(
            piece->content["view"].is_null() ? 0.0 : piece->content["view"]["time"].get<double>());
    return instants.size();
}

OrderedJson make_group_json(const SweepGroup& group, const std::vector<std::string>& metrics) {
    OrderedJson json{{"scene", group.scene},
                     {"options", group.options},
                     {"views", group.pictures.size()},
                     {"instants", count_instants(group)},
                     {"rows", OrderedJson::array()}};
    for (std::size_t row = 0; row < group.labels.size(); ++row) {
        OrderedJson errors = OrderedJson::object();
        for (const std::string& metric : metrics)
            errors[metric] = make_summary_json(summarise(list_metric_values(group, row, metric)));
        json["rows"].push_back({{"label", group.labels[row]}, {"error", errors}});
    }
    return json;
}

/// A table as a CSV file by RFC 4180.
class CsvTable {
public:
    void add_line(const std::vector<std::string>& fields) {
        std::vector<std::string> escaped;
        for (const std::string& field : fields) escaped.push_back(report::escape_csv_field(field));
        text_ += fmt::format("{}\r\n", fmt::join(escaped, ","));
    }
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

/// Returns the options whose values differ between groups.
std::vector<std::string> list_axis_names(const std::vector<SweepGroup>& groups) {
    std::vector<std::string> names;
    for (const auto& [name, value] : groups.front().options.items())
        if (std::ranges::any_of(groups, [&](const SweepGroup& group) {
                return group.options.value(name, SweepJson()) != value;
            }))
            names.push_back(name);
    return names;
}

/// Returns the fields that tell groups apart: the scene, then a value for each axis.
std::vector<std::string> make_group_fields(const SweepGroup& group,
                                           const std::vector<std::string>& axes) {
    std::vector<std::string> fields{group.scene.get<std::string>()};
    for (const std::string& axis : axes) {
        const SweepJson& value = group.options[axis];
        fields.push_back(value.is_string() ? value.get<std::string>() : value.dump());
    }
    return fields;
}

std::vector<std::string> make_header(const std::vector<std::string>& axes,
                                     std::initializer_list<const char*> names) {
    std::vector<std::string> fields{"scene"};
    fields.insert(fields.end(), axes.begin(), axes.end());
    fields.insert(fields.end(), names.begin(), names.end());
    return fields;
}

std::string make_errors_csv(const std::vector<SweepGroup>& groups,
                            const std::vector<std::string>& metrics) {
    const std::vector<std::string> axes = list_axis_names(groups);
    std::vector<std::string> header = make_header(axes, {"view", "seed", "time", "label"});
    header.insert(header.end(), metrics.begin(), metrics.end());
    CsvTable table;
    table.add_line(header);
    for (const SweepGroup& group : groups)
        for (std::size_t i = 0; i < group.pictures.size(); ++i)
            for (std::size_t row = 0; row < group.labels.size(); ++row) {
                const SweepJson& view = group.picture_pieces[i]->content["view"];
                std::vector<std::string> fields = make_group_fields(group, axes);
                for (const char* name : {"index", "seed", "time"})
                    fields.push_back(view.is_null() ? "" : view[name].dump());
                fields.push_back(group.labels[row]);
                for (const std::string& metric : metrics)
                    fields.push_back(
                        report::format_csv_number(list_metric_values(group, row, metric)[i]));
                table.add_line(fields);
            }
    return table.text();
}

std::string make_summary_csv(const std::vector<SweepGroup>& groups,
                             const std::vector<std::string>& metrics) {
    const std::vector<std::string> axes = list_axis_names(groups);
    std::vector<std::string> header = make_header(axes, {"label", "views"});
    for (const std::string& metric : metrics)
        for (const char* part : {"mean", "median", "low", "high", "largest"})
            header.push_back(metric + "_" + part);
    CsvTable table;
    table.add_line(header);
    for (const SweepGroup& group : groups)
        for (std::size_t row = 0; row < group.labels.size(); ++row) {
            std::vector<std::string> fields = make_group_fields(group, axes);
            fields.push_back(group.labels[row]);
            fields.push_back(std::to_string(group.pictures.size()));
            for (const std::string& metric : metrics) {
                const SweepSummary summary = summarise(list_metric_values(group, row, metric));
                for (const double value : {summary.mean, summary.median, summary.ci95.low,
                                           summary.ci95.high, summary.largest})
                    fields.push_back(report::format_csv_number(value));
            }
            table.add_line(fields);
        }
    return table.text();
}

/// Times of a row on one machine, from the rounds of all repeats.
struct SweepTime {
    SweepJson machine, identity;
    std::string label;
    std::vector<double> rounds;
    bool noisy = false;
};

std::vector<SweepTime> list_times(const SweepGroup& group) {
    std::vector<SweepTime> times;
    for (const SweepJson& result : group.timings)
        for (const SweepJson& row : result["rows"]) {
            const auto label = row.at("label").get<std::string>();
            const auto known = std::ranges::find_if(times, [&](const SweepTime& time) {
                return time.label == label && time.machine == result["machine"] &&
                       time.identity == result["identity"];
            });
            SweepTime& time = known != times.end() ? *known : times.emplace_back();
            time.label = label, time.machine = result["machine"];
            time.identity = result["identity"];
            time.noisy = time.noisy || row.at("noisy").get<bool>();
            for (const SweepJson& round : row.at("rounds"))
                time.rounds.push_back(round.get<double>());
        }
    return times;
}

OrderedJson make_times_json(const std::vector<SweepGroup>& groups) {
    OrderedJson list = OrderedJson::array();
    for (const SweepGroup& group : groups)
        for (const SweepTime& time : list_times(group)) {
            const SweepSummary summary = summarise(time.rounds);
            list.push_back({{"scene", group.scene},
                            {"options", group.options},
                            {"label", time.label},
                            {"machine", time.machine},
                            {"identity", time.identity},
                            {"ms", report::make_number_json(summary.median)},
                            {"ci95", report::make_interval_json(summary.ci95)},
                            {"rounds", time.rounds},
                            {"noisy", time.noisy}});
        }
    return {{"schema", "catoptric/sweep-times/1"}, {"times", list}};
}

std::string make_times_csv(const std::vector<SweepGroup>& groups) {
    const std::vector<std::string> axes = list_axis_names(groups);
    CsvTable table;
    table.add_line(make_header(
        axes, {"label", "machine", "device", "ms", "ms_low", "ms_high", "rounds", "noisy"}));
    for (const SweepGroup& group : groups)
        for (const SweepTime& time : list_times(group)) {
            const SweepSummary summary = summarise(time.rounds);
            std::vector<std::string> fields = make_group_fields(group, axes);
            fields.insert(fields.end(), {time.label, time.machine.get<std::string>(),
                                         time.identity.value("device", std::string())});
            for (const double value : {summary.median, summary.ci95.low, summary.ci95.high})
                fields.push_back(report::format_csv_number(value));
            fields.insert(fields.end(),
                          {std::to_string(time.rounds.size()), time.noisy ? "true" : "false"});
            table.add_line(fields);
        }
    return table.text();
}

} // namespace

SweepState check_sweep(const fs::path& folder, const SweepPlan& plan) {
    SweepState state{.pieces = plan.pieces.size()};
    std::error_code ignored;
    std::optional<PieceLockFile> locks;
    if (fs::exists(folder / "locks", ignored)) locks.emplace(folder / "locks");
    std::set<std::string> known;
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
        const SweepPiece& piece = plan.pieces[i];
        known.insert(find_sweep_result_file(folder, piece.id).filename().string());
        try {
            if (const std::optional<SweepJson> result = read_sweep_result(folder, piece)) {
                ++state.finished;
                add_identity(state.identities, (*result)["identity"]);
                continue;
            }
            if (locks && locks->is_locked_elsewhere(i)) state.in_work.push_back(piece.id);
            state.missing.push_back(piece.id);
        } catch (const Error& error) {
            state.broken.emplace_back(piece.id, error.what());
        }
    }
    for (const auto& entry : fs::directory_iterator(folder / "results", ignored))
        if (!known.contains(entry.path().filename().string()))
            state.unknown.push_back(entry.path().filename().string());
    std::ranges::sort(state.unknown);
    return state;
}

MergedSweep merge_sweep(const fs::path& folder, const SweepPlan& plan, AcrossIdentities across) {
    const SweepState state = check_sweep(folder, plan);
    check(state.is_complete(), Failure::bad_data, folder.string(), ": wanted the results of ",
          state.pieces, " pieces, found ", state.finished, "; 'catoptric sweep check ",
          folder.string(), "' names the others");
    const std::vector<SweepGroup> groups = group_results(folder, plan);
    MergedSweep merged;
    for (const SweepGroup& group : groups)
        for (const SweepJson& result : group.pictures)
            add_identity(merged.identities, result["identity"]);
    std::ranges::sort(merged.identities);
    const bool differ = merged.identities.size() > 1;
    check(!differ || across == AcrossIdentities::allowed, Failure::bad_data, folder.string(),
          ": the pictures come from ", merged.identities.size(), " kinds of machines (",
          describe_identity_differences(merged.identities),
          "); --across-identities merges them and says how much their pictures differ");
    if (differ) merged.difference = compare_identities(folder, plan, merged.identities);

    const std::vector<std::string> metrics = list_scalar_metric_names();
    OrderedJson document{{"schema", "catoptric/sweep-merged/1"}, {"sweep", plan.sweep}};
    document["identities"] = merged.identities;
    document["identity_difference"] = nullptr;
    if (differ)
        document["identity_difference"] = {{"pixels", merged.difference.pixels},
                                           {"share", merged.difference.share()}};
    document["groups"] = report::make_list_json(
        groups, [&](const SweepGroup& group) { return make_group_json(group, metrics); });
    merged.files = {{"errors.csv", make_errors_csv(groups, metrics)},
                    {"summary.csv", make_summary_csv(groups, metrics)}};
    const bool has_times = std::ranges::any_of(
        groups, [](const SweepGroup& group) { return !group.timings.empty(); });
    if (has_times) {
        merged.files.emplace_back("times.json", report::serialise_json(make_times_json(groups)));
        merged.files.emplace_back("times.csv", make_times_csv(groups));
    }
    merged.files.emplace_back("sweep.json", report::serialise_json(document));
    return merged;
}

} // namespace catoptric::cli
