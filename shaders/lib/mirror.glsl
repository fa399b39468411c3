// A mirror that looks its reflection up in captures. The including shader (one for each technique)
// defines, before it includes this,
//   vec3 reflected(uint mirror, vec3 offset, vec3 direction)
// radiance that arrives against `direction` (unit) at the point `offset` from the centre of capture
// `mirror` (from 0), scene units.
#ifndef CATOPTRIC_MIRROR_GLSL
#define CATOPTRIC_MIRROR_GLSL

#include "lib/probe.glsl"
#include "lib/surface.glsl"

void main() {
    vec3 facet = normalize(cross(dFdx(from_eye), dFdy(from_eye)));
    vec3 direction = mirror_direction(normalize(from_eye), normalize(normal), facet);
    write_surface(draw.surface.reflectance * reflected(draw.surface.mirror - 1u, position - draw.probe_centre, direction));
}

#endif
