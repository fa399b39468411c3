#pragma once

#include "measure/picture.hpp"
#include "session/run.hpp"

namespace catoptric::session {

/// Returns the exposure in stops, rounded to thirds, that brings the picture's bright end to .8.
/// The bright end is the 95th percentile of Rec. 709 luminance over the picture's finite pixels.
/// Returns 0 if the percentile is not above 0.
double choose_exposure(const measure::Picture& picture);

/// Returns the exposure for the request's camera and first instant, from a ray-traced picture:
/// depth 4, longest side 128. The session shows the request's scene and loses its history. Costs
/// one small frame.
double measure_exposure(Session& session, const Request& request);

/// Finds the request's exposure if Request::auto_exposure asks for it.
void resolve_exposure(Session& session, Request& request);

} // namespace catoptric::session
