#pragma once

namespace catoptric::stress {

/// Returns the share of light that a rough surface reflects to a viewer at `degrees` from the
/// normal, if equal light arrives from everywhere. The surface reflects by single scattering at GGX
/// microfacets with a reflectance of 1. Computed by quadrature in double precision. The formulas
/// are derived for slopes of microfacets, and are not those of shaders/lib/math/lobe.glsl.
double lobe_albedo(double roughness, double degrees);

} // namespace catoptric::stress
