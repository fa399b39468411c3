// What a device cannot hold is refused by its numbers, before anything is made of it.
#include "render/limits.hpp"
#include "support/refusal.hpp"
#include "support/scenes.hpp"

#include <gtest/gtest.h>

namespace {

using namespace catoptric;

constexpr render::Limits kRoomy{1u << 27, 1u << 27, 1u << 30, 1ull << 31};

std::string refusal(const render::Amounts& amounts, const render::Limits& limits) {
    return test::refusal(Failure::exhausted, [&] { render::check_limits("s", amounts, limits); });
}

TEST(Limits, CountWhatASceneShows) {
    const scene::Scene room = test::room(2, 1);
    const render::Amounts amounts = render::amounts_of(room);
    EXPECT_EQ(amounts.triangles, scene::triangle_count(room));
    EXPECT_EQ(amounts.objects, 9u);
    EXPECT_EQ(amounts.mirrors, 2u);
    EXPECT_NO_THROW(render::check_limits("s", amounts, kRoomy));
}

TEST(Limits, NameWhatIsWantedAndWhatThereIs) {
    const render::Amounts one{.vertices = 100, .triangles = 100, .objects = 100, .mirrors = 100};
    render::Limits limits = kRoomy;
    limits.texels = 299;
    EXPECT_EQ(refusal(one, limits),
              "scene 's' wants 300 texels of triangles, the device allows 299");
    limits = kRoomy, limits.storage_bytes = 5599;
    EXPECT_EQ(refusal(one, limits),
              "scene 's' wants 5600 bytes of surfaces, the device allows 5599");
    limits.storage_bytes = 5600;
    EXPECT_EQ(refusal(one, limits), "scene 's' wants 38464 bytes of views, the device allows 5600");
    limits = kRoomy, limits.piece_bytes = 2399;
    EXPECT_EQ(refusal(one, limits),
              "scene 's' wants 2400 bytes of vertices, the device allows 2399");
    limits.piece_bytes = 2400;
    EXPECT_EQ(refusal({.vertices = 100, .triangles = 201}, limits),
              "scene 's' wants 2412 bytes of indices, the device allows 2400");
    limits = kRoomy, limits.memory_bytes = 14799;
    EXPECT_EQ(refusal(one, limits), "scene 's' wants 14800 bytes, the device allows 14799");
    EXPECT_EQ(refusal({.vertices = 1ull << 32}, kRoomy),
              "scene 's' wants 4294967296 vertices, the device allows 4294967295");
}

} // namespace
