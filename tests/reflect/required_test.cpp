// What a picture does not require is left out, and the picture stays: every frame beside the same
// frame of a session that renders everything, byte by byte.
#include "scene/load.hpp"
#include "support/rendering.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include <functional>

namespace {

using namespace catoptric;
using Names = std::vector<std::string>;

constexpr uvec2 kSize{40, 32};

Names names_of(const app::FrameTimes& times) {
    Names names;
    for (const app::PassTime& pass : times.passes) names.push_back(pass.name);
    return names;
}

bool draws_captures(const Names& names) {
    return std::ranges::any_of(
        names, [](const std::string& name) { return name.starts_with("capture/"); });
}

const Names kSettled{"view", "compose"};

bool needs_all_faces(const require::Model& model) {
    return std::ranges::all_of(model.mirrors, [](const require::MirrorNeeds& mirror) {
        return mirror.is_captured && mirror.faces == require::kAllFaces;
    });
}

/// Two sessions of one scene in which the same happens.
class Pair {
public:
    Pair(const scene::Scene& scene, std::vector<std::string> techniques,
         std::uint32_t in_flight = 1)
        : spec(test::request(scene, techniques, kSize)), all_(test::engine(), scene, in_flight),
          few_(test::engine(), scene, in_flight) {}

    /// Passes of the frame with what is required.
    Names frame() {
        ++number_;
        app::FrameSpec required = spec;
        required.model = app::Modelling::required;
        const app::Frame wanted = all_.frame(spec), found = few_.frame(required);
        for (std::size_t part = 0; part < wanted.size(); ++part)
            EXPECT_TRUE(test::same_bytes(found.hdr(part), wanted.hdr(part)))
                << "frame " << number_ << ", part " << part;
        if (!spec.is_aside) {
            EXPECT_EQ(found.remembers(), wanted.remembers());
            const bool is_whole = needs_all_faces(found.model()); // else some faces hold nothing
            EXPECT_TRUE(!is_whole || found.state() == wanted.state()) << "frame " << number_;
        }
        return names_of(found.times());
    }
    /// Until only the picture is drawn, in at most so many frames; how many that took.
    int settle(int most = 40) {
        for (int k = 1; k <= most; ++k)
            if (!draws_captures(frame())) return k;
        ADD_FAILURE() << "captures are still drawn after " << most << " frames";
        return most;
    }
    void change(const scene::Edit& edit) {
        for (app::Session* session : {&all_, &few_}) session->change(edit);
    }
    void both(const std::function<void(app::Session&)>& act) {
        act(all_);
        act(few_);
    }
    const scene::Scene& scene() const { return all_.scene(); }
    app::Counts counts() const { return few_.counts(); }

    app::FrameSpec spec;

private:
    app::Session all_, few_;
    int number_ = 0;
};

class Required : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Rows, Required,
                         testing::Values("reuse:face=16", "parallax:face=16",
                                         "parallax:face=16,distance=unorm8,colour=float",
                                         "secant:face=16", "layered:face=16", "pyramid:face=auto",
                                         "hybrid:face=16", "naive:face=16", "raytrace:depth=3",
                                         "1=parallax:face=16 2=secant:face=8 *=naive:face=16"),
                         [](const auto& instance) {
                             return "row" + std::to_string(instance.index);
                         });

TEST_P(Required, ShowsWhatEverythingShows) {
    Pair pair(test::room(3, 2), {GetParam()});
    for (int k = 0; k < 6; ++k) pair.frame();
    scene::Material dark = pair.scene().materials[1];
    dark.albedo = {.1f, .2f, .6f};
    pair.change(scene::set_material(1, dark));
    pair.frame(), pair.frame();
    pair.spec.camera.eye.x += .2;
    pair.frame();
    dmat4 place = pair.scene().objects.back().world_from_object;
    place[3].x -= .3;
    pair.change(scene::move(pair.scene().objects.size() - 1, place));
    pair.frame(), pair.frame();
    pair.spec.ambient = .2;
    for (int k = 0; k < 4; ++k) pair.frame();
}

TEST(RequiredFrames, OfAStillSceneAreViewAndCompose) {
    Pair pair(test::hall(), {"parallax:face=32"});
    // Nobody looks behind the panel on the wall.
    EXPECT_EQ(pair.frame(), (Names{"shadow", "capture/1", "capture/2", "capture/3.1-4",
                                   "capture/3.6-6", "capture/3.5-5.clear", "view", "compose"}));
    // Of each mirror the faces that show another.
    EXPECT_EQ(pair.frame(),
              (Names{"capture.keep", "capture/1.1-1", "capture/1.3-3", "capture/1.5-5",
                     "capture/2.2-3", "capture/2.5-6", "capture/3.1-2", "capture/3.4-4",
                     "capture/3.6-6", "capture.compare", "view", "compose"}));
    EXPECT_LT(pair.settle(), 40);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(pair.frame(), kSettled);
    pair.spec.camera.eye.x += .1;
    EXPECT_EQ(pair.frame(), kSettled) << "captures are not the camera's";
}

TEST(RequiredFrames, ShowFlatMirrorsBesideCaptures) {
    Pair pair(test::hall(), {"3=planar *=parallax:face=16"});
    for (int k = 0; k < 3; ++k) pair.frame();
    pair.settle();
    pair.spec.camera.eye.x += .1;
    pair.frame();
}

