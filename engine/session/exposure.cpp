#include "session/exposure.hpp"

#include "core/luminance.hpp"
#include "measure/statistics.hpp"
#include "scene/scene_overrides.hpp"
#include "session/scene_facts.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::app {

double exposure_for(const measure::Picture& picture) {
    constexpr double kPercentile = .95, kWanted = .8, kSteps = 3; // kSteps: per stop
    std::vector<double> luminances;
    for (const vec3& pixel : picture.pixels) {
        const double its = luminance(dvec3(pixel));
        if (std::isfinite(its)) luminances.push_back(its);
    }
    if (luminances.empty()) return 0;
    const double bright = measure::percentile(std::move(luminances), kPercentile);
    if (!(bright > 0)) return 0;
    const double stops = std::round(kSteps * std::log2(kWanted / bright)) / kSteps;
    return std::clamp(stops, -scene::kMostStops, scene::kMostStops) + 0.0; // turns -0 into 0
}

double auto_exposure(Session& session, const Request& request) {
    FrameSpec spec = request;
    spec.techniques = {"raytrace:depth=4"};
    spec.size = small_size(request.size);
    spec.time = request.instant(1);
    spec.exposure = 0;
    session.forget();
    const measure::Picture picture = session.frame(spec).hdr();
    session.forget();
    return exposure_for(picture);
}

void settle_exposure(Session& session, Request& request) {
    if (request.auto_exposure) request.exposure = auto_exposure(session, request);
    request.auto_exposure = false;
}

} // namespace catoptric::app
