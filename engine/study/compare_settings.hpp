#pragma once

#include "compare.hpp"
#include "report/comparison.hpp"

namespace catoptric::study {

using namespace session;

/// Returns the request, in which the default reference is replaced by the reference for the scene.
CompareRequest replace_auto_reference(CompareRequest request);

/// Fills what is known of a comparison before anything is rendered: program, scene, picture, number
/// of frames, and reference. `exposure` is NaN if it must still be found. `request` names its
/// reference (replace_auto_reference).
void fill_settings(const CompareRequest& request, report::Comparison& comparison);

} // namespace catoptric::study
