// Writes how far a reference is from path tracing.
#include "measure/path_distance.hpp"

#include "core/text.hpp"
#include "measure/judge.hpp"
#include "report/json.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

/// Returns how many ranked rows have a FLIP over the mirrors below the limit, against the
/// reference.
std::size_t count_rows_below(const std::vector<Row>& rows, double limit) {
    return static_cast<std::size_t>(std::ranges::count_if(
        rows, [&](const Row& row) { return measure::is_rankable(row) && row.error.flip < limit; }));
}

std::string describe_rows_below(const std::vector<Row>& rows, std::size_t less) {
    if (less == 0) return "";
    if (less == rows.size()) return " All rows are closer to the reference than that.";
    return fmt::format(" {} of {} rows {} closer to the reference than that.", less, rows.size(),
                       less == 1 ? "is" : "are");
}

} // namespace

std::string describe_path_distance(const measure::PathDistance& distance,
                                   const std::vector<Row>& rows) {
    if (!distance.is_known())
        return fmt::format("How far the reference itself is from path tracing is not known: {}. To "
                           "find out: {}, with the same options for scene and camera.",
                           distance.unknown, escape(distance.command));
    const bool shows_mirror = !std::isnan(distance.flip);
    const measure::Interval interval = measure::distance_interval(distance);
    const std::string where = fmt::format(
        "{}, {}x{}, {} paths a pixel{}",
        shows_mirror ? "over the mirrors" : "over the picture, which shows no mirror",
        distance.width, distance.height, distance.paths, distance.is_kept ? ", kept" : "");
    if (interval.low <= 0)
        return fmt::format("The reference itself is at most FLIP {} from path tracing ({}).",
                           format_fixed(interval.high, 3), where);
    const std::size_t less = shows_mirror ? count_rows_below(rows, interval.low) : 0;
    return fmt::format("The reference itself, whose light is simplified, is FLIP {} [{} - {}] from "
                       "path tracing ({}).{} To judge rows by path tracing: {}.",
                       format_fixed(shows_mirror ? distance.flip : distance.flip_all, 3),
                       format_fixed(interval.low, 3), format_fixed(interval.high, 3), where,
                       describe_rows_below(rows, less), escape(distance.command));
}

Json path_distance_json(const measure::PathDistance& distance) {
    const bool known = distance.is_known();
    Json json{{"known", known},
              {"flip", number_json(distance.flip)},
              {"noise", number_json(distance.noise)},
              {"flip_all", number_json(distance.flip_all)},
              {"noise_all", number_json(distance.noise_all)},
              {"interval",
               interval_json(known ? measure::distance_interval(distance) : measure::Interval())},
              {"size", Json::array({distance.width, distance.height})},
              {"paths", distance.paths},
              {"seconds", number_json(distance.seconds)},
              {"most_seconds", number_json(distance.most_seconds)},
              {"kept", distance.is_kept}};
    if (!known) json["why"] = distance.unknown;
    json["command"] = distance.command;
    return json;
}

} // namespace catoptric::report
