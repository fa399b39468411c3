// Tests of the model `required`, which leaves out work that a picture does not need. Each picture
// must equal that of a session that renders everything, byte for byte.
#include "import/load.hpp"
#include "require/model.hpp"
#include "scene/built_in.hpp"
#include "scene/shapes.hpp"
#include "session/access.hpp"
#include "support/drawn_hall.hpp"
#include "support/rendering.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>

#include <functional>

namespace {

using namespace catoptric;
using Names = std::vector<std::string>;

constexpr uvec2 kRequiredPictureSize{40, 32};
/// Largest number of bounces that can change a byte of a picture in the random halls.
constexpr int kMaxVisibleBounces = 8;

Names pass_names(const session::FrameTimes& times) {
    Names names;
    for (const session::PassTime& pass : times.passes) names.push_back(pass.name);
    return names;
}

bool do_passes_draw_captures(const Names& names) {
    return std::ranges::any_of(
        names, [](const std::string& name) { return name.starts_with("capture/"); });
}

const Names kSettledPassNames{"view", "compose"};

bool does_model_need_all_faces(const require::WorkModel& model) {
    return std::ranges::all_of(model.mirrors, [](const require::MirrorRequirements& mirror) {
        return mirror.is_captured && mirror.faces == require::kAllFaces;
    });
}

/// Two sessions of the same scene that receive the same edits: one renders everything, the other
/// what is required.
class RequiredAndFullSessions {
public:
    RequiredAndFullSessions(const scene::Scene& scene, std::vector<std::string> techniques,
                            std::uint32_t in_flight = 1)
        : frame_spec(test::make_test_request(scene, techniques, kRequiredPictureSize)),
          all_(test::get_test_engine(), scene, in_flight),
          few_(test::get_test_engine(), scene, in_flight) {}

    /// Renders the next frame in both sessions and compares the pictures. Returns the names of the
    /// passes of the session that renders what is required.
    Names render_next_frame() {
        const auto [wanted, found] = render_frames();
        model_ = session::Access::rendered_model(found);
        EXPECT_TRUE(have_same_pictures(wanted, found)) << "frame " << number_;
        if (!frame_spec.keeps_history) {
            EXPECT_EQ(session::Access::remembers(found), session::Access::remembers(wanted));
            // If not all faces are needed, some hold nothing, so the states differ.
            const bool is_whole = does_model_need_all_faces(session::Access::rendered_model(found));
            EXPECT_TRUE(!is_whole ||
                        session::Access::read_state(found) == session::Access::read_state(wanted))
                << "frame " << number_;
        }
        return pass_names(found.times());
    }
    /// Renders twice `most` frames. Expects that the pictures of both sessions are equal after the
    /// first `most` frames. Returns the number of the last frame in which they differed.
    int render_until_pictures_are_equal(int most) {
        int last = 0; // number of the last frame with a difference
        for (int k = 1; k <= 2 * most; ++k) {
            const auto [wanted, found] = render_frames();
            if (!have_same_pictures(wanted, found)) last = k;
        }
        EXPECT_LE(last, most);
        return last;
    }
    /// Renders frames until no capture is drawn any more, at most `most` frames. Returns their
    /// number.
    int render_until_captures_settle(int most = 40) {
        for (int k = 1; k <= most; ++k)
            if (!do_passes_draw_captures(render_next_frame())) return k;
        ADD_FAILURE() << "captures are still drawn after " << most << " frames";
        return most;
    }
    void edit_both_scenes(const scene::Edit& edit) {
        for (session::Session* session : {&all_, &few_}) session->change(edit);
    }
    void apply_to_both_sessions(const std::function<void(session::Session&)>& act) {
        act(all_);
        act(few_);
    }
    const scene::Scene& edited_scene() const { return all_.scene(); }
    session::SessionCounters counters_of_required_session() const {
        return session::Access::session_counters(few_);
    }
    const require::WorkModel& last_required_model() const {
        return model_;
    } ///< model of the last frame

    session::FrameSpec frame_spec;

private:
    std::pair<session::Frame, session::Frame> render_frames() {
        ++number_;
        session::FrameSpec required = frame_spec;
        required.model = session::RenderedWork::required;
        session::Frame wanted = all_.frame(
            frame_spec); // renders everything, before the other session
        return {std::move(wanted), few_.frame(required)};
    }
    static bool have_same_pictures(const session::Frame& wanted, const session::Frame& found) {
        bool same = true;
        for (std::size_t part = 0; part < wanted.size(); ++part)
            same = same && test::have_equal_pixel_bytes(found.hdr(part), wanted.hdr(part));
        return same;
    }

