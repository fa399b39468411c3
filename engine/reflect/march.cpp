// Marches along the reflected ray in steps of equal angle, then refines the crossing. It finds the
// first crossing, whereas `secant` may find any crossing.
#include "reflect/captures.hpp"

namespace catoptric::reflect {

namespace {

constexpr auto kKnobs = search_knobs(
    std::array{Knob{.name = "steps",
                    .help = "number of steps of equal angle along the reflected ray",
                    .low = 1,
                    .high = 256,
                    .value = 16}});

constexpr std::string_view kDefaultRows[] = {"march"};

constexpr Technique kTechnique{
    .name = "march",
    .summary =
        "Marches along the reflected ray in steps of equal angle and refines the first crossing.",
    .order = 12,
    .traits = {.captures = TechniqueTraits::Captures::shared},
    .knobs = kKnobs,
    .compared = kDefaultRows,
    .scene_passes = count_capture_passes,
    .capture = make_capture_options,
    .in_captures = "reflect/parallax.frag",
    .search = "reflect/march.frag"};
const RegisteredTechnique kRegistration{kTechnique};

} // namespace

} // namespace catoptric::reflect
