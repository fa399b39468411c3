#include "technique.hpp"

#include "core/error.hpp"
#include "gpu/shader.hpp"
#include "reflect/captures.hpp"
#include "reflect/plan.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>

namespace catoptric::session {

namespace {

/// Storage that a row of the technique table points into.
struct StoredRow {
    Search search;
    std::vector<Knob> knobs;
    std::vector<std::string_view> compared;
    reflect::Technique row;
};

bool is_word(const std::string& name) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    };
    return !name.empty() && std::ranges::all_of(name, fits);
}

void check_search(const Search& search) {
    check(is_word(search.name), Failure::usage, "technique '", search.name,
          "': wanted a name of small letters, digits and '_'");
    for (const reflect::Technique* row : reflect::techniques())
        check(row->name != search.name, Failure::usage, "there is a technique '", search.name,
              "' already");
    check(search.name != reflect::kAutoPlanName, Failure::usage, "'", search.name,
          "' is the plan that the program chooses: wanted another name");
    for (const std::string& row : search.compared)
        check(row == search.name || row.starts_with(search.name + ":"), Failure::usage,
              "technique '", search.name, "': wanted rows of its own to compare, found '", row,
              "'");
    for (const SearchKnob& knob : search.knobs) {
        check(is_word(knob.name), Failure::usage, "technique '", search.name, "': knob '",
              knob.name, "': wanted a name of small letters, digits and '_'");
        const double most = std::numeric_limits<std::uint32_t>::max();
        check(knob.is_real ||
                  (knob.low >= 0 && knob.high <= most && knob.value == std::floor(knob.value)),
              Failure::usage, "technique '", search.name, "': knob '", knob.name,
              "': wanted whole numbers from 0 to ", std::numeric_limits<std::uint32_t>::max(),
              ", found ", knob.low, " to ", knob.high, " and ", knob.value,
              "; is_real allows others");
        check(knob.low <= knob.value && knob.value <= knob.high, Failure::usage, "technique '",
              search.name, "': knob '", knob.name, "': wanted a value from ", knob.low, " to ",
              knob.high, ", found ", knob.value);
    }
}

/// Returns the search's own knobs, followed by the knobs of all searches. Knobs of continuing
/// searches are included only if the search continues.
std::vector<Knob> search_knobs(const Search& search) {
    constexpr std::array<std::string_view, 3> kContinueKnobNames{"continue", "captures", "mirrors"};
    std::vector<Knob> knobs;
    const auto check_new = [&](std::string_view name) {
        check(std::ranges::find(knobs, name, &Knob::name) == knobs.end(), Failure::usage,
              "technique '", search.name, "' has two knobs '", name, "'");
    };
    for (const SearchKnob& own : search.knobs) {
        check_new(own.name);
        knobs.push_back({.name = own.name,
                         .help = own.help,
                         .low = own.low,
                         .high = own.high,
                         .value = own.value,
                         .is_real = own.is_real});
    }
    for (const Knob& knob : reflect::kSearchKnobs) {
        // The name is refused even if the technique lacks this knob, because shared code would read
        // the name as the shared knob.
        check_new(knob.name);
        if (search.continues ||
            std::ranges::find(kContinueKnobNames, knob.name) == kContinueKnobNames.end())
            knobs.push_back(knob);
    }
    return knobs;
}

} // namespace

RegisteredShaders::RegisteredShaders(std::span<const Shader> builds) {
    for (const Shader& build : builds) gpu::add_shader({build.name, build.words});
}

void add_search(Search search) {
    static std::deque<StoredRow> all; // a deque, because rows must not move in memory
    check_search(search);
    static_cast<void>(search_knobs(search)); // throws before anything is stored
    StoredRow& row = all.emplace_back();
    row.search = std::move(search);
    row.knobs = search_knobs(row.search);
    if (row.search.compared.empty()) row.search.compared.push_back(row.search.name);
    row.compared.assign(row.search.compared.begin(), row.search.compared.end());
    row.row = {.name = row.search.name,
               .summary = row.search.summary,
               .order = row.search.order,
               .traits = {.captures = TechniqueTraits::Captures::shared},
               .knobs = row.knobs,
               .compared = row.compared,
               .scene_passes = reflect::count_capture_passes,
               .capture = reflect::make_capture_options,
               .in_captures = "reflect/parallax.frag",
               .reads_whole_cubes = true, // the search may look anywhere in the capture
               .search = row.search.shader.c_str()};
    reflect::RegisteredTechnique{row.row};
}

} // namespace catoptric::session
