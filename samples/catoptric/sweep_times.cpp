#include "sweep_times.hpp"

#include "report/json.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace catoptric::cli {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// The times of one row on one machine, from the rounds of all timing pieces.
struct SweepTime {
    SweepJson machine, identity;
    std::string label;
    std::string date;           ///< when the last piece was measured, such as 2026-11-24T03:05:10Z
    std::vector<double> rounds; ///< times of the rounds of all pieces
    std::vector<double> pieces; ///< median time of each piece
    std::vector<double> ratios; ///< in each piece, this median over that of the first row
    bool noisy = false;
    bool is_ranked = true; ///< false for a row that leaves mirrors black

    /// Returns the median time with its interval. The interval counts pieces if there are enough,
    /// and otherwise rounds.
    SweepSummary summary() const {
        const bool has_pieces = pieces.size() >= measure::kMinIntervalSamples;
        return summarise(has_pieces ? pieces : rounds);
    }
};

/// Returns a member of an identity as text; empty if the member is no text.
std::string identity_text(const SweepJson& identity, const char* member) {
    const SweepJson value = identity.value(member, SweepJson());
    return value.is_string() ? value.get<std::string>() : "";
}

/// Adds the table cells of an identity: device, driver and commit.
void add_identity_fields(std::vector<std::string>& fields, const SweepJson& identity) {
    for (const char* member : {"device", "driver", "commit"})
        fields.push_back(identity_text(identity, member));
}

std::vector<SweepTime> list_times(const SweepGroup& group) {
    std::vector<SweepTime> times;
    for (const SweepJson& result : group.timings) {
        double first_row_ms = NAN;
        for (const SweepJson& row : result["rows"]) {
            const auto label = row.at("label").get<std::string>();
            const auto known = std::ranges::find_if(times, [&](const SweepTime& time) {
                return time.label == label && time.machine == result["machine"] &&
                       time.identity == result["identity"];
            });
            SweepTime& time = known != times.end() ? *known : times.emplace_back();
            time.label = label, time.machine = result["machine"];
            time.identity = result["identity"];
            time.date = std::max(time.date, result["date"].get<std::string>());
            time.noisy = time.noisy || row.at("noisy").get<bool>();
            time.is_ranked = time.is_ranked && row.value("ranked", true);
            std::vector<double> rounds = row.at("rounds");
            time.rounds.insert(time.rounds.end(), rounds.begin(), rounds.end());
            time.pieces.push_back(summarise(std::move(rounds)).median);
            if (&row == &result["rows"].front()) first_row_ms = time.pieces.back();
            if (first_row_ms > 0) time.ratios.push_back(time.pieces.back() / first_row_ms);
        }
    }
    return times;
}

/// The times of one row on several machines of one identity. Each machine counts once, however many
/// pieces it ran.
struct MachinesTime {
    SweepJson identity;
    std::string label;
    std::vector<double> ms;     ///< each machine's median time
    std::vector<double> ratios; ///< each machine's median ratio to the first row
    bool noisy = false;
};

/// Returns the times of each row over machines, for identities with at least two machines.
std::vector<MachinesTime> machine_times(const SweepGroup& group) {
    std::vector<MachinesTime> list;
    for (const SweepTime& time : list_times(group)) {
        const auto known = std::ranges::find_if(list, [&](const MachinesTime& machines) {
            return machines.label == time.label && machines.identity == time.identity;
        });
        MachinesTime& machines = known != list.end() ? *known : list.emplace_back();
        machines.label = time.label, machines.identity = time.identity;
        machines.ms.push_back(time.summary().median);
        machines.ratios.push_back(summarise(time.ratios).median);
        machines.noisy = machines.noisy || time.noisy;
    }
    std::erase_if(list, [](const MachinesTime& machines) { return machines.ms.size() < 2; });
    return list;
}

OrderedJson machines_json(const std::vector<double>& values) {
    const SweepSummary summary = summarise(values);
    return {{"median", report::number_json(summary.median)},
            {"ci95", report::interval_json(summary.ci95)},
            {"least", report::number_json(summary.least)},
            {"largest", report::number_json(summary.largest)},
            {"machines", report::numbers_json(values)}};
}