    session::Session all_, few_;
    require::WorkModel model_;
    int number_ = 0;
};

class RequiredWorkTest : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Rows, RequiredWorkTest,
                         testing::Values("reuse:face=16", "parallax:face=16",
                                         "parallax:face=16,distance=unorm8,colour=float",
                                         "secant:face=16", "layered:face=16", "pyramid:face=auto",
                                         "hybrid:face=16", "naive:face=16", "raytrace:depth=3",
                                         "1=parallax:face=16 2=secant:face=8 *=naive:face=16"),
                         [](const auto& instance) {
                             return "row" + std::to_string(instance.index);
                         });

TEST_P(RequiredWorkTest, PicturesEqualThoseOfEverything) {
    if (std::string_view(GetParam()).ends_with("colour=float") && !test::has_float_colour())
        GTEST_SKIP() << "this device does not filter images of 32-bit floats";
    RequiredAndFullSessions pair(test::make_lit_room(3, 2), {GetParam()});
    for (int k = 0; k < 6; ++k) pair.render_next_frame();
    scene::Material dark = pair.edited_scene().materials[1];
    dark.albedo = {.1f, .2f, .6f};
    pair.edit_both_scenes(scene::set_material(1, dark));
    pair.render_next_frame(), pair.render_next_frame();
    pair.frame_spec.camera.eye.x += .2;
    pair.render_next_frame();
    dmat4 place = pair.edited_scene().objects.back().world_from_object;
    place[3].x -= .3;
    pair.edit_both_scenes(scene::move(pair.edited_scene().objects.size() - 1, place));
    pair.render_next_frame(), pair.render_next_frame();
    pair.frame_spec.ambient = .2;
    for (int k = 0; k < 4; ++k) pair.render_next_frame();
}

TEST(RequiredFrames, StillSceneNeedsOnlyViewAndCompose) {
    RequiredAndFullSessions pair(test::make_mirror_hall(), {"parallax:face=32"});
    // No mirror pixel looks at the part of the panel's capture behind the wall, so that face is
    // cleared.
    EXPECT_EQ(pair.render_next_frame(),
              (Names{"shadow", "capture/1", "capture/2", "capture/3.1-4", "capture/3.6-6",
                     "capture/3.5-5.clear", "view", "compose"}));
    // The second frame draws only the faces that show another mirror, and within a face only the
    // area of these mirrors.
    EXPECT_EQ(pair.render_next_frame(),
              (Names{"capture.keep", "capture/1.1-1", "capture/1.3-3", "capture/1.5-5",
                     "capture/2.2-2", "capture/2.3-3", "capture/2.5-5", "capture/3.1-1",
                     "capture/3.4-4", "capture/3.6-6", "capture.compare", "view", "compose"}));
    EXPECT_LT(pair.render_until_captures_settle(), 40);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(pair.render_next_frame(), kSettledPassNames);
    pair.frame_spec.camera.eye.x += .1;
    EXPECT_EQ(pair.render_next_frame(), kSettledPassNames) << "captures are not the camera's";
}

/// The filtered levels of a rough mirror show light from all around, also from behind its plane.
TEST(RequiredFrames, RoughFlatMirrorsKeepTheirPictures) {
    for (const char* technique : {"reuse:face=16", "secant:face=16"}) {
        scene::Scene scene = test::make_mirror_hall();
        test::make_mirrors_rough(scene, .5f);
        RequiredAndFullSessions pair(scene, {technique});
        for (const double side : {-1., 1.}) { // views along the mirror on the wall
            pair.frame_spec.camera.eye = {1.8 * side, 0, 1.4};
            pair.frame_spec.camera.target = {-1.5 * side, 0, 1.9};
            EXPECT_EQ(pair.render_until_pictures_are_equal(2), 0) << technique;
        }
    }
}

/// The first mirror is out of sight and has no capture. The options of the captures must come from
/// a mirror that has one.
TEST(RequiredFrames, FirstMirrorNeedsNoCapture) {
    scene::Scene scene = test::make_mirror_hall();
    test::add_ball(scene, "outside", scene.objects.back().material, {9, 0, 0}, .5, 2);
    std::rotate(scene.objects.begin(), scene.objects.end() - 1, scene.objects.end());
    RequiredAndFullSessions pair(scene, {"secant:face=32"});
    for (int k = 0; k < 2; ++k) {
        EXPECT_THAT(pair.render_next_frame(), testing::Not(testing::Contains("capture/1")));
        EXPECT_FALSE(pair.last_required_model().mirrors[0].is_captured);
    }
}

