#pragma once

#include "scene/scene.hpp"

namespace catoptric::scene {

/// Returns the camera for a file without one. It looks at the centre of the bounds at rest, from
/// the front, 30 degrees to the right and 20 degrees above. The vertical field of view is 40
/// degrees. The eye is as near as the eight corners of the bounds stay within 90 % of the picture's
/// height and width. The picture is `aspect` times as wide as it is high. Positions are rounded to
/// about a millionth of the distance, so that they are short to type.
Camera default_camera(const Scene& scene, double aspect = 1);

} // namespace catoptric::scene
