#include "report/picture_origin.hpp"

#include "report/json.hpp"

namespace catoptric::report {

std::string format_picture_origin(const PictureOrigin& origin) {
    const Json json{{"schema", "catoptric/picture/1"},
                    {"version", origin.version},
                    {"commit", origin.commit},
                    {"device", origin.device},
                    {"driver", origin.driver},
                    {"scene", origin.scene},
                    {"scene_hash", origin.scene_hash},
                    {"technique", origin.technique},
                    {"model", origin.model},
                    {"camera", make_camera_json(origin.camera)},
                    {"time", make_number_json(origin.time)},
                    {"exposure", make_number_json(origin.exposure)}};
    return json.dump(-1, ' ', true, Json::error_handler_t::replace);
}

} // namespace catoptric::report
