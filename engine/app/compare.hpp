#pragma once

#include "app/engine.hpp"
#include "report/comparison.hpp"

namespace catoptric::app {

inline constexpr const char* kReference = "raytrace:depth=16";

struct CompareRequest {
    Request base; ///< its `techniques` are the rows; empty = default_techniques()
    std::string reference = kReference;
    bool together = false; ///< all rows in one frame
    bool causes = true;    ///< split each row's error by cause; only against the default reference
    bool lag = false; ///< also how far rows are behind a moving scene (app/lag.hpp): minutes a row
    std::vector<std::string> command; ///< for the record
    /// Called before each row with its label, number from 0 and the count; may be empty.
    std::function<void(const std::string&, std::size_t, std::size_t)> on_row;
};

/// The rows that each technique of the table names for itself (reflect::Technique::compared).
std::vector<std::string> default_techniques();
/// Throws `bad_data`, saying how to make one, where a scene has no mirror.
void check_has_mirror(const scene::Scene& scene);

/// Renders every row and the reference, measures speed and error. A row with `samples` is judged
/// against the reference at as many samples. After a stop signal the rows so far come back with
/// `complete` false.
report::Comparison compare(Engine& engine, const CompareRequest& request);

} // namespace catoptric::app
