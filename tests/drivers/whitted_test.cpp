// Compares whole pictures of our ray tracer with pictures traced by Embree, an independent ray
// tracer. Embree traces the same rays, one at a time and in packets.
#include "peers/peer_scene.hpp"
#include "scene/built_in.hpp"
#include "support/rendering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace catoptric;

constexpr uvec2 kComparedPictureSize{128, 128};
/// Allowed difference of a pixel's linear radiance, which is about 1.
constexpr float kEqualRadianceTolerance = 1e-3F;
/// How many pixels may differ by more than kEqualRadianceTolerance, because reflections enlarge
/// rounding errors. As many pixels differ between our own pictures with hit points in single and
/// double precision.
constexpr std::size_t kMaxSensitivePixels = 4;

session::TechniqueResult render_scene_picture(const scene::Scene& scene,
                                              const std::string& technique) {
    const session::Request asked = test::make_test_request(scene, {technique},
                                                           kComparedPictureSize);
    return std::move(session::run(test::get_test_engine(), asked).parts.front());
}

float largest_of_channels(const vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// Returns how much each pixel of our picture changes if hit points are computed in double
/// precision.
std::vector<float> pixel_changes_by_double_precision(const measure::Picture& single,
                                                     const measure::Picture& precise) {
    std::vector<float> result;
    for (std::size_t i = 0; i < single.pixels.size(); ++i)
        result.push_back(largest_of_channels(single.pixels[i] - precise.pixels[i]));
    return result;
}

std::size_t count_differing_pixels(const measure::Picture& a,
                                   const std::vector<peers::PeerVector3>& b,
                                   const std::vector<float>& sensitivity) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        const float apart = largest_of_channels(a.pixels[i] - vec3(b[i].x, b[i].y, b[i].z));
        count += !(apart <= std::max(kEqualRadianceTolerance, sensitivity[i]));
    }
    return count;
}

void expect_same_picture_as_peer(const scene::Scene& scene, int depth, bool exact) {
    const std::string technique = "raytrace:depth=" + std::to_string(depth) +
                                  (exact ? ",sphere=exact" : "");
    const session::Request asked = test::make_test_request(scene, {technique},
                                                           kComparedPictureSize);
    const session::TechniqueResult ours = render_scene_picture(scene, technique);
    const std::vector<float> sensitive = pixel_changes_by_double_precision(
        ours.hdr, render_scene_picture(scene, technique + ",hit=f64").hdr);
    EXPECT_LE(std::ranges::count_if(
                  sensitive, [](float apart) { return !(apart <= kEqualRadianceTolerance); }),
              kMaxSensitivePixels)
        << technique;
    const peers::EmbreeDevice device;
    const peers::EmbreeWhittedTracer peer(device, asked, depth, exact);
    for (const int width : {1, 8, 16}) {
        const peers::PeerTracedPicture theirs = peer.trace_picture(width, 2);
        EXPECT_EQ(count_differing_pixels(ours.hdr, theirs.pixels, sensitive), 0U)
            << technique << ", " << width;
        EXPECT_EQ(theirs.rays.primary, ours.rays->primary);
        EXPECT_EQ(theirs.rays.mirror, ours.rays->mirror) << technique << ", " << width;
        EXPECT_EQ(theirs.rays.shadow, ours.rays->shadow) << technique << ", " << width;
    }
}

TEST(Whitted, PictureOfMeshesMatchesEmbree) {
    for (const int depth : {1, 4}) expect_same_picture_as_peer(scene::make_cornell(), depth, false);
}

TEST(Whitted, PictureOfExactSpheresMatchesEmbree) {
    for (const int depth : {1, 4}) expect_same_picture_as_peer(scene::make_cornell(), depth, true);
}

// The scene `room` has textures, smooth dielectrics, two-sided surfaces, lamps without a cosine
// factor and a spot light.
TEST(Whitted, PictureOfTheRoomMatchesEmbree) {
    expect_same_picture_as_peer(scene::load("room"), 4, false);
}

} // namespace
