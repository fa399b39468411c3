#include "measure/rows.hpp"

#include <algorithm>
#include <string>

namespace catoptric::measure {

namespace {

using SeedPart = TechniqueTraits::SeedPart;

bool has_knob_text(const Row& row, const KnobText& wanted) {
    return std::ranges::any_of(row.settings, [&](const Setting& setting) {
        return setting.name == wanted.knob && setting.text == wanted.text;
    });
}

bool has_default_knobs_except(const Row& row, std::span<const KnobText> wanted) {
    return std::ranges::all_of(row.settings, [&](const Setting& setting) {
        return !setting.changed ||
               std::ranges::find(wanted, setting.name, &KnobText::knob) != wanted.end();
    });
}

} // namespace

const Row* find_seed_row(const Comparison& comparison, TechniqueTraits::SeedPart part,
                         std::span<const KnobText> wanted) {
    const auto fits = [&](const Row& row) {
        return row.traits && row.traits->seed_part == part &&
               has_default_knobs_except(row, wanted) &&
               std::ranges::all_of(wanted,
                                   [&](const KnobText& one) { return has_knob_text(row, one); });
    };
    const auto found = std::ranges::find_if(comparison.rows, fits);
    return found == comparison.rows.end() ? nullptr : &*found;
}

const Row* find_parallax_row(const Comparison& comparison) {
    const KnobText wanted[] = {{"distance", "r32f"}};
    return find_seed_row(comparison, SeedPart::parallax, wanted);
}

const Row* find_ray_traced_row(const Comparison& comparison) {
    const KnobText wanted[] = {{"depth", "8"}, {"sphere", "mesh"}};
    return find_seed_row(comparison, SeedPart::rays, wanted);
}

const Row* find_naive_row(const Comparison& comparison, int bounces) {
    const std::string text = std::to_string(bounces);
    const KnobText wanted[] = {{"bounces", text}};
    return find_seed_row(comparison, SeedPart::bounces, wanted);
}

bool is_ray_traced(const Row& row) { return row.traits && row.traits->is_ray_traced(); }

} // namespace catoptric::measure
