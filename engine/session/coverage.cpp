#include "session/coverage.hpp"

#include "core/shader_math.hpp"
#include "session/rays.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace catoptric::session {

namespace {

/// Pixels from `low` up to, but without, `high`.
struct CoveredPixels {
    ivec2 low{0}, high{0};

    std::uint64_t count_pixels() const {
        const ivec2 side = max(high - low, ivec2(0));
        return std::uint64_t(side.x) * std::uint64_t(side.y);
    }
};

/// Returns the pixels whose rays can meet a triangle. Their centres lie within the triangle's
/// bounds on the screen, or less than half a pixel outside (for rounding errors). Returns all
/// pixels if a corner lies behind the eye.
CoveredPixels screen_bounds(const shared::View& view, uvec2 size,
                            const std::array<vec3, 3>& corners) {
    dvec2 low(std::numeric_limits<double>::infinity()), high(-low);
    int behind = 0;
    for (const vec3& corner : corners) {
        const dvec3 from_eye = dvec3(corner) - dvec3(view.eye);
        const double depth = view.parallel != 0 ? 1 : glm::dot(from_eye, dvec3(view.forward));
        behind += !(depth > 0);
        const dvec2 ndc(glm::dot(from_eye, dvec3(view.right)) / depth,
                        glm::dot(from_eye, dvec3(view.down)) / depth);
        low = glm::min(low, ndc), high = glm::max(high, ndc);
    }
    if (behind == 3) return {};
    const dvec2 pixels(size);
    if (behind > 0) low = dvec2(-1), high = dvec2(1);
    // The centre of pixel i is at i + .5. Pixels with low - 1 < i < high therefore lie less than
    // half a pixel outside [low, high].
    const auto pixel = [&](const dvec2& ndc, double more) {
        return ivec2(glm::clamp(glm::floor((ndc + 1.0) * .5 * pixels) + more, dvec2(0), pixels));
    };
    return {pixel(low, 0), pixel(high, 1)};
}

} // namespace

std::optional<std::vector<int>> find_first_objects(const render::FrameGeometry& geometry,
                                                   const shared::View& view, uvec2 size,
                                                   std::uint64_t most_tests) {
    struct PixelRay {
        f32::Ray ray;
        f32::TriangleTestRayShear shear;
        float nearest = std::numeric_limits<float>::max();
    };
    std::vector<PixelRay> pixels;
    for (std::size_t i = 0; i < std::size_t{size.x} * size.y; ++i) {
        const f32::Ray ray = make_camera_ray(view, size, i);
        pixels.push_back({ray, f32::make_ray_shear(ray.direction)});
    }
    std::vector<int> seen(pixels.size(), -1);
    std::uint64_t tests = 0;
    for (std::size_t object = 0; object < geometry.ranges.size(); ++object) {
        const render::DrawRange& range = geometry.ranges[object];
        if (!range.seen_by_camera) continue;
        for (std::uint32_t k = range.first_index; k < range.first_index + range.index_count;
             k += 3) {
            std::array<vec3, 3> corners;
            for (std::uint32_t j = 0; j < 3; ++j)
                corners[j] = geometry.vertices[geometry.indices[k + j]].position;
            const auto& [a, b, c] = corners;
            const CoveredPixels box = screen_bounds(view, size, corners);
            tests += box.count_pixels();
            if (tests > most_tests) return std::nullopt;
            for (int y = box.low.y; y < box.high.y; ++y)
                for (int x = box.low.x; x < box.high.x; ++x) {
                    const std::size_t i = std::size_t(y) * size.x + std::size_t(x);
                    PixelRay& pixel = pixels[i];
                    float t = 0;
                    vec3 weights;
                    if (range.one_sided && f32::hits_back_face(a, b, c, pixel.ray.direction))
                        continue;
                    if (!f32::intersect_triangle_watertight(a, b, c, pixel.ray.origin, pixel.shear,
                                                            t, weights) ||
                        !(t <
                          pixel.nearest)) // of two equal distances, that of the first triangle wins
                        continue;
                    pixel.nearest = t;
                    seen[i] = static_cast<int>(object);
                }
        }
    }
    return seen;
}

} // namespace catoptric::session