TEST(RequiredFrames, DrawAnewWhatChanged) {
    Pair pair(test::room(3, 2), {"parallax:face=16"});
    pair.settle();
    const std::size_t lamp = pair.scene().materials.size() - 2;
    scene::Material off = pair.scene().materials[lamp];
    off.emission *= .25f;
    pair.change(scene::set_material(lamp, off));
    EXPECT_TRUE(draws_captures(pair.frame())) << "a light is dimmed";
    pair.settle();
    scene::Material painted = pair.scene().materials[0];
    painted.albedo = {.2f, .2f, .2f};
    pair.change(scene::set_material(0, painted));
    EXPECT_TRUE(draws_captures(pair.frame())) << "a wall has another colour";
    pair.settle();
    pair.spec.ambient = .3;
    EXPECT_TRUE(draws_captures(pair.frame())) << "there is more light everywhere";
    pair.settle();
    EXPECT_EQ(pair.frame(), kSettled);
}

TEST(RequiredFrames, FollowWhatMovesUntilItStands) {
    Pair pair(scene::cornell_mirrors(), {"parallax:face=16"});
    for (int k = 0; k < 8; ++k) {
        EXPECT_TRUE(draws_captures(pair.frame()));
        pair.spec.time += 1 / 60.0;
    }
    pair.settle();
    EXPECT_EQ(pair.frame(), kSettled);
}

TEST(RequiredFrames, BeginAnewAfterACut) {
    Pair pair(test::room(3, 1), {"reuse:face=16"});
    pair.settle();
    pair.both([](app::Session& session) { session.forget(); });
    EXPECT_TRUE(draws_captures(pair.frame()));
    const std::vector<std::string> before = std::exchange(pair.spec.techniques, {"secant:face=16"});
    for (int k = 0; k < 3; ++k) pair.frame();
    pair.spec.techniques = before;
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(draws_captures(pair.frame()));
}

TEST(RequiredFrames, BeginAnewWithOtherEdges) {
    Pair pair(test::room(3, 1), {"parallax:face=auto"});
    for (int k = 0; k < 3; ++k) pair.frame();
    pair.spec.size = {72, 56}; // finer
    EXPECT_TRUE(draws_captures(pair.frame()));
    pair.settle();
}

TEST(RequiredFrames, GoOnFromWhereTheyWereSetAside) {
    Pair pair(test::room(3, 1), {"parallax:face=16"});
    for (int k = 0; k < 3; ++k) pair.frame();
    std::vector<app::Sequence> aside;
    pair.both([&](app::Session& session) { aside.push_back(session.set_aside()); });
    for (int k = 0; k < 2; ++k) pair.frame(); // others, of the same technique
    std::size_t i = 0;
    pair.both([&](app::Session& session) { session.resume(std::move(aside[i++])); });
    pair.settle();
    aside.clear(), i = 0;
    pair.both([&](app::Session& session) { aside.push_back(session.set_aside()); });
    pair.frame();
    pair.both([&](app::Session& session) { session.resume(std::move(aside[i++])); });
    EXPECT_EQ(pair.frame(), kSettled);
}

TEST(RequiredFrames, AsideLeaveTheSequenceAlone) {
    Pair pair(test::room(3, 1), {"parallax:face=16"});
    const app::FrameSpec still = pair.spec;
    const auto aside = [&](const char* technique, double ambient) {
        pair.spec.is_aside = true;
        pair.spec.techniques = {technique};
        pair.spec.ambient = ambient;
        pair.frame();
        pair.spec = still;
    };
    for (int k = 0; k < 4; ++k) {
        pair.frame();
        aside("parallax:face=16", .05 * (k + 2));
        aside("raytrace:depth=2", .05);
    }
    pair.settle();
    aside("parallax:face=16", .4);
    EXPECT_EQ(pair.frame(), kSettled);
    pair.spec.ambient = .4;
    EXPECT_TRUE(draws_captures(pair.frame()));
}

/// What comparisons find is known late then; no frame waits for it.
TEST(RequiredFrames, SettleWithSeveralInFlight) {
    const scene::Scene scene = test::room(3, 1);
    app::Session all(test::engine(), scene, 3), few(test::engine(), scene, 3);
    app::FrameSpec spec = test::request(scene, {"parallax:face=16"}, kSize);
    app::FrameSpec required = spec;
    required.model = app::Modelling::required;
    std::optional<app::Frame> wanted, found;
    for (int k = 0; k < 48; ++k) wanted = all.frame(spec), found = few.frame(required);
    EXPECT_TRUE(test::same_bytes(found->hdr(), wanted->hdr()));
    EXPECT_EQ(names_of(found->times()), kSettled);
}

TEST(RequiredFrames, TakeNoMoreMemoryWithTime) {
    Pair pair(scene::cornell_mirrors(), {"parallax:face=16", "reuse:face=16"});
    pair.frame(), pair.frame(), pair.frame();
    const std::uint64_t before = pair.counts().memory_bytes;
    for (int k = 0; k < 30; ++k) {
        pair.spec.time += k % 6 < 2 ? .1 : 0;
        pair.frame();
    }
    EXPECT_EQ(pair.counts().memory_bytes, before);
}

TEST(RequiredFrames, SayWhatTheyAre) {
    const scene::Scene scene = test::room(1, 1);
    app::Session session(test::engine(), scene);
    app::FrameSpec spec = test::request(scene, {"reuse:face=16"}, kSize);
    EXPECT_EQ(session.frame(spec).read().model, app::Modelling::everything);
    spec.model = app::Modelling::required;
    const app::Frame frame = session.frame(spec);
    EXPECT_EQ(frame.read().model, app::Modelling::required);
    EXPECT_FALSE(frame.model().is_everything);
    EXPECT_EQ(frame.model().mirrors.size(), 1u);
    const std::string plan = session.plan(spec, app::PlanFormat::text);
    EXPECT_EQ(plan.find("capture/1"), std::string::npos) << plan;
}

} // namespace
