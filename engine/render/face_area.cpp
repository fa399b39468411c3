#include "render/face_area.hpp"

namespace catoptric::render {

require::FacePart grow_to_texels(const require::FacePart& part, std::uint32_t edge) {
    if (part.is_whole()) return part;
    const double size = edge;
    const auto texel = [&](const dvec2& place) { return (place * .5 + .5) * size; };
    const dvec2 first = max(floor(texel(part.low)) - 1., dvec2(0)),
                end = min(ceil(texel(part.high)) + 1., dvec2(size));
    return {first / size * 2. - 1., end / size * 2. - 1.};
}

std::optional<graph::PixelRectangle> to_pixel_area(const require::FacePart& part,
                                                   std::uint32_t edge) {
    if (part.is_whole()) return {};
    const auto texel = [&](const dvec2& place) {
        return uvec2(round((place * .5 + .5) * static_cast<double>(edge)));
    };
    const uvec2 first = texel(part.low), size = texel(part.high) - first;
    return graph::PixelRectangle{first.x, first.y, size.x, size.y};
}

require::FacePart part_showing(const shared::View& view, int face, const Bounds<float>& box) {
    const dvec3 centre(view.eye);
    return require::face_part_containing(face, {dvec3(box.lo) - centre, dvec3(box.hi) - centre});
}

} // namespace catoptric::render
