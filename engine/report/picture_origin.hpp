#pragma once

#include "measure/comparison.hpp"

namespace catoptric::report {

/// What a picture was made of: with this, the same picture can be made again.
struct PictureOrigin {
    std::string version, commit;
    std::string device, driver;
    std::string scene, scene_hash;
    std::string technique;       ///< as written for the row, such as "naive:bounces=1"
    std::string model;           ///< "everything" or "required"
    measure::CameraFacts camera; ///< world units
    double time = 0;             ///< seconds into the scene's motion
    double exposure = 0;         ///< stops at which the picture is shown; not part of its values
};

/// Returns the text for the header of an OpenEXR file: JSON in one line, of schema
/// "catoptric/picture/1". The same origin gives the same text.
std::string format_picture_origin(const PictureOrigin& origin);

} // namespace catoptric::report