TEST(RequiredFrames, FlatMirrorsAreShownBesideCaptures) {
    RequiredAndFullSessions pair(test::make_mirror_hall(), {"3=planar *=parallax:face=16"});
    for (int k = 0; k < 3; ++k) pair.render_next_frame();
    pair.render_until_captures_settle();
    pair.frame_spec.camera.eye.x += .1;
    pair.render_next_frame();
}

TEST(RequiredFrames, ChangedLightAndMaterialsAreDrawnAgain) {
    RequiredAndFullSessions pair(test::make_lit_room(3, 2), {"parallax:face=16"});
    pair.render_until_captures_settle();
    const std::size_t lamp = pair.edited_scene().materials.size() - 2;
    scene::Material off = pair.edited_scene().materials[lamp];
    off.emission *= .25f;
    pair.edit_both_scenes(scene::set_material(lamp, off));
    EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame())) << "a light is dimmed";
    pair.render_until_captures_settle();
    scene::Material painted = pair.edited_scene().materials[0];
    painted.albedo = {.2f, .2f, .2f};
    pair.edit_both_scenes(scene::set_material(0, painted));
    EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame())) << "a wall has another colour";
    pair.render_until_captures_settle();
    pair.frame_spec.ambient = .3;
    EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame()))
        << "there is more light everywhere";
    pair.render_until_captures_settle();
    EXPECT_EQ(pair.render_next_frame(), kSettledPassNames);
}

TEST(RequiredFrames, MovingObjectsAreDrawnUntilTheyStop) {
    RequiredAndFullSessions pair(scene::make_cornell(), {"parallax:face=16"});
    for (int k = 0; k < 8; ++k) {
        EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame()));
        pair.frame_spec.time += 1 / 60.0;
    }
    pair.render_until_captures_settle();
    EXPECT_EQ(pair.render_next_frame(), kSettledPassNames);
}

// The pyramid is computed from all six faces of a cube whenever one of them is drawn.
TEST(RequiredFrames, PyramidIsMadeAgainWheneverACaptureIsDrawn) {
    RequiredAndFullSessions pair(scene::make_cornell(), {"pyramid:face=16"});
    for (int k = 0; k < 6; ++k) {
        EXPECT_THAT(pair.render_next_frame(), testing::Contains("pyramid"));
        pair.frame_spec.time += 1 / 20.0;
    }
    pair.render_until_captures_settle();
    EXPECT_EQ(pair.render_next_frame(), kSettledPassNames);
    pair.frame_spec.ambient = .3; // only colours change, but a capture is drawn as a whole
    EXPECT_THAT(pair.render_next_frame(), testing::Contains("pyramid"));
}

/// Returns a closed room with a mirror ball, a block beside it and a point light.
scene::Scene make_room_with_block() {
    scene::Scene scene{.name = "block"};
    const std::size_t white = add_material(scene, {.albedo = vec3(.7f)});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, dvec3(-10), dvec3(10)), white);
    scene::PunctualLight bulb{.name = "bulb", .intensity = vec3(100)};
    bulb.world_from_light[3] = {0, 8, 0, 1};
    scene.punctual.push_back(bulb);
    test::add_ball(scene, "ball", add_material(scene, {.mirror = true}), {0, 0, 0}, .5, 2);
    test::add_mesh(scene, scene::box("block", dvec3(-.2), dvec3(.2)), white);
    scene.objects.back().world_from_object[3] = {3.5, 0, 0, 1};
    scene.cameras.push_back({.eye = {0, 0, -5}, .target = {0, 0, 0}});
    return scene;
}