OrderedJson times_json(const std::vector<SweepGroup>& groups) {
    OrderedJson list = OrderedJson::array();
    for (const SweepGroup& group : groups)
        for (const SweepTime& time : list_times(group)) {
            const SweepSummary summary = time.summary();
            list.push_back(
                {{"scene", group.scene},
                 {"options", group.options},
                 {"label", time.label},
                 {"machine", time.machine},
                 {"identity", time.identity},
                 {"ms", report::number_json(summary.median)},
                 {"ci95", report::interval_json(summary.ci95)},
                 {"rounds", time.rounds},
                 {"pieces", time.pieces},
                 {"interval_over",
                  time.pieces.size() >= measure::kMinIntervalSamples ? "pieces" : "rounds"},
                 {"noisy", time.noisy}});
        }
    OrderedJson over_machines = OrderedJson::array();
    for (const SweepGroup& group : groups)
        for (const MachinesTime& machines : machine_times(group))
            over_machines.push_back({{"scene", group.scene},
                                     {"options", group.options},
                                     {"label", machines.label},
                                     {"identity", machines.identity},
                                     {"ms", machines_json(machines.ms)},
                                     {"ratio", machines_json(machines.ratios)},
                                     {"noisy", machines.noisy}});
    return {
        {"schema", "catoptric/sweep-times/1"}, {"times", list}, {"over_machines", over_machines}};
}

std::string times_csv(const std::vector<SweepGroup>& groups) {
    const std::vector<std::string> axes = axis_names(groups);
    CsvTable table;
    table.add_line(make_header(axes, {"label", "machine", "device", "driver", "commit", "ms",
                                      "ms_low", "ms_high", "pieces", "rounds", "noisy"}));
    for (const SweepGroup& group : groups)
        for (const SweepTime& time : list_times(group)) {
            const SweepSummary summary = time.summary();
            std::vector<std::string> fields = group_fields(group, axes);
            fields.insert(fields.end(), {time.label, time.machine.get<std::string>()});
            add_identity_fields(fields, time.identity);
            for (const double value : {summary.median, summary.ci95.low, summary.ci95.high})
                fields.push_back(report::format_csv_number(value));
            fields.insert(fields.end(),
                          {std::to_string(time.pieces.size()), std::to_string(time.rounds.size()),
                           time.noisy ? "true" : "false"});
            table.add_line(fields);
        }
    return table.text();
}

std::string machines_csv(const std::vector<SweepGroup>& groups) {
    const std::vector<std::string> axes = axis_names(groups);
    CsvTable table;
    table.add_line(
        make_header(axes, {"label", "device", "driver", "commit", "machines", "ms", "ms_low",
                           "ms_high", "ms_least", "ms_largest", "ratio", "ratio_low", "ratio_high",
                           "ratio_least", "ratio_largest", "noisy"}));
    for (const SweepGroup& group : groups)
        for (const MachinesTime& machines : machine_times(group)) {
            std::vector<std::string> fields = group_fields(group, axes);
            fields.push_back(machines.label);
            add_identity_fields(fields, machines.identity);
            fields.push_back(std::to_string(machines.ms.size()));
            for (const std::vector<double>& values : {machines.ms, machines.ratios}) {
                const SweepSummary summary = summarise(values);
                for (const double value : {summary.median, summary.ci95.low, summary.ci95.high,
                                           summary.least, summary.largest})
                    fields.push_back(report::format_csv_number(value));
            }
            fields.emplace_back(machines.noisy ? "true" : "false");
            table.add_line(fields);
        }
    return table.text();
}

/// Returns the options that all groups share, and the number of views, as text.
std::string describe_sweep_setting(const SweepGroup& group, const std::vector<std::string>& axes) {
    std::string text;
    for (const auto& [name, value] : group.options.items())
        if (std::ranges::find(axes, name) == axes.end())
            text += fmt::format("{} {}, ", name,
                                value.is_string() ? value.get<std::string>() : value.dump());
    const std::size_t views = group.pictures.size();
    text += fmt::format("median of {} {}", views, views == 1 ? "view" : "views");
    if (has_dependent_views(group)) text += fmt::format(" of {} instants", count_instants(group));
    return text;
}

