#include "sweep_merge.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "measure/interval.hpp"
#include "measure/metric.hpp"
#include "measure/picture.hpp"
#include "report/json.hpp"
#include "report/text.hpp"
#include "sweep_groups.hpp"
#include "sweep_locks.hpp"
#include "sweep_run.hpp"
#include "sweep_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

namespace catoptric::cli {

namespace {

using OrderedJson = nlohmann::ordered_json;
namespace fs = std::filesystem;

constexpr int kPictureGapColumns = 4; // between the row and the reference beside it in a common
                                      // picture

/// Adds the identity (program, driver and processor) to the list if it is new.
void add_identity(std::vector<SweepJson>& identities, const SweepJson& identity) {
    if (std::ranges::find(identities, identity) == identities.end()) identities.push_back(identity);
}

/// Returns a text with the differences between identities, such as "driver: A, B; lanes: 4, 8".
std::string describe_identities(const std::vector<SweepJson>& identities) {
    std::set<std::string> names;
    for (const SweepJson& identity : identities)
        for (const auto& [name, value] : identity.items()) names.insert(name);
    std::string text;
    for (const std::string& name : names) {
        std::set<std::string> values;
        for (const SweepJson& identity : identities)
            values.insert(identity.value(name, SweepJson()).dump());
        if (values.size() > 1)
            text += fmt::format("{}{}: {}", text.empty() ? "" : "; ", name,
                                fmt::join(values, ", "));
    }
    return text;
}

/// Which columns of a common picture are compared: those of the row, or also those of the reference
/// beside it.
enum class ComparedColumns { row, row_and_reference };

/// Counts the pixels in which some channel differs by more than 1/255 between two picture files.
IdentityDifference compare_pictures(const fs::path& a_file, const fs::path& b_file,
                                    ComparedColumns columns) {
    const measure::Picture a = measure::to_display(measure::read_picture(a_file)),
                           b = measure::to_display(measure::read_picture(b_file));
    check(a.width == b.width && a.height == b.height, Failure::bad_data, b_file.string(),
          ": wanted a picture of ", a.width, "x", a.height, ", found ", b.width, "x", b.height);
    constexpr float kMoreThanOneStep = 1.5F / 255; // values are multiples of 1/255
    const int width = (a.width - kPictureGapColumns) / 2;
    IdentityDifference difference;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < (columns == ComparedColumns::row ? width : a.width); ++x) {
            if (x >= width && x < width + kPictureGapColumns) continue;
            const vec3 apart = glm::abs(a.at(x, y) - b.at(x, y));
            difference.pixels += 1;
            difference.apart += std::max({apart.x, apart.y, apart.z}) > kMoreThanOneStep;
        }
    return difference;
}

/// Returns the names of the pictures that machines of an identity drew for a common piece; empty if
/// none were drawn yet.
std::vector<std::string> common_pictures(const fs::path& folder) {
    std::error_code ignored;
    const fs::path file = folder / kCommonListFile;
    if (!fs::exists(file, ignored)) return {};
    constexpr std::uintmax_t kMaxListBytes = 1U << 20U;
    const auto names = parse_json<SweepJson>(
        file.string(), read_json_text(file, "a list of pictures", kMaxListBytes));
    check(names.is_array() &&
              std::ranges::all_of(names, [](const SweepJson& name) { return name.is_string(); }),
          Failure::bad_data, file.string(), ": wanted a list of file names");
    return names.get<std::vector<std::string>>();
}

/// Compares the common pictures of two identities on one device, and adds the numbers of different
/// pixels. Throws `bad_data` if an identity has no common pictures.
void add_difference(const fs::path& folder, const SweepPlan& plan, const SweepJson& device,
                    const SweepJson& a, const SweepJson& b, IdentityDifference& whole) {
    const std::size_t before = whole.pixels;
    for (const std::size_t place : plan.common) {
        const SweepPiece& piece = plan.pieces[place];
        if (device_options(piece.content) != device) continue;
        const fs::path a_folder = common_folder(folder, a, piece.id),
                       b_folder = common_folder(folder, b, piece.id);
        const std::vector<std::string> names = common_pictures(a_folder),
                                       other_names = common_pictures(b_folder);
        for (const std::string& name : names) {
            if (std::ranges::find(other_names, name) == other_names.end()) continue;
            const bool is_first = name == names.front();
            const IdentityDifference found = compare_pictures(
                a_folder / name, b_folder / name,
                is_first ? ComparedColumns::row_and_reference : ComparedColumns::row);
            whole.pixels += found.pixels, whole.apart += found.apart;
        }
    }
    check(whole.pixels > before, Failure::bad_data, folder.string(),
          ": two identities have no common picture: ", describe_identities({a, b}),
          "; 'catoptric sweep run' on each of these machines draws them with its next piece");
}

OrderedJson summary_json(const SweepSummary& summary) {
    return {{"views", summary.count},
            {"mean", report::number_json(summary.mean)},
            {"median", report::number_json(summary.median)},
            {"ci95", report::interval_json(summary.ci95)},
            {"largest", report::number_json(summary.largest)}};
}

OrderedJson group_json(const SweepGroup& group, const std::vector<std::string>& metrics) {
    OrderedJson json{{"scene", group.scene},
                     {"options", group.options},
                     {"views", group.pictures.size()},
                     {"instants", count_instants(group)},
                     {"interval_over", has_dependent_views(group) ? "instants" : "views"},
                     {"rows", OrderedJson::array()}};
    for (std::size_t row = 0; row < group.labels.size(); ++row) {
        OrderedJson errors = OrderedJson::object();
        for (const std::string& metric : metrics)
            errors[metric] = summary_json(
                summarise_metric(group, metric_values(group, row, metric)));
        json["rows"].push_back({{"label", group.labels[row]}, {"error", errors}});
    }
    return json;
}

std::string errors_csv(const std::vector<SweepGroup>& groups,
                       const std::vector<std::string>& metrics) {
    const std::vector<std::string> axes = axis_names(groups);
    std::vector<std::string> header = make_header(axes, {"view", "seed", "time", "label"});
    header.insert(header.end(), metrics.begin(), metrics.end());
    CsvTable table;
    table.add_line(header);
    for (const SweepGroup& group : groups) {
        std::vector<std::vector<std::vector<double>>> values(
            group.labels.size()); // by metric, view
        for (std::size_t row = 0; row < values.size(); ++row)
            for (const std::string& metric : metrics)
                values[row].push_back(metric_values(group, row, metric));
        for (std::size_t i = 0; i < group.pictures.size(); ++i)
            for (std::size_t row = 0; row < group.labels.size(); ++row) {
                const SweepJson& view = group.picture_pieces[i]->content["view"];
                std::vector<std::string> fields = group_fields(group, axes);
                for (const char* name : {"index", "seed", "time"})
                    fields.push_back(view.is_null() ? "" : view[name].dump());
                fields.push_back(group.labels[row]);
                for (const std::vector<double>& list : values[row])
                    fields.push_back(report::format_csv_number(list[i]));
                table.add_line(fields);
            }
    }
    return table.text();
}

std::string summary_csv(const std::vector<SweepGroup>& groups,
                        const std::vector<std::string>& metrics) {
    const std::vector<std::string> axes = axis_names(groups);
    std::vector<std::string> header = make_header(axes, {"label", "views"});
    for (const std::string& metric : metrics)
        for (const char* part : {"mean", "median", "low", "high", "largest"})
            header.push_back(metric + "_" + part);
    CsvTable table;
    table.add_line(header);
    for (const SweepGroup& group : groups)
        for (std::size_t row = 0; row < group.labels.size(); ++row) {
            std::vector<std::string> fields = group_fields(group, axes);
            fields.push_back(group.labels[row]);
            const std::vector<double> flip = metric_values(group, row, "flip");
            fields.push_back(std::to_string(summarise(flip).count));
            for (const std::string& metric : metrics) {
                const SweepSummary summary = summarise_metric(group,
                                                              metric_values(group, row, metric));
                for (const double value : {summary.mean, summary.median, summary.ci95.low,
                                           summary.ci95.high, summary.largest})
                    fields.push_back(report::format_csv_number(value));
            }
            table.add_line(fields);
        }
    return table.text();
}

} // namespace

