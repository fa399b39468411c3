#pragma once

#include "report/stress.hpp"
#include "stress/bench.hpp"

#include <span>
#include <string_view>

/// Table of stress properties, which pictures must have in extreme scenes and with extreme options.
/// A property is one row that registers itself, so no other file lists it.
namespace catoptric::stress {

struct Property {
    std::string_view id, stimulus, property;
    /// Renders its scenes and adds cases to the row.
    void (*judge)(Bench& bench) = nullptr;
    /// Name of the rule in tests/mutations/rules.toml whose wrong code makes this row fail.
    std::string_view turned_red_by = {};
    std::string_view not_covered = {}; ///< part of the property that `judge` does not check
};

/// Registers a property. Define it at namespace scope: the property enters the table while the
/// program starts.
struct RegisteredProperty {
    explicit RegisteredProperty(const Property& property);
};

/// Returns all properties in the order of their ids: letter, then number.
std::vector<const Property*> properties();
/// Returns the property with this id. Throws `Failure::usage` with the nearest id if there is none.
const Property& find_property(std::string_view id);

} // namespace catoptric::stress