TEST(RequiredFrames, OnlyFacesThatShowTheMoverAreDrawn) {
    RequiredAndFullSessions pair(make_room_with_block(), {"parallax:face=16,shadow_map=64"});
    const std::size_t block = pair.edited_scene().objects.size() - 1;
    const auto move = [&](double x) {
        dmat4 place = pair.edited_scene().objects[block].world_from_object;
        place[3].x = x;
        pair.edit_both_scenes(scene::move(block, place));
        return pair.render_next_frame();
    };
    pair.render_until_captures_settle();
    EXPECT_THAT(move(3.4), testing::Contains("capture/1")) << "it had never moved before";
    pair.render_until_captures_settle();
    // The block changes the capture's face +X, and its shadow the face below. The shadow map
    // changes in its face below.
    EXPECT_EQ(move(3.3), (Names{"shadow.4-4", "capture.keep", "capture/1.1-1", "capture/1.4-4",
                                "view", "compose"}));
    pair.render_until_captures_settle();
    EXPECT_THAT(move(2.1), testing::Contains("capture/1")) << "nearer than 2: another near plane";
    pair.render_until_captures_settle();
    EXPECT_THAT(move(2.0), testing::Not(testing::Contains("capture/1")));
}

/// Random halls with partitions that hide mirrors, with random events. The capture of a hidden
/// mirror starts when the mirror comes into view. Reflections of other hidden mirrors in the
/// capture arrive one bounce per frame. Everything else must be right at once.
TEST(RequiredFrames, PicturesAreRightAfterRandomEvents) {
    for (const std::uint64_t seed : {3, 11, 12}) {
        SCOPED_TRACE(seed);
        const scene::Scene hall = test::make_random_hall(seed, 4);
        RequiredAndFullSessions pair(
            hall, {"1=parallax:face=16,shadow_map=64 *=secant:face=16,shadow_map=64"});
        const auto object = [&](const std::string& name, std::size_t count) {
            for (std::size_t i = 0; i < hall.objects.size(); ++i)
                if (hall.objects[i].name == name && count-- == 0) return i;
            return hall.objects.size() - 1; // the hall of this seed has no such object
        };
        const auto frames = [&](int count) {
            for (int k = 0; k < count; ++k) pair.render_next_frame();
        };
        frames(4);
        int late = 0;
        for (const std::size_t mirror : scene::mirrors(hall)) { // each mirror comes into view
            const dvec3 place(hall.objects[mirror].world_from_object[3]);
            pair.frame_spec.camera = {.eye = place + dvec3(.3, .2, -1.7), .target = place};
            late = std::max(late, pair.render_until_pictures_are_equal(kMaxVisibleBounces));
        }
        const scene::Material lit = pair.edited_scene().materials[3];
        scene::Material dark = lit;
        dark.emission = vec3(0);
        pair.edit_both_scenes(scene::set_material(3, dark));
        frames(2);
        pair.edit_both_scenes(scene::set_material(3, lit));
        frames(1);
        for (const auto& [name, by] :
             {std::pair{"partition", dvec3(0, 0, .8)}, std::pair{"ball", dvec3(.4, .1, 0)},
              std::pair{"block", dvec3(0, -.2, .5)}})
            for (int k = 0; k < 3; ++k) { // the object begins to move and continues
                const std::size_t moved = object(name, 0);
                dmat4 to = pair.edited_scene().objects[moved].world_from_object;
                to[3] += dvec4(by, 0);
                pair.edit_both_scenes(scene::move(moved, to));
                frames(1);
            }
        frames(3);
        std::printf("  pictures of mirrors that came into view differed for %d frames\n", late);
    }
}

TEST(RequiredFrames, CapturesAreDrawnAgainAfterACut) {
    RequiredAndFullSessions pair(test::make_lit_room(3, 1), {"reuse:face=16"});
    pair.render_until_captures_settle();
    pair.apply_to_both_sessions([](session::Session& session) { session.forget(); });
    EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame()));
    const std::vector<std::string> before = std::exchange(pair.frame_spec.techniques,
                                                          {"secant:face=16"});
    for (int k = 0; k < 3; ++k) pair.render_next_frame();
    pair.frame_spec.techniques = before;
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame()));
}

TEST(RequiredFrames, CapturesAreDrawnAgainAtAnotherResolution) {
    RequiredAndFullSessions pair(test::make_lit_room(3, 1), {"parallax:face=auto"});
    for (int k = 0; k < 3; ++k) pair.render_next_frame();
    pair.frame_spec.size = {72, 56}; // a larger picture needs finer captures
    EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame()));
    pair.render_until_captures_settle();
}

