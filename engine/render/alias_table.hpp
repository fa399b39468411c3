#pragma once

#include <cstdint>
#include <vector>

namespace catoptric::render {

/// Cell of an alias table: the share of the cell that belongs to its own entry, and the entry to
/// which the rest belongs.
struct AliasCell {
    double share = 1;
    std::uint32_t rest = 0;
};

/// Returns the table for drawing entries by weight (Vose, "A Linear Algorithm for Generating Random
/// Numbers with a Given Distribution", 1991). The weights have mean 1. Costs O(n).
std::vector<AliasCell> make_alias_table(std::vector<double> weights);

} // namespace catoptric::render
