#include "require/model.hpp"
#include "scene/light.hpp"

namespace catoptric::require {

Model make_everything_model(const ModelInput& question) {
    return {.is_everything = true,
            .mirrors = std::vector<MirrorNeeds>(scene::mirrors(question.now).size()),
            .lights = std::vector<LightNeeds>(scene::list_lights(question.now).size()),
            .left_out = {}};
}

} // namespace catoptric::require
