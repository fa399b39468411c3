// The whole picture by a ray tracer of other people's: as Embree traces it, one ray at a time and
// in packets, with the same rays.
#include "peers/peer_scene.hpp"
#include "support/rendering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{128, 128};
/// Allowed difference of linear radiance, which is about 1.
constexpr float kSame = 1e-3F;
/// Pixels of kSize that may differ by more, because a reflection enlarges roundings: as many as
/// differ between our own hit points in single and in double precision.
constexpr std::size_t kMostSensitive = 4;

app::Part rendered(const scene::Scene& scene, const std::string& technique) {
    const app::Request asked = test::request(scene, {technique}, kSize);
    return std::move(app::run(test::engine(), asked).parts.front());
}

float largest(const vec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// Returns for each pixel by how much our picture changes with hit points in double precision.
std::vector<float> sensitivity(const measure::Picture& single, const measure::Picture& precise) {
    std::vector<float> result;
    for (std::size_t i = 0; i < single.pixels.size(); ++i)
        result.push_back(largest(single.pixels[i] - precise.pixels[i]));
    return result;
}

std::size_t other_pixels(const measure::Picture& a, const std::vector<peers::Vector>& b,
                         const std::vector<float>& sensitivity) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        const float apart = largest(a.pixels[i] - vec3(b[i].x, b[i].y, b[i].z));
        count += !(apart <= std::max(kSame, sensitivity[i]));
    }
    return count;
}

void expect_the_same(const scene::Scene& scene, int depth, bool exact) {
    const std::string technique = "raytrace:depth=" + std::to_string(depth) +
                                  (exact ? ",sphere=exact" : "");
    const app::Request asked = test::request(scene, {technique}, kSize);
    const app::Part ours = rendered(scene, technique);
    const std::vector<float> sensitive = sensitivity(ours.hdr,
                                                     rendered(scene, technique + ",hit=f64").hdr);
    EXPECT_LE(std::ranges::count_if(sensitive, [](float apart) { return !(apart <= kSame); }),
              kMostSensitive)
        << technique;
    const peers::EmbreeDevice device;
    const peers::PeerScene peer(device, asked, depth, exact);
    for (const int width : {1, 8, 16}) {
        const peers::Traced theirs = peer.trace(width, 2);
        EXPECT_EQ(other_pixels(ours.hdr, theirs.pixels, sensitive), 0U)
            << technique << ", " << width;
        EXPECT_EQ(theirs.rays.primary, ours.rays->primary);
        EXPECT_EQ(theirs.rays.mirror, ours.rays->mirror) << technique << ", " << width;
        EXPECT_EQ(theirs.rays.shadow, ours.rays->shadow) << technique << ", " << width;
    }
}

TEST(Whitted, MeshesAsEmbreeSeesThem) {
    for (const int depth : {1, 4}) expect_the_same(scene::cornell_mirrors(), depth, false);
}

TEST(Whitted, SpheresAsEmbreeSeesThem) {
    for (const int depth : {1, 4}) expect_the_same(scene::cornell_mirrors(), depth, true);
}

// Textures, smooth dielectrics, surfaces with two sides, lamps without a cosine, a spot.
TEST(Whitted, TheRoomAsEmbreeSeesIt) { expect_the_same(scene::load("room"), 4, false); }

} // namespace
