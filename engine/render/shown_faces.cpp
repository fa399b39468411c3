#include "render/shown_faces.hpp"

#include "render/views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace catoptric::render {

namespace {

/// A hidden object must lie farther away by this factor than what hides it. The factor exceeds the
/// errors of interpolated depths, which are largest in triangles seen almost from the side.
constexpr float kMinHiddenDepthFactor = 1 + 0x1p-6f;
/// Slack of cosines and slopes against roundings.
constexpr float kSlopeError = 0x1p-18f;

/// Returns a bound of the rounding errors of a place relative to the eye.
float relative_error(const shared::View& view, const vec3& place) {
    return 0x1p-20f * (length(place) + length(view.eye));
}

/// A sphere as a face sees it: x to the right, y down, z forward.
struct FaceSphere {
    vec3 centre;
    float distance; ///< distance of the sphere's centre; above `radius`
    float radius;
    float sine, cosine; ///< sine and cosine of half the angle that the sphere covers
};

FaceSphere make_face_sphere(const shared::View& view, const vec3& from_eye, float radius) {
    FaceSphere seen{
        {dot(view.right, from_eye), dot(view.down, from_eye), dot(view.forward, from_eye)},
        length(from_eye),
        radius,
        0,
        0};
    seen.sine = radius / seen.distance;
    seen.cosine = std::sqrt(std::max(0.f, 1 - seen.sine * seen.sine));
    return seen;
}

/// A range of slopes: right or down divided by forward.
struct SlopeRange {
    float low = -1, high = 1;
};

/// Returns the slopes between the tangents to the sphere, in the plane of `across` and forward.
/// A side without a tangent in front of the eye is not limited.
SlopeRange sphere_slopes(const FaceSphere& sphere, float across) {
    const float ahead = sphere.centre.z;
    const float squared = across * across + ahead * ahead - sphere.radius * sphere.radius;
    if (!(squared > 0)) return {};
    const float tangent = std::sqrt(squared);
    const float below_low = ahead * tangent + across * sphere.radius,
                below_high = ahead * tangent - across * sphere.radius;
    SlopeRange range;
    if (below_low > 0)
        range.low = (across * tangent - ahead * sphere.radius) / below_low - kSlopeError;
    if (below_high > 0)
        range.high = (across * tangent + ahead * sphere.radius) / below_high + kSlopeError;
    return range;
}

/// The cells of a face. A cell holds one texel, or a square of neighbouring texels.
class HiddenCells {
public:
    explicit HiddenCells(const FaceRaster& raster)
        : face_edge_(raster.edge),
          texels_((face_edge_ + kFaceCellsPerEdge - 1) / kFaceCellsPerEdge),
          cells_((face_edge_ + texels_ - 1) / texels_),
          // Twice the step of the device's grid, to which a rasteriser moves each corner.
          snap_(std::ldexp(4 / static_cast<float>(face_edge_),
                           -static_cast<int>(raster.subtexel_bits))),
          hidden_beyond_(std::size_t{cells_} * cells_) {
        for (std::uint32_t i = 0; i < cells_; ++i) {
            const auto slope = [&](std::uint32_t texel) {
                return (static_cast<float>(texel) + .5f) / static_cast<float>(face_edge_) * 2 - 1;
            };
            centres_.push_back(
                {slope(i * texels_), slope(std::min((i + 1) * texels_, face_edge_) - 1)});
        }
    }

    void clear() { std::ranges::fill(hidden_beyond_, std::numeric_limits<float>::infinity()); }

    /// Records that a ball hides what lies behind it.
    void mark_hidden(const FaceSphere& ball) {
        for_each_cell(ball, 0, [&](std::size_t cell, const SlopeRange& x, const SlopeRange& y) {
            // The cone around the ball is convex. If it contains the outermost texel centres of
            // the cell, it contains all of them. The farthest point of the ball within the cell
            // then lies at one of these centres.
            float farthest = 0;
            for (const vec2& corner : {vec2(x.low, y.low), vec2(x.high, y.low), vec2(x.low, y.high),
                                       vec2(x.high, y.high)}) {
                const float cosine = cosine_to_axis(ball, corner);
                if (cosine < ball.cosine + kSlopeError) return false;
                const float along = ball.distance * cosine;
                const float inside = ball.radius * ball.radius -
                                     ball.distance * ball.distance * (1 - cosine * cosine);
                farthest = std::max(farthest, along - std::sqrt(std::max(0.f, inside)));
                if (texels_ == 1) break; // a cell of one texel has only one centre
            }
            hidden_beyond_[cell] = std::min(hidden_beyond_[cell], farthest * kMinHiddenDepthFactor);
            return false;
        });
    }