SweepState check_sweep(const fs::path& folder, const SweepPlan& plan) {
    SweepState state{.pieces = plan.pieces.size()};
    std::error_code ignored;
    std::optional<PieceLockFile> locks;
    if (fs::exists(folder / "locks", ignored))
        locks.emplace(folder / "locks", PieceLockFile::Access::look);
    std::set<std::string> known;
    for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
        const SweepPiece& piece = plan.pieces[i];
        known.insert(result_file(folder, piece.id).filename().string());
        try {
            if (const std::optional<SweepJson> result = read_result(folder, piece)) {
                ++state.finished;
                add_identity(state.identities, (*result)["identity"]);
                continue;
            }
            const bool is_in_work = locks && locks->is_locked(i);
            (is_in_work ? state.in_work : state.missing).push_back(piece.id);
        } catch (const Error& error) {
            state.broken.emplace_back(piece.id, error.what());
        }
    }
    for (const auto& entry : fs::directory_iterator(folder / "results", ignored))
        if (const std::string name = entry.path().filename().string();
            !known.contains(name) && name.find(".partial-") == std::string::npos)
            state.unknown.push_back(entry.path().filename().string());
    std::ranges::sort(state.unknown);
    return state;
}

MergedSweep merge_sweep(const fs::path& folder, const SweepPlan& plan, AcrossIdentities across) {
    const SweepState state = check_sweep(folder, plan);
    check(state.is_complete(), Failure::bad_data, folder.string(), ": wanted the results of ",
          state.pieces, " pieces, found ", state.finished, "; 'catoptric sweep check ",
          folder.string(), "' names the others");
    const std::vector<SweepGroup> groups = read_groups(folder, plan);
    MergedSweep merged;
    std::map<SweepJson, std::vector<SweepJson>> devices; // identities by the options for the device
    for (const SweepGroup& group : groups)
        for (const SweepJson& result : group.pictures)
            add_identity(devices[device_options(result["piece"])], result["identity"]);
    for (auto& [device, identities] : devices) {
        std::ranges::sort(identities);
        merged.is_mixed = merged.is_mixed || identities.size() > 1;
        check(identities.size() == 1 || across == AcrossIdentities::allowed, Failure::bad_data,
              folder.string(), ": the pictures come from ", identities.size(), " identities (",
              describe_identities(identities),
              "); --across-identities merges them and says how much their pictures differ");
        for (std::size_t i = 0; i < identities.size(); ++i) {
            for (std::size_t k = i + 1; k < identities.size(); ++k)
                add_difference(folder, plan, device, identities[i], identities[k],
                               merged.difference);
            add_identity(merged.identities, identities[i]);
        }
    }

    const std::vector<std::string> metrics = sweep_metrics();
    OrderedJson document{{"schema", "catoptric/sweep-merged/1"}, {"sweep", plan.sweep}};
    document["identities"] = merged.identities;
    document["identity_difference"] = nullptr;
    if (merged.is_mixed)
        document["identity_difference"] = {{"pixels", merged.difference.pixels},
                                           {"share", merged.difference.share()}};
    document["groups"] = report::list_json(
        groups, [&](const SweepGroup& group) { return group_json(group, metrics); });
    merged.files = {{"errors.csv", errors_csv(groups, metrics)},
                    {"summary.csv", summary_csv(groups, metrics)}};
    for (auto& [name, content] : time_tables(groups))
        merged.files.emplace_back(std::move(name), std::move(content));
    merged.files.emplace_back("merged.json", report::serialise(document));
    return merged;
}

} // namespace catoptric::cli
