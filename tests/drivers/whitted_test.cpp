// The whole picture by a ray tracer of other people's: as Embree traces it, one ray at a time and
// in packets, with the same rays.
#include "peers/peer_scene.hpp"
#include "support/rendering.hpp"

#include <gtest/gtest.h>

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{128, 128};
/// Linear radiance of about 1: what some reflections make of roundings.
constexpr float kSame = 1e-3F;

std::size_t other_pixels(const measure::Picture& a, const std::vector<peers::Vector>& b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
        const vec3 apart = abs(a.pixels[i] - vec3(b[i].x, b[i].y, b[i].z));
        const bool is_other = !(std::max({apart.x, apart.y, apart.z}) <= kSame);
        count += is_other;
        if (is_other)
            std::cout << "pixel " << i % kSize.x << ", " << i / kSize.x << ": " << a.pixels[i].x
                      << " and " << b[i].x << "\n";
    }
    return count;
}

void expect_the_same(const scene::Scene& scene, int depth, bool exact) {
    const std::string technique = "raytrace:depth=" + std::to_string(depth) +
                                  (exact ? ",sphere=exact" : "");
    const app::Request asked = test::request(scene, {technique}, kSize);
    const app::Part ours = std::move(app::run(test::engine(), asked).parts.front());
    const peers::EmbreeDevice device;
    const peers::PeerScene peer(device, asked, depth, exact);
    for (const int width : {1, 8, 16}) {
        const peers::Traced theirs = peer.trace(width, 2);
        EXPECT_EQ(other_pixels(ours.hdr, theirs.pixels), 0U) << technique << ", " << width;
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
