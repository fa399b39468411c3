#include "require/model.hpp"
#include "scene/light.hpp"

namespace catoptric::require {

WorkModel make_everything_model(const WorkModelInput& input) {
    return {.is_everything = true,
            .mirrors = std::vector<MirrorRequirements>(scene::mirrors(input.now).size()),
            .lights = std::vector<LightRequirements>(scene::list_lights(input.now).size()),
            .left_out = {}};
}

} // namespace catoptric::require
