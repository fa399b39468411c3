#pragma once

#include "app/run.hpp"
#include "measure/picture.hpp"

namespace catoptric::app {

/// Stops, in thirds, that bring the 95th percentile of Rec. 709 luminance over the picture's finite
/// pixels to .8, or as near as thirds do; 0 for a picture whose percentile is not above 0.
double exposure_for(const measure::Picture& picture);

/// The same for the request's camera and first instant, ray traced: depth 4, longest side 128. The
/// session shows the request's scene; its history is forgotten. Costs one small frame.
double auto_exposure(Session& session, const Request& request);

/// Finds the request's exposure where it is still to be found.
void settle_exposure(Session& session, Request& request);

} // namespace catoptric::app
