#include "report/costs.hpp"

#include "core/error.hpp"
#include "core/json.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "report/json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

constexpr const char* kCostsSchema = "catoptric/costs/1";
constexpr const char* kTimesSchema = "catoptric/times/1";
constexpr const char* kRowTimesSchema = "catoptric/row-times/1";
constexpr double kLeastMs = 1e-6;
constexpr const char* kMsText = "milliseconds above 0";
constexpr std::uintmax_t kMaxCostFileBytes = std::uintmax_t{16} << 20;
constexpr measure::CostOrigin kCostOrigins[] = {
    measure::CostOrigin::fitted, measure::CostOrigin::literature, measure::CostOrigin::given};

/// A value of a document, with its place for messages: "costs.json: costs[2].ns".
struct CostValue {
    const Json& json;
    std::string place;

    [[noreturn]] void fail_expecting(const std::string& wanted) const {
        fail(Failure::bad_data, place, ": wanted ", wanted, ", found ", describe(json));
    }
    CostValue find_member(const char* name) const {
        static const Json kNone;
        if (!json.is_object()) fail_expecting("an object");
        const auto found = json.find(name);
        return {found == json.end() ? kNone : *found,
                place + (place.ends_with(":") ? " " : ".") + name};
    }
    /// Throws `bad_data` for a member with another name, such as a misspelt one.
    void check_members(const std::vector<std::string>& names) const {
        if (!json.is_object()) fail_expecting("an object");
        for (const auto& [name, value] : json.items())
            check(std::ranges::find(names, name) != names.end(), Failure::bad_data, place,
                  place.ends_with(":") ? "" : ":", " wanted the members ",
                  fmt::format("{}", fmt::join(names, ", ")), ", found ", quote(name));
    }
    std::vector<CostValue> elements() const {
        if (!json.is_array() || json.empty()) fail_expecting("a list with at least one entry");
        std::vector<CostValue> list;
        for (std::size_t i = 0; i < json.size(); ++i)
            list.push_back({json[i], place + "[" + std::to_string(i) + "]"});
        return list;
    }
    std::string read_text() const {
        if (!json.is_string() || json.get_ref<const std::string&>().empty()) fail_expecting("text");
        return json.get<std::string>();
    }
    std::string text_or_empty() const { return json.is_null() ? std::string() : read_text(); }
    double read_number(double low, const char* wanted) const {
        if (!json.is_number() || !std::isfinite(json.get<double>()) || json.get<double>() < low)
            fail_expecting(wanted);
        return json.get<double>();
    }
};

WorkKind read_work_kind(const CostValue& value) {
    const std::string name = value.read_text();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) {
        if (kWorkKinds[i].name == name) return static_cast<WorkKind>(i);
        names.emplace_back(kWorkKinds[i].name);
    }
    fail(Failure::bad_data, value.place, ": wanted a kind of work, found '", name, "'",
         suggest_name(name, names));
}

measure::CostOrigin read_origin(const CostValue& value) {
    const std::string name = value.read_text();
    for (const measure::CostOrigin origin : kCostOrigins)
        if (measure::cost_origin_name(origin) == name) return origin;
    value.fail_expecting("fitted, literature or given");
}

measure::Interval read_range(const CostValue& value, double ns) {
    if (value.json.is_null()) return {};
    const std::vector<CostValue> ends = value.elements();
    if (ends.size() != 2) value.fail_expecting("two numbers");
    constexpr const char* kCostNumberText = "a number of at least 0";
    const measure::Interval range{ends[0].read_number(0, kCostNumberText),
                                  ends[1].read_number(0, kCostNumberText)};
    if (!(range.low <= ns && ns <= range.high))
        value.fail_expecting("a range around ns, " + std::to_string(ns));
    return range;
}

measure::UnitCost read_unit_cost(const CostValue& value) {
    value.check_members({"work", "ns", "range", "source"});
    measure::UnitCost unit;
    unit.kind = read_work_kind(value.find_member("work"));
    unit.ns = value.find_member("ns").read_number(0, "nanoseconds of at least 0");
    unit.range = read_range(value.find_member("range"), unit.ns);
    unit.source = value.find_member("source").text_or_empty();
    return unit;
}

void check_schema(const CostValue& document, const char* wanted, const char* what) {
    const CostValue schema = document.find_member("schema");
    if (!schema.json.is_string() || schema.json.get_ref<const std::string&>() != wanted)
        schema.fail_expecting(std::string(what) + ", schema '" + wanted + "'");
}

Json read_costs_json(const std::filesystem::path& file, const char* what) {
    return parse_json<Json>(file.string(), read_json_text(file, what, kMaxCostFileBytes));
}

measure::FitQuality read_fit(const CostValue& value) {
    measure::FitQuality fit;
    for (const CostValue& row : value.find_member("left_out").elements()) {
        fit.samples.push_back({row.find_member("row").read_text(),
                               {},
                               row.find_member("measured_ms").read_number(kLeastMs, kMsText)});
        fit.left_out_ms.push_back(
            row.find_member("predicted_ms").read_number(0, "milliseconds of at least 0"));
    }
    return fit;
}

