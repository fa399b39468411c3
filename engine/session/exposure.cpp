#include "session/exposure.hpp"

#include "core/luminance.hpp"
#include "measure/statistics.hpp"
#include "scene/scene_overrides.hpp"
#include "session/scene_info.hpp"

#include <algorithm>
#include <cmath>

namespace catoptric::session {

double choose_exposure(const measure::Picture& picture) {
    constexpr double kAutoExposurePercentile = .95, kTargetValue = .8,
                     kExposureStepsPerStop = 3; // exposures are rounded to thirds of a stop
    std::vector<double> luminances;
    for (const vec3& pixel : picture.pixels) {
        const double its = luminance(dvec3(pixel));
        if (std::isfinite(its)) luminances.push_back(its);
    }
    if (luminances.empty()) return 0;
    const double bright = measure::percentile(std::move(luminances), kAutoExposurePercentile);
    if (!(bright > 0)) return 0;
    const double stops = std::round(kExposureStepsPerStop * std::log2(kTargetValue / bright)) /
                         kExposureStepsPerStop;
    return std::clamp(stops, -scene::kMaxExposureStops, scene::kMaxExposureStops) +
           0.0; // turns -0 into 0
}

double measure_exposure(Session& session, const Request& request) {
    FrameSpec spec = request;
    spec.techniques = {"raytrace:depth=4"};
    spec.size = thumbnail_size(request.size);
    spec.time = request.instant(1);
    spec.exposure = 0;
    session.forget();
    const measure::Picture picture = session.frame(spec).hdr();
    session.forget();
    return choose_exposure(picture);
}

void resolve_exposure(Session& session, Request& request) {
    if (request.auto_exposure) request.exposure = measure_exposure(session, request);
    request.auto_exposure = false;
}

} // namespace catoptric::session
