#pragma once

#include "measure/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

// Certificates of plans that `catoptric choose` made (docs/choose.md), in the report of a
// comparison.
namespace catoptric::app {

/// What the certificate in a file of a plan states.
struct PlanCertificate {
    std::string statement;  ///< "at least 95 % of views have flip <= 0.05, with ..."
    std::string scene_hash; ///< of the scene whose views were drawn; empty: not known
};

/// Returns the certificate of each row that a file of a plan draws, and nothing for other rows and
/// for files that prove nothing. `texts`: of the rows. Throws as read_technique_plan does.
std::vector<std::optional<PlanCertificate>>
read_plan_certificates(const std::vector<std::string>& texts);

/// Adds the certificates to the rows of the same places. There may be fewer rows.
void add_plan_certificates(const std::vector<std::optional<PlanCertificate>>& certificates,
                           measure::Comparison& comparison);

} // namespace catoptric::app
