// What the rules of engine/require say of captures, held against captures.
#include "render/captured.hpp"
#include "require/model.hpp"
#include "support/drawn_hall.hpp"
#include "support/rendering.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

namespace {

using namespace catoptric;

constexpr std::uint32_t kFace = 32, kShadowEdge = 128;

/// A hall with one mirror and a thing that moves.
scene::Scene hall(std::uint64_t seed) {
    scene::Scene scene = test::drawn_hall(seed, 3);
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    for (const std::size_t other : {mirrors[1], mirrors[2]}) scene.objects[other].material = 0;
    test::Numbers numbers(seed + 500);
    scene.objects[mirrors[1 + numbers.below(2)]].motion = scene::Harmonic{
        .amplitude = dvec3(numbers.direction()), .period = 2};
    const dvec3 centre = scene::bounds(scene, scene.objects[mirrors[0]]).centre();
    scene.cameras[0] = {.eye = centre + 2. * dvec3(numbers.direction()), .target = centre};
    return scene;
}

std::vector<std::byte> bytes_of(const render::Captured& captured, std::size_t face) {
    std::vector<std::byte> bytes;
    for (const auto& all : {captured.colour_bytes, captured.distance_bytes}) {
        const std::size_t one = all.size() / 6;
        const auto part = std::span(all).subspan(face * one, one);
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return bytes;
}

TEST(Require, FacesWhoseStampStaysKeepTheirBytes) {
    int stays = 0, changes = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        const scene::Scene scene = hall(seed);
        require::Requirements requirements(scene);
        app::Session session(test::engine(), scene);
        app::FrameSpec spec{.techniques = {"parallax:face=" + std::to_string(kFace) +
                                           ",shadow_map=" + std::to_string(kShadowEdge)},
                            .camera = scene.cameras[0],
                            .size = {16, 16}};
        spec.with_captures = true;
        const auto at = [&](double seconds) {
            spec.time = seconds;
            const scene::Scene now = scene::at(scene, seconds);
            const require::Model model = requirements.of(
                {now, spec.camera, spec.size, kShadowEdge});
            return std::pair(model.mirrors[0], session.frame(spec).captures());
        };
        const auto [needs, captured] = at(.2);
        const auto [needs_later, captured_later] = at(.5);
        if (!needs.is_captured) continue;
        for (std::size_t face = 0; face < 6; ++face) {
            const bool is_kept = needs.stamps[face] == needs_later.stamps[face];
            const bool is_same = bytes_of(captured, face) == bytes_of(captured_later, face);
            EXPECT_TRUE(is_same || !is_kept) << "seed " << seed << ", face " << face;
            stays += is_kept ? 1 : 0, changes += is_same ? 0 : 1;
        }
    }
    EXPECT_GT(stays, 20);
    EXPECT_GT(changes, 20);
    RecordProperty("kept", stays), RecordProperty("changed", changes);
}

} // namespace
