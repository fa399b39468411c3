#include "render/texels.hpp"

#include "bvh/words.hpp"

namespace catoptric::render {

std::vector<vec4> to_texels(std::span<const shared::Surface> surfaces) {
    std::vector<vec4> texels;
    texels.reserve(shared::kTexelsPerSurface * surfaces.size());
    for (const shared::Surface& surface : surfaces)
        texels.insert(texels.end(),
                      {vec4(surface.albedo, bvh::pack_number(surface.mirror)),
                       vec4(surface.emission, bvh::pack_number(surface.detail)),
                       vec4(surface.reflectance, 0), vec4(surface.centre, surface.radius)});
    return texels;
}

std::vector<vec4> to_texels(std::span<const shared::Probe> probes) {
    std::vector<vec4> texels;
    texels.reserve(shared::kTexelsPerProbe * probes.size());
    for (const shared::Probe& probe : probes)
        texels.insert(texels.end(), {vec4(probe.sphere, probe.radius),
                                     vec4(probe.centre, static_cast<float>(probe.kind)),
                                     vec4(probe.reflectance, 0),
                                     vec4(probe.lowest, static_cast<float>(probe.holds)),
                                     vec4(probe.highest, 0)});
    return texels;
}

} // namespace catoptric::render
