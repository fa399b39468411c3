#include "require/model.hpp"
#include "scene/light.hpp"

namespace catoptric::require {

WorkModel make_everything_model(const WorkModelInput& question) {
    return {.is_everything = true,
            .mirrors = std::vector<MirrorRequirements>(scene::mirrors(question.now).size()),
            .lights = std::vector<LightRequirements>(scene::list_lights(question.now).size()),
            .left_out = {}};
}

} // namespace catoptric::require
