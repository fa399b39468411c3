#include "report/costs.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "report/json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::report {

namespace {

constexpr const char* kCostsSchema = "catoptric/costs/1";
constexpr const char* kMeasuredTimesSchema = "catoptric/times/1";
constexpr std::uintmax_t kMaxCostFileBytes = std::uintmax_t{16} << 20;
constexpr measure::CostOrigin kCostOrigins[] = {
    measure::CostOrigin::fitted, measure::CostOrigin::literature, measure::CostOrigin::given};

/// A value of a document, with its place for messages: "costs.json: costs[2].ns".
struct CostValue {
    const Json& json;
    std::string place;

    [[noreturn]] void fail_wanted(const std::string& wanted) const {
        fail(Failure::bad_data, place, ": wanted ", wanted, ", found ", describe_json_value(json));
    }
    CostValue member(const char* name) const {
        static const Json kNone;
        if (!json.is_object()) fail_wanted("an object");
        const auto found = json.find(name);
        return {found == json.end() ? kNone : *found,
                place + (place.ends_with(":") ? " " : ".") + name};
    }
    /// Throws `bad_data` for a member with another name, such as a misspelt one.
    void check_members(const std::vector<std::string>& names) const {
        if (!json.is_object()) fail_wanted("an object");
        for (const auto& [name, value] : json.items())
            check(std::ranges::find(names, name) != names.end(), Failure::bad_data, place,
                  place.ends_with(":") ? "" : ":", " wanted the members ",
                  fmt::format("{}", fmt::join(names, ", ")), ", found ", quote_printable(name));
    }
    std::vector<CostValue> elements() const {
        if (!json.is_array() || json.empty()) fail_wanted("a list with at least one entry");
        std::vector<CostValue> list;
        for (std::size_t i = 0; i < json.size(); ++i)
            list.push_back({json[i], place + "[" + std::to_string(i) + "]"});
        return list;
    }
    std::string text() const {
        if (!json.is_string() || json.get_ref<const std::string&>().empty()) fail_wanted("text");
        return json.get<std::string>();
    }
    /// Returns the text, or an empty one if the member is absent.
    std::string optional_text() const { return json.is_null() ? std::string() : text(); }
    double number(double low, const char* wanted) const {
        if (!json.is_number() || !std::isfinite(json.get<double>()) || json.get<double>() < low)
            fail_wanted(wanted);
        return json.get<double>();
    }
};

WorkKind read_kind(const CostValue& value) {
    const std::string name = value.text();
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) {
        if (kWorkKinds[i].name == name) return static_cast<WorkKind>(i);
        names.emplace_back(kWorkKinds[i].name);
    }
    fail(Failure::bad_data, value.place, ": wanted a kind of work, found '", name, "'",
         suggest_name(name, names));
}

measure::CostOrigin read_origin(const CostValue& value) {
    const std::string name = value.text();
    for (const measure::CostOrigin origin : kCostOrigins)
        if (measure::name_of(origin) == name) return origin;
    value.fail_wanted("fitted, literature or given");
}

measure::Interval read_range(const CostValue& value, double ns) {
    if (value.json.is_null()) return {};
    const std::vector<CostValue> ends = value.elements();
    if (ends.size() != 2) value.fail_wanted("two numbers");
    constexpr const char* kCostNumberText = "a number of at least 0";
    const measure::Interval range{ends[0].number(0, kCostNumberText),
                                  ends[1].number(0, kCostNumberText)};
    if (!(range.low <= ns && ns <= range.high))
        value.fail_wanted("a range around ns, " + std::to_string(ns));
    return range;
}

measure::UnitCost read_unit(const CostValue& value) {
    value.check_members({"work", "ns", "range", "source"});
    measure::UnitCost unit;
    unit.kind = read_kind(value.member("work"));
    unit.ns = value.member("ns").number(0, "nanoseconds of at least 0");
    unit.range = read_range(value.member("range"), unit.ns);
    unit.source = value.member("source").optional_text();
    return unit;
}

void check_schema(const CostValue& document, const char* wanted, const char* what) {
    const CostValue schema = document.member("schema");
    if (!schema.json.is_string() || schema.json.get_ref<const std::string&>() != wanted)
        schema.fail_wanted(std::string(what) + ", schema '" + wanted + "'");
}

Json read_document(const std::filesystem::path& file) {
    std::error_code error;
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    check(error || bytes <= kMaxCostFileBytes, Failure::bad_data, file.string(),
          ": wanted a file of at most ", kMaxCostFileBytes, " bytes, found ", bytes);
    return parse_json<Json>(file.string(), read_file(file));
}

measure::DeviceCosts read_costs_document(const Json& json, const std::string& file) {
    const CostValue document{json, file + ":"};
    check_schema(document, kCostsSchema, "costs of a device");
    document.check_members({"schema", "device", "origin", "note", "costs", "fit"});
    measure::DeviceCosts costs;
    costs.device = document.member("device").text();
    costs.origin = read_origin(document.member("origin"));
    costs.note = document.member("note").optional_text();
    for (const CostValue& value : document.member("costs").elements()) {
        const measure::UnitCost unit = read_unit(value);
        check(std::ranges::find(costs.units, unit.kind, &measure::UnitCost::kind) ==
                  costs.units.end(),
              Failure::bad_data, value.place, ".work: '",
              kWorkKinds[static_cast<std::size_t>(unit.kind)].name, "' is given twice");
        costs.units.push_back(unit);
    }
    return costs;
}

Json to_json(const measure::CostFit& fit) {
    Json json{{"rows", fit.samples.size()},
              {"within_20_percent", number_json(fit.fraction_within(1.2))},
              {"within_50_percent", number_json(fit.fraction_within(1.5))},
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
              {"origin", measure::name_of(costs.origin)}};
    if (!costs.note.empty()) json["note"] = costs.note;
    json["costs"] = list_json(costs.units, [](const measure::UnitCost& unit) {
        Json one{{"work", kWorkKinds[static_cast<std::size_t>(unit.kind)].name},
                 {"ns", number_json(unit.ns)}};
        if (unit.range.is_known()) one["range"] = interval_json(unit.range);
        if (!unit.source.empty()) one["source"] = unit.source;
        return one;
    });
    if (costs.fit) json["fit"] = to_json(*costs.fit);
    return serialise_json(json);
}

measure::DeviceCosts read_costs(const std::string& text, const std::string& file) {
    return read_costs_document(parse_json<Json>(file, text), file);
}

measure::DeviceCosts read_costs_file(const std::filesystem::path& file) {
    return read_costs_document(read_document(file), file.string());
}

TimesElsewhere read_times_file(const std::filesystem::path& file) {
    const Json json = read_document(file);
    const CostValue document{json, file.string() + ":"};
    check_schema(document, kMeasuredTimesSchema, "times of rows");
    document.check_members({"schema", "device", "note", "work", "rows"});
    TimesElsewhere times;
    times.device = document.member("device").text();
    times.note = document.member("note").optional_text();
    for (const CostValue& kind : document.member("work").elements())
        times.kinds.push_back(read_kind(kind));
    for (const CostValue& row : document.member("rows").elements()) {
        row.check_members({"technique", "ms"});
        times.rows.push_back({row.member("technique").text(),
                              row.member("ms").number(1e-6, "milliseconds above 0")});
    }
    return times;
}

} // namespace catoptric::report