measure::DeviceCosts read_costs_document(const Json& json, const std::string& file) {
    const CostValue document{json, file + ":"};
    check_schema(document, kCostsSchema, "costs of a device");
    document.check_members({"schema", "device", "origin", "note", "costs", "fit"});
    measure::DeviceCosts costs;
    costs.device = document.find_member("device").read_text();
    costs.origin = read_origin(document.find_member("origin"));
    costs.note = document.find_member("note").text_or_empty();
    for (const CostValue& value : document.find_member("costs").elements()) {
        const measure::UnitCost unit = read_unit_cost(value);
        check(std::ranges::find(costs.units, unit.kind, &measure::UnitCost::kind) ==
                  costs.units.end(),
              Failure::bad_data, value.place, ".work: '",
              kWorkKinds[static_cast<std::size_t>(unit.kind)].name, "' is given twice");
        costs.units.push_back(unit);
    }
    if (const CostValue fit = document.find_member("fit"); !fit.json.is_null())
        costs.fit = read_fit(fit);
    return costs;
}

Json to_json(const measure::FitQuality& fit) {
    Json json{{"rows", fit.samples.size()},
              {"within_20_percent", number_json(fit.share_within(1.2))},
              {"within_50_percent", number_json(fit.share_within(1.5))},
              {"left_out", Json::array()}};
    for (std::size_t i = 0; i < fit.samples.size(); ++i)
        json["left_out"].push_back({{"row", fit.samples[i].name},
                                    {"measured_ms", number_json(fit.samples[i].ms)},
                                    {"predicted_ms", number_json(fit.left_out_ms[i])}});
    return json;
}

} // namespace

std::string to_json(const measure::DeviceCosts& costs) {
    Json json{{"schema", kCostsSchema},
              {"device", costs.device},
              {"origin", measure::cost_origin_name(costs.origin)}};
    if (!costs.note.empty()) json["note"] = costs.note;
    json["costs"] = list_json(costs.units, [](const measure::UnitCost& unit) {
        Json one{{"work", kWorkKinds[static_cast<std::size_t>(unit.kind)].name},
                 {"ns", number_json(unit.ns)}};
        if (unit.range.is_known()) one["range"] = interval_json(unit.range);
        if (!unit.source.empty()) one["source"] = unit.source;
        return one;
    });
    if (costs.fit) json["fit"] = to_json(*costs.fit);
    return serialise(json);
}

measure::DeviceCosts read_device_costs(const std::string& text, const std::string& file) {
    return read_costs_document(parse_json<Json>(file, text), file);
}

measure::DeviceCosts read_costs_file(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) {
        std::vector<std::string> names;
        for (const KnownCosts& known : list_known_costs()) {
            if (known.name == file) return read_device_costs(std::string(known.text), known.name);
            names.push_back(known.name);
        }
        fail(Failure::missing_input, file.string(),
             ": there is no such file: wanted costs of a device, as a file or one of ",
             fmt::format("{}", fmt::join(names, ", ")), suggest_name(file.string(), names));
    }
    return read_costs_document(read_costs_json(file, "costs of a device"), file.string());
}

OtherDeviceTimes read_times_file(const std::filesystem::path& file) {
    const Json json = read_costs_json(file, "times of rows");
    const CostValue document{json, file.string() + ":"};
    check_schema(document, kTimesSchema, "times of rows");
    document.check_members({"schema", "device", "note", "work", "rows"});
    OtherDeviceTimes times;
    times.device = document.find_member("device").read_text();
    times.note = document.find_member("note").text_or_empty();
    for (const CostValue& kind : document.find_member("work").elements())
        times.kinds.push_back(read_work_kind(kind));
    for (const CostValue& row : document.find_member("rows").elements()) {
        row.check_members({"technique", "ms"});
        times.rows.push_back({row.find_member("technique").read_text(),
                              row.find_member("ms").read_number(kLeastMs, kMsText)});
    }
    return times;
}

RowTimes read_row_times(const std::filesystem::path& file) {
    const Json json = read_costs_json(file, "times of rows");
    const CostValue document{json, file.string() + ":"};
    check_schema(document, kRowTimesSchema, "times of rows");
    document.check_members({"schema", "device", "note", "rows"});
    RowTimes times;
    times.device = document.find_member("device").read_text();
    times.note = document.find_member("note").text_or_empty();
    for (const CostValue& row : document.find_member("rows").elements()) {
        row.check_members({"row", "ms"});
        auto& [name, list] = times.rows.emplace_back();
        name = row.find_member("row").read_text();
        check(std::ranges::count(times.rows, name, &RowTimes::TimedRow::row) == 1,
              Failure::bad_data, row.place, ": wanted each row once, found ", quote(name),
              " again");
        const CostValue ms = row.find_member("ms");
        if (ms.json.is_array())
            for (const CostValue& one : ms.elements())
                list.push_back(one.read_number(kLeastMs, kMsText));
        else
            list.push_back(ms.read_number(kLeastMs, "milliseconds above 0, or a list of them"));
    }
    return times;
}

} // namespace catoptric::report