TEST(RequiredFrames, ResumedSequenceKeepsItsCaptures) {
    RequiredAndFullSessions pair(test::make_lit_room(3, 1), {"parallax:face=16"});
    for (int k = 0; k < 3; ++k) pair.render_next_frame();
    std::vector<session::FrameSequence> aside;
    pair.apply_to_both_sessions(
        [&](session::Session& session) { aside.push_back(session::Access::suspend(session)); });
    for (int k = 0; k < 2; ++k)
        pair.render_next_frame(); // frames of another sequence with the same technique
    std::size_t i = 0;
    pair.apply_to_both_sessions([&](session::Session& session) {
        session::Access::resume(session, std::move(aside[i++]));
    });
    pair.render_until_captures_settle();
    aside.clear(), i = 0;
    pair.apply_to_both_sessions(
        [&](session::Session& session) { aside.push_back(session::Access::suspend(session)); });
    pair.render_next_frame();
    pair.apply_to_both_sessions([&](session::Session& session) {
        session::Access::resume(session, std::move(aside[i++]));
    });
    EXPECT_EQ(pair.render_next_frame(), kSettledPassNames);
}

TEST(RequiredFrames, FramesThatKeepHistoryLeaveTheSequenceAlone) {
    RequiredAndFullSessions pair(test::make_lit_room(3, 1), {"parallax:face=16"});
    const session::FrameSpec still = pair.frame_spec;
    const auto aside = [&](const char* technique, double ambient) {
        pair.frame_spec.keeps_history = true;
        pair.frame_spec.techniques = {technique};
        pair.frame_spec.ambient = ambient;
        pair.render_next_frame();
        pair.frame_spec = still;
    };
    for (int k = 0; k < 4; ++k) {
        pair.render_next_frame();
        aside("parallax:face=16", .05 * (k + 2));
        aside("raytrace:depth=2", .05);
    }
    pair.render_until_captures_settle();
    aside("parallax:face=16", .4);
    EXPECT_EQ(pair.render_next_frame(), kSettledPassNames);
    pair.frame_spec.ambient = .4;
    EXPECT_TRUE(do_passes_draw_captures(pair.render_next_frame()));
}

/// With frames in flight, results of comparisons arrive late, and no frame waits for them.
TEST(RequiredFrames, CapturesSettleWithSeveralFramesInFlight) {
    const scene::Scene scene = test::make_lit_room(3, 1);
    session::Session all(test::get_test_engine(), scene, 3), few(test::get_test_engine(), scene, 3);
    session::FrameSpec spec = test::make_test_request(scene, {"parallax:face=16"},
                                                      kRequiredPictureSize);
    session::FrameSpec required = spec;
    required.model = session::RenderedWork::required;
    std::optional<session::Frame> wanted, found;
    for (int k = 0; k < 48; ++k) wanted = all.frame(spec), found = few.frame(required);
    EXPECT_TRUE(test::have_equal_pixel_bytes(found->hdr(), wanted->hdr()));
    EXPECT_EQ(pass_names(found->times()), kSettledPassNames);
}

TEST(RequiredFrames, MemoryStaysConstantOverTime) {
    RequiredAndFullSessions pair(scene::make_cornell(), {"parallax:face=16", "reuse:face=16"});
    pair.render_next_frame(), pair.render_next_frame(), pair.render_next_frame();
    const std::uint64_t before = pair.counters_of_required_session().memory_bytes;
    for (int k = 0; k < 30; ++k) {
        pair.frame_spec.time += k % 6 < 2 ? .1 : 0;
        pair.render_next_frame();
    }
    EXPECT_EQ(pair.counters_of_required_session().memory_bytes, before);
}

TEST(RequiredFrames, FramesReportTheirModel) {
    const scene::Scene scene = test::make_lit_room(1, 1);
    session::Session session(test::get_test_engine(), scene);
    session::FrameSpec spec = test::make_test_request(scene, {"reuse:face=16"},
                                                      kRequiredPictureSize);
    EXPECT_EQ(session.frame(spec).read().model, session::RenderedWork::everything);
    spec.model = session::RenderedWork::required;
    const session::Frame frame = session.frame(spec);
    EXPECT_EQ(frame.read().model, session::RenderedWork::required);
    EXPECT_FALSE(session::Access::rendered_model(frame).is_everything);
    EXPECT_EQ(session::Access::rendered_model(frame).mirrors.size(), 1u);
    const std::string plan = session::Access::format_plan(session, spec, session::PlanFormat::text);
    EXPECT_EQ(plan.find("capture/1"), std::string::npos) << plan;
}

} // namespace
