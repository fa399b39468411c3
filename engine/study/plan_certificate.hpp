#pragma once

#include "measure/comparison.hpp"

#include <optional>
#include <string>
#include <vector>

// Functions that show certificates of plans, made by `catoptric choose` (docs/choose.md), in the
// report of a comparison.
namespace catoptric::study {

using namespace session;

/// The contents of a certificate in a plan's file.
struct PlanCertificate {
    std::string statement;  ///< "at least 95 % of views have flip <= 0.05, with ..."
    std::string scene_hash; ///< hash of the scene whose views were drawn; empty: not known
};

/// Returns the certificate of each row that is a plan from a file. Other rows, and files without a
/// proved plan, get none. `texts`: the texts of the rows. Throws as read_plan does.
std::vector<std::optional<PlanCertificate>>
read_certificates(const std::vector<std::string>& texts);

/// Adds each certificate to the row with the same index. There may be fewer rows than certificates.
void add_certificates(const std::vector<std::optional<PlanCertificate>>& certificates,
                      measure::Comparison& comparison);

} // namespace catoptric::study
