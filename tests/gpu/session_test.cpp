// A scene that stays on the device: whatever is changed in it, the next frame shows it as a session
// that never knew it otherwise, and nothing piles up.
#include "support/rendering.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <malloc.h>

#include <random>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{48, 40};

app::FrameSpec spec_of(const scene::Scene& scene, const std::string& technique) {
    return test::request(scene, {technique}, kSize);
}

/// Draws changes of everything that can be changed.
class Changer {
public:
    explicit Changer(std::uint64_t seed) : random_(seed) {}

    double number(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }
    std::size_t index(std::size_t count) { return random_() % count; }
    vec3 colour() { return vec3(number(0, 1), number(0, 1), number(0, 1)); }

    scene::Edit edit(const scene::Scene& scene) {
        const std::size_t object = index(scene.objects.size());
        const std::size_t material = index(scene.materials.size());
        switch (index(4)) {
        case 0: return scene::move(object, moved(scene.objects[object].world_from_object));
        case 1: return scene::paint(object, material);
        case 2: {
            scene::Material value = scene.materials[material];
            value.albedo = colour();
            value.reflectance = colour();
            return scene::set_material(material, value);
        }
        default: {
            scene::Material value = scene.materials[material];
            if (value.emission != vec3(0)) value.emission *= static_cast<float>(number(.1, 3));
            value.mirror = value.emission == vec3(0) && index(2) == 0;
            return scene::set_material(material, value);
        }
        }
    }

    void look(scene::Camera& camera) {
        camera.eye += dvec3(number(-.2, .2), number(-.2, .2), number(-.2, .2));
    }

private:
    dmat4 moved(dmat4 place) {
        place = glm::rotate(place, number(-1, 1), dvec3(number(-1, 1), 1, number(-1, 1)));
        place[3] += dvec4(number(-.4, .4), number(-.4, .4), number(-.4, .4), 0);
        return place;
    }
    std::mt19937_64 random_;
};

TEST(Session, ChangedShowsWhatAFreshOneShows) {
    Changer draw(11);
    for (const std::string technique : {"reuse:face=16", "raytrace", "pyramid:face=16"}) {
        const scene::Scene at_rest = test::room(3, 2);
        app::Session session(test::engine(), at_rest);
        app::FrameSpec spec = spec_of(at_rest, technique);
        measure::Picture before = session.frame(spec).hdr();
        int seen = 0;
        for (int change = 0; change < 20; ++change) {
            session.change(draw.edit(session.scene()));
            if (change % 4 == 3) draw.look(spec.camera);
            session.forget();
            app::Session fresh(test::engine(), session.scene());
            for (int k = 1; k <= 2; ++k) {
                const measure::Picture found = session.frame(spec).hdr();
                ASSERT_TRUE(test::same_bytes(found, fresh.frame(spec).hdr()))
                    << technique << ", change " << change << ", frame " << k;
                seen += !test::same_bytes(found, before);
                before = found;
            }
        }
        EXPECT_GT(seen, 10) << "changes must show";
    }
}

TEST(Session, KeepsHistoryOverAChangeAndForgetsItAtACut) {
    const scene::Scene scene = test::room(3, 1);
    const app::FrameSpec spec = spec_of(scene, "reuse:face=16");
    app::Session session(test::engine(), scene);
    const measure::Picture first = session.frame(spec).hdr(), second = session.frame(spec).hdr();
    EXPECT_FALSE(test::same_bytes(first, second)) << "mirrors in mirrors are black at first";
    session.change(scene::set_material(0, session.scene().materials[0])); // to what it is
    EXPECT_FALSE(test::same_bytes(session.frame(spec).hdr(), first)) << "history was lost";
    session.forget();
    EXPECT_TRUE(test::same_bytes(session.frame(spec).hdr(), first));
}