std::string describe_axis_values(const SweepGroup& group, const std::vector<std::string>& axes) {
    std::string text;
    for (const std::string& axis : axes) {
        const SweepJson value = group.options.value(axis, SweepJson());
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", axis,
                            value.is_string() ? value.get<std::string>() : value.dump());
    }
    return text;
}

/// A row of a sweep on a site of results: its time on a machine, and its errors over the views.
struct SweepSiteRow {
    std::string label;
    SweepSummary ms, flip, rmse;
    bool is_ranked;
};

/// Returns the rows of a group that were timed on the machine and with the identity of `machine`.
std::vector<SweepSiteRow> site_rows(const SweepGroup& group, const std::vector<SweepTime>& times,
                                    const SweepTime& machine) {
    std::vector<SweepSiteRow> rows;
    for (std::size_t row = 0; row < group.labels.size(); ++row)
        for (const SweepTime& time : times)
            if (time.label == group.labels[row] && time.machine == machine.machine &&
                time.identity == machine.identity)
                rows.push_back({time.label, time.summary(),
                                summarise_metric(group, metric_values(group, row, "flip")),
                                summarise_metric(group, metric_values(group, row, "rmse")),
                                time.is_ranked});
    return rows;
}

/// Returns the indices of the rows that no other row beats in both median time and median FLIP.
/// Rows that leave mirrors black are never among them.
std::vector<std::size_t> find_front(const std::vector<SweepSiteRow>& rows) {
    std::vector<std::size_t> front;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const double ms = rows[i].ms.median, flip = rows[i].flip.median;
        const bool beaten = std::ranges::any_of(rows, [&](const SweepSiteRow& other) {
            return other.is_ranked && other.ms.median <= ms && other.flip.median <= flip &&
                   (other.ms.median < ms || other.flip.median < flip);
        });
        if (rows[i].is_ranked && !std::isnan(flip) && !beaten) front.push_back(i);
    }
    return front;
}

OrderedJson site_row_json(const SweepSiteRow& row) {
    return {{"label", row.label},
            {"gpu_ms",
             {{"median", report::number_json(row.ms.median)},
              {"ci95", report::interval_json(row.ms.ci95)}}},
            {"error",
             {{"flip", report::number_json(row.flip.median)},
              {"rmse", report::number_json(row.rmse.median)}}},
            {"flip_ci95", report::interval_json(row.flip.ci95)}};
}

OrderedJson results_json(const std::vector<SweepGroup>& groups) {
    const std::vector<std::string> axes = axis_names(groups);
    OrderedJson comparisons = OrderedJson::array();
    for (const SweepGroup& group : groups) {
        const std::vector<SweepTime> times = list_times(group);
        for (const SweepTime& machine : times) {
            if (machine.label != group.labels.front()) continue; // each machine once
            const std::vector<SweepSiteRow> rows = site_rows(group, times, machine);
            const SweepJson& content = group.timing_pieces.front()->content;
            OrderedJson json;
            json["scene"] = {{"name", group.scene}, {"hash", content["scene_hash"]}};
            json["device"] = {{"name", identity_text(machine.identity, "device")},
                              {"driver", identity_text(machine.identity, "driver")}};
            json["machine"] = machine.machine;
            for (const char* name : {"commit", "version"})
                json[name] = identity_text(machine.identity, name);
            json["date"] = machine.date;
            json["setting"] = describe_sweep_setting(group, axes);
            json["section"] = describe_axis_values(group, axes);
            json["rows"] = report::list_json(rows, site_row_json);
            json["pareto"] = find_front(rows);
            comparisons.push_back(json);
        }
    }
    return {{"schema", "catoptric/sweep-results/1"}, {"comparisons", comparisons}};
}

} // namespace

std::vector<std::pair<std::string, std::string>>
time_tables(const std::vector<SweepGroup>& groups) {
    if (std::ranges::all_of(groups, [](const SweepGroup& group) { return group.timings.empty(); }))
        return {};
    return {{"times.json", report::serialise(times_json(groups))},
            {"times.csv", times_csv(groups)},
            {"machines.csv", machines_csv(groups)},
            {"results.json", report::serialise(results_json(groups))}};
}

} // namespace catoptric::cli
