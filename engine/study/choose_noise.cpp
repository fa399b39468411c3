#include "study/choose_noise.hpp"

#include "measure/halves.hpp"
#include "measure/statistics.hpp"
#include "study/reference_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace catoptric::study {

double noise_miss_probability(const ChooseRequest& request) {
    const scene::Scene& scene = request.base.scene;
    return is_noisy(choose_reference(request.reference, scene), scene)
               ? measure::kNoiseMissProbability
               : 0;
}

double share_to_prove(const ChooseRequest& request) {
    return 1 - (1 - request.share) * (1 - noise_miss_probability(request));
}

std::optional<NoiseFloorTarget> find_noise_target(const ChooseRequest& request) {
    if (!request.max_error) return {};
    return NoiseFloorTarget{request.quantity, kNoiseShareOfLimit * *request.max_error};
}

std::optional<ViewNoise> find_view_noise(const ChooseRequest& request,
                                         const measure::Comparison& comparison) {
    if (!comparison.noise) return {};
    std::vector<double> floors = comparison.noise->view_floors;
    std::erase_if(floors, [](double floor) { return std::isnan(floor); }); // no mirror is seen
    if (floors.empty()) return {};
    ViewNoise noise{.median_floor = measure::percentile(floors, .5),
                    .largest_floor = std::ranges::max(floors),
                    .wanted_floor = {}};
    if (const std::optional<NoiseFloorTarget> target = find_noise_target(request)) {
        noise.wanted_floor = target->floor;
        noise.views_above = static_cast<std::size_t>(
            std::ranges::count_if(floors, [&](double floor) { return floor > target->floor; }));
    }
    return noise;
}

std::string describe_noise_cause(const std::optional<ViewNoise>& noise) {
    if (!noise || noise->views_above == 0) return "";
    return fmt::format("; errors include the {}, which more --reference-seconds lower",
                       describe_noise(*noise));
}

std::string describe_noise(const ViewNoise& noise) {
    std::string text = fmt::format("noise floor of the reference: median {:.3g}, at most {:.3g}",
                                   noise.median_floor, noise.largest_floor);
    if (noise.wanted_floor)
        text += fmt::format(", wanted {:.3g} ({} views above)", *noise.wanted_floor,
                            noise.views_above);
    return text;
}

} // namespace catoptric::study