TEST(Session, OtherTechniquesBeginWithoutHistoryAndAFrameAsideLeavesItAlone) {
    const scene::Scene scene = test::room(3, 1);
    const app::FrameSpec spec = spec_of(scene, "reuse:face=16");
    app::FrameSpec aside = spec_of(scene, "raytrace");
    aside.is_aside = true;
    app::Session session(test::engine(), scene), alone(test::engine(), scene);
    const measure::Picture first = alone.frame(spec).hdr(), second = alone.frame(spec).hdr();
    EXPECT_TRUE(test::same_bytes(session.frame(spec).hdr(), first));
    session.frame(aside);
    EXPECT_TRUE(test::same_bytes(session.frame(spec).hdr(), second));
    aside.is_aside = false;
    session.frame(aside);
    EXPECT_TRUE(test::same_bytes(session.frame(spec).hdr(), first)) << "another began in between";
}

TEST(Session, WritesNothingForAFrameThatStands) {
    const scene::Scene scene = test::room(2, 1);
    app::FrameSpec spec = spec_of(scene, "reuse:face=16");
    app::Session session(test::engine(), scene);
    for (int k = 0; k < 5; ++k) session.frame(spec);
    EXPECT_EQ(session.counts().frames, 5u);
    EXPECT_EQ(session.counts().updates, 1u);
    spec.camera.eye.x += .1;
    session.frame(spec);
    EXPECT_EQ(session.counts().updates, 2u);
}

TEST(Session, ReadsAFrameUntilTheNext) {
    const scene::Scene scene = test::room(1, 1);
    const app::FrameSpec spec = spec_of(scene, "reuse:face=16");
    app::Session session(test::engine(), scene);
    const app::Frame old = session.frame(spec);
    old.hdr();
    session.frame(spec);
    EXPECT_GT(old.times().gpu_ms, 0) << "times stay";
    test::expect_refused([&] { old.hdr(); }, Failure::internal, {"frame 1", "frame 2"});
}

TEST(Session, RefusesWhatMeansNothing) {
    const scene::Scene scene = test::room(1, 1);
    app::Session session(test::engine(), scene);
    const app::FrameSpec spec = spec_of(scene, "reuse:face=16");
    const std::string objects = std::to_string(scene.objects.size());
    test::expect_refused([&] { session.change(scene::move(999, dmat4(1))); }, Failure::usage,
                         {"object 999", objects});
    test::expect_refused([&] { session.change(scene::paint(0, 999)); }, Failure::usage,
                         {"material 999", std::to_string(scene.materials.size())});
    test::expect_refused([&] { session.change(scene::move(0, dmat4(0))); }, Failure::usage,
                         {scene.objects[0].name, "affine transform with an inverse"});
    app::FrameSpec none = spec;
    none.size = {0, 4};
    test::expect_refused([&] { session.frame(none); }, Failure::usage, {"at least 1x1", "0x4"});
    none = spec, none.techniques = {};
    test::expect_refused([&] { session.frame(none); }, Failure::usage, {"no technique"});
    app::Session untouched(test::engine(), scene);
    EXPECT_TRUE(test::same_bytes(session.frame(spec).hdr(), untouched.frame(spec).hdr()));
}

TEST(Session, MemoryIsFlatOverManyFrames) {
    const scene::Scene scene = test::room(2, 1);
    app::FrameSpec spec = spec_of(scene, "reuse:face=8,shadow_map=8");
    spec.size = {16, 16};
    app::Session session(test::engine(), scene);
    constexpr int kFrames = 2000;
    std::size_t early = 0;
    for (int k = 1; k <= kFrames; ++k) {
        spec.camera.eye.x += k % 2 ? .01 : -.01;
        session.frame(spec);
        if (k == kFrames / 10) early = mallinfo2().uordblks;
    }
    const std::size_t late = mallinfo2().uordblks;
    std::cout << "[ MEASURED ] bytes in use after " << kFrames / 10 << " frames: " << early
              << ", after " << kFrames << ": " << late << "\n";
    EXPECT_LE(late, early + 64 * 1024);
}

} // namespace