    bool may_show_sphere(const FaceSphere& sphere) const {
        const float nearest = sphere.distance - sphere.radius;
        // The angle between two directions is smaller than the distance between their points on the
        // face.
        const float around = std::numbers::sqrt2_v<float> *
                             (static_cast<float>(texels_ - 1) / static_cast<float>(face_edge_) +
                              snap_);
        const float least = sphere.cosine * std::cos(around) - sphere.sine * std::sin(around);
        bool shows = false;
        for_each_cell(sphere, snap_,
                      [&](std::size_t cell, const SlopeRange& x, const SlopeRange& y) {
                          if (nearest > hidden_beyond_[cell]) return false;
                          const vec2 middle((x.low + x.high) / 2, (y.low + y.high) / 2);
                          return shows = cosine_to_axis(sphere, middle) > least - kSlopeError;
                      });
        return shows;
    }

private:
    static float cosine_to_axis(const FaceSphere& sphere, const vec2& slopes) {
        const vec3 direction(slopes, 1);
        return dot(direction, sphere.centre) / (length(direction) * sphere.distance);
    }

    /// Returns the first cell with a texel centre at or beyond a slope, and the number of cells
    /// that begin at or before the slope.
    std::uint32_t first_cell(float slope) const {
        return static_cast<std::uint32_t>(
            std::ranges::lower_bound(centres_, slope, {}, &SlopeRange::high) - centres_.begin());
    }
    std::uint32_t end_cell(float slope) const {
        return static_cast<std::uint32_t>(
            std::ranges::upper_bound(centres_, slope, {}, &SlopeRange::low) - centres_.begin());
    }

    /// Calls visit(cell, slopes to the right, slopes down) for each cell with texel centres less
    /// than `beside` away from the square around the sphere, until `visit` returns true.
    template <typename Visit>
    void for_each_cell(const FaceSphere& sphere, float beside, Visit&& visit) const {
        const SlopeRange across = sphere_slopes(sphere, sphere.centre.x),
                         down = sphere_slopes(sphere, sphere.centre.y);
        const std::uint32_t left = first_cell(across.low - beside),
                            right = end_cell(across.high + beside),
                            top = first_cell(down.low - beside), end = end_cell(down.high + beside);
        for (std::uint32_t y = top; y < end; ++y)
            for (std::uint32_t x = left; x < right; ++x)
                if (visit(std::size_t{y} * cells_ + x, centres_[x], centres_[y])) return;
    }

    std::uint32_t face_edge_, texels_, cells_;
    float snap_; ///< slope by which a rasteriser may move a corner of a triangle
    /// Slopes of the first and of the last texel centre of each column or row of cells.
    std::vector<SlopeRange> centres_;
    /// For each cell, the distance from the eye beyond which nothing is visible.
    std::vector<float> hidden_beyond_;
};

/// Returns whether the ball hides all objects behind it. For this, the eye must be outside the
/// ball's object, and the near plane must not cut off a part of the ball.
bool can_hide(const shared::View& view, const InnerBall& ball, const DrawRange& range) {
    const float gap = length(range.bounds.centre() - view.eye) - range.radius;
    return ball.radius > relative_error(view, ball.centre) && gap > 2 * view.near;
}

} // namespace

std::vector<std::uint8_t> find_shown_faces(std::span<const shared::View> faces,
                                           const FaceRaster& raster,
                                           std::span<const DrawRange> ranges,
                                           std::span<const InnerBall> balls,
                                           const std::function<bool(std::size_t)>& wanted) {
    std::vector<std::uint8_t> shown(ranges.size());
    std::vector<std::size_t> objects;
    for (std::size_t i = 0; i < ranges.size(); ++i)
        if (wanted(i)) objects.push_back(i);
    std::vector<const InnerBall*> hiding;
    for (const InnerBall& ball : balls)
        if (wanted(ball.object) && can_hide(faces.front(), ball, ranges[ball.object]))
            hiding.push_back(&ball);
    HiddenCells cells(raster);
    for (std::size_t face = 0; face < faces.size(); ++face) {
        const shared::View& view = faces[face];
        cells.clear();
        for (const InnerBall* const ball : hiding)
            if (may_show(view, ranges[ball->object]))
                cells.mark_hidden(
                    make_face_sphere(view, ball->centre - view.eye,
                                     ball->radius - relative_error(view, ball->centre)));
        for (const std::size_t i : objects) {
            if (!may_show(view, ranges[i])) continue;
            const vec3 from_eye = ranges[i].bounds.centre() - view.eye;
            const float radius = ranges[i].radius + relative_error(view, ranges[i].bounds.centre());
            if (!(length(from_eye) > radius * (1 + kSlopeError)) ||
                cells.may_show_sphere(make_face_sphere(view, from_eye, radius)))
                shown[i] |= static_cast<std::uint8_t>(1u << face);
        }
    }
    return shown;
}

} // namespace catoptric::render
