#pragma once

#include "report/stress.hpp"
#include "stress/bench.hpp"

#include <span>
#include <string_view>

/// The table of properties that pictures must have at the extremes of what a scene or a user may
/// ask. A property is one row that registers itself; nothing else lists it.
namespace catoptric::stress {

struct Property {
    std::string_view id, stimulus, property;
    /// Renders its scenes and adds cases to the row.
    void (*judge)(Bench& bench) = nullptr;
    /// Name of the rule in tests/mutations/rules.toml: wrong code that turns this row red.
    std::string_view turned_red_by = {};
    std::string_view not_covered = {}; ///< what of the property this does not look at
};

/// A namespace-scope Registered puts its property into the table while the program starts.
struct Registered {
    explicit Registered(const Property& property);
};

/// Every property in the order of its id: letter, then number.
std::vector<const Property*> properties();
/// Throws `Failure::usage` with the nearest id.
const Property& find_property(std::string_view id);

} // namespace catoptric::stress
