// Tests which mirrors a picture requires. Some cases have known answers; in others, random rays
// must meet no mirror that was called unseen.
#include "core/mirror_id.hpp"
#include "import/load.hpp"
#include "require/frustum.hpp"
#include "require/sight.hpp"
#include "scene/material_facts.hpp"
#include "scene/pose.hpp"
#include "scene/shapes.hpp"
#include "support/drawn_hall.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using namespace catoptric::require;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Wall make_square_wall() { return make_wall({{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}}}, 0); }

Bounds<double> bounds_around_point(dvec3 middle, double half) {
    return {middle - half, middle + half};
}

TEST(RequireWall, WallHidesBoxesThatItCoversFromTheEye) {
    const Bounds<double> eye = bounds_around_point({0, 0, 2}, 0);
    // The wall is 2 in front of the eye. At 3.9 in front of the eye, it hides everything from -1.95
    // to 1.95.
    EXPECT_TRUE(hides(make_square_wall(), eye, bounds_around_point({0, 0, -2}, 1.3), 0));
    EXPECT_TRUE(hides(make_square_wall(), eye, bounds_around_point({1.84, 0, -2}, .1), 0));
    EXPECT_FALSE(hides(make_square_wall(), eye, bounds_around_point({1.86, 0, -2}, .1), 0));
    // The line of sight passes .005 from the wall's edge.
    EXPECT_FALSE(hides(make_square_wall(), eye, bounds_around_point({1.84, 0, -2}, .1), .01));
    // The box reaches through the wall.
    EXPECT_FALSE(hides(make_square_wall(), eye, bounds_around_point({0, 0, -2}, 2.1), 0));
    // The box is in front of the wall.
    EXPECT_FALSE(hides(make_square_wall(), eye, bounds_around_point({0, 0, 1}, .1), 0));
}

TEST(RequireWall, WallHidesABoxFromARegionIfHiddenFromEveryPoint) {
    const Bounds<double> target = bounds_around_point({0, 0, -2}, .5);
    // Lines of sight cross the wall up to .8 from its middle.
    EXPECT_TRUE(hides(make_square_wall(), bounds_around_point({0, 0, 2}, 1), target, 0));
    EXPECT_FALSE(hides(make_square_wall(), bounds_around_point({2.2, 0, 2}, .1), target, 0));
    // The region's far corner sees past the wall.
    EXPECT_FALSE(hides(make_square_wall(), bounds_around_point({1, 0, 2}, 1), target, 0));
    // The region reaches through the wall.
    EXPECT_FALSE(hides(make_square_wall(), bounds_around_point({0, 0, .5}, 1), target, 0));
}

TEST(RequireWall, OneSidedWallHidesOnlyFromTheFront) {
    Wall wall = make_square_wall();
    wall.front_only = true;
    const Bounds<double> front = bounds_around_point({0, 0, 2}, 0),
                         behind = bounds_around_point({0, 0, -2}, 0);
    EXPECT_TRUE(hides(wall, front, bounds_around_point({0, 0, -1}, .2), 0));
    EXPECT_FALSE(hides(wall, behind, bounds_around_point({0, 0, 1}, .2), 0));
    EXPECT_TRUE(hides_from_orthographic(wall, {0, 0, 2}, {0, 0, -1},
                                        bounds_around_point({0, 0, -1}, .9), 0));
    EXPECT_FALSE(hides_from_orthographic(wall, {0, 0, -2}, {0, 0, 1},
                                         bounds_around_point({0, 0, 1}, .9), 0));
}

TEST(RequireWall, WallHidesBoxesAlongParallelLinesOfSight) {
    const dvec3 eye(0, 0, 5), down(0, 0, -1);
    EXPECT_TRUE(hides_from_orthographic(make_square_wall(), eye, down,
                                        bounds_around_point({0, 0, -3}, .99), 0));
    EXPECT_FALSE(hides_from_orthographic(make_square_wall(), eye, down,
                                         bounds_around_point({0, 0, -3}, 1.01), 0));
    // The eye is behind the wall.
    EXPECT_FALSE(hides_from_orthographic(make_square_wall(), {0, 0, -.5}, down,
                                         bounds_around_point({0, 0, -3}, .5), 0));
    // At 45 degrees, the wall hides a box that is as far to the side as it is behind the wall.
    const dvec3 slanting = glm::normalize(dvec3(1, 0, -1));
    EXPECT_TRUE(hides_from_orthographic(make_square_wall(), eye, slanting,
                                        bounds_around_point({3, 0, -3}, .4), 0));
    EXPECT_FALSE(hides_from_orthographic(make_square_wall(), eye, slanting,
                                         bounds_around_point({0, 0, -3}, .4), 0));
}

TEST(RequireWall, WallsAreMadeOfFlatConvexQuadrilaterals) {
    EXPECT_EQ(find_convex_quads(scene::quad("", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})).size(),
              1u);
    EXPECT_EQ(find_convex_quads(scene::box("", dvec3(0), dvec3(1))).size(), 6u);
    EXPECT_THAT(find_convex_quads(scene::ball("", 2)), IsEmpty());
    // The first quadrilateral is bent along its diagonal, the second is not convex.
    EXPECT_THAT(find_convex_quads(scene::quad("", {0, 0, 0}, {1, 0, 0}, {1, 1, .001}, {0, 1, 0})),
                IsEmpty());
    EXPECT_THAT(find_convex_quads(scene::quad("", {0, 0, 0}, {1, 0, 0}, {.2, .2, 0}, {0, 1, 0})),
                IsEmpty());
}

TEST(RequireFrustum, CaptureFacesThatMayShowABoxAreFound) {
    EXPECT_EQ(faces_showing_box(bounds_around_point({3, 0, 0}, 1)),
              1); // only face +X shows the box
    EXPECT_EQ(faces_showing_box(bounds_around_point({0, -3, 0}, 1)),
              1 << 3); // only face -Y shows the box
    EXPECT_EQ(faces_showing_box(bounds_around_point({3, 3, 0}, .5)),
              1 | 1 << 2); // faces +X and +Y show the box
    EXPECT_EQ(faces_showing_box(bounds_around_point({-2, 2, -2}, .1)),
              2 | 4 | 32); // faces -X, +Y and -Z show the box
    EXPECT_EQ(faces_showing_box(bounds_around_point({0, 0, 0}, .1)), kAllFaces);
    EXPECT_EQ(faces_in_front({0, 0, 1}, .1),
              kAllFaces & ~(1 << 5)); // all faces except -Z are in front of the plane
    EXPECT_EQ(faces_in_front(glm::normalize(dvec3(1, 0, 1)), .1), kAllFaces);
}

TEST(RequireFrustum, FrustumHoldsBoxesInThePicture) {
    scene::Camera camera{.eye = {0, 0, 0}, .target = {0, 0, 1}, .vertical_fov_degrees = 90};
    const PictureFrustum wide(camera, {200, 100});
    EXPECT_TRUE(wide.may_contain_box(bounds_around_point({0, 9, 10}, .1)));
    EXPECT_FALSE(wide.may_contain_box(bounds_around_point({0, 11, 10}, .1)));
    EXPECT_TRUE(wide.may_contain_box(bounds_around_point({19, 0, 10}, .1)));
    EXPECT_FALSE(wide.may_contain_box(bounds_around_point({21, 0, 10}, .1)));
    EXPECT_FALSE(wide.may_contain_box(bounds_around_point({0, 0, -1}, .5)));
    camera.orthographic_height = 4;
    const PictureFrustum parallel(camera, {200, 100});
    EXPECT_TRUE(parallel.may_contain_box(bounds_around_point({0, 1.8, 100}, .1)));
    EXPECT_FALSE(parallel.may_contain_box(bounds_around_point({0, 2.2, 100}, .1)));
    EXPECT_TRUE(parallel.may_contain_box(bounds_around_point({3.8, 0, 100}, .1)));
    EXPECT_FALSE(parallel.may_contain_box(bounds_around_point({4.2, 0, 100}, .1)));
}

/// Returns a hall with three mirrors in front of a partition and one mirror behind the partition.
scene::Scene make_hall_with_partition() {
    scene::Scene scene{.name = "parted"};
    const std::size_t white = add_material(scene, {.albedo = vec3(.7f)}),
                      mirror = add_material(scene, {.mirror = true});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, {-4, -4, -4}, {4, 4, 8}), white);
    test::add_quad(scene, "partition", white, {-4, -4, 2}, {4, -4, 2}, {4, 4, 2}, {-4, 4, 2});
    const std::array<dvec3, 4> places{{{0, 0, 0}, {-2, 0, 1}, {0, 1, -3.4}, {0, 0, 5}}};
    for (const dvec3& place : places) test::add_ball(scene, "ball", mirror, place, .4, 2);
    scene.cameras.push_back({.eye = {0, 0, -2}, .target = {0, 0, 1}, .vertical_fov_degrees = 60});
    return scene;
}

TEST(RequireSight, MirrorThatIsNotSeenIsNotCaptured) {
    const scene::Scene scene = make_hall_with_partition();
    const WorkModel model = make_required_model({scene, scene.cameras[0]});
    ASSERT_EQ(model.mirrors.size(), 4u);
    for (const std::size_t seen : {0, 1, 2}) EXPECT_TRUE(model.mirrors[seen].is_captured) << seen;
    EXPECT_FALSE(model.mirrors[3].is_seen);
    EXPECT_FALSE(model.mirrors[3].is_captured);
    EXPECT_FALSE(model.mirrors[0].seen_in);
    EXPECT_EQ(model.mirrors[2].seen_in, MirrorId(1)); // mirror 3 is behind the camera
    EXPECT_THAT(model.mirrors[0].sees, ElementsAre(1, 2));
    EXPECT_THAT(model.mirrors[3].sees, IsEmpty());
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "the capture of mirror 4 'ball'");
    EXPECT_EQ(model.left_out[0].why, "'partition' hides it from the camera, and walls hide it from "
                                     "each of the 3 mirrors that are seen");
    EXPECT_EQ(model.left_out[0].error, 0);
}

TEST(RequireSight, SightFollowsAMovingWall) {
    scene::Scene scene = make_hall_with_partition();
    WorkModelBuilder requirements(scene);
    EXPECT_FALSE(requirements.model({scene, scene.cameras[0]}).mirrors[3].is_captured);
    scene.objects[6].world_from_object[3] = {0, 6, 0, 1};
    const WorkModel& model = requirements.model({scene, scene.cameras[0]});
    EXPECT_TRUE(model.mirrors[3].is_captured);
    EXPECT_THAT(model.mirrors[0].sees, ElementsAre(1, 2, 3));
    EXPECT_THAT(model.left_out, IsEmpty());
}

TEST(RequireSight, SightFollowsAMovingMirror) {
    scene::Scene scene = make_hall_with_partition();
    WorkModelBuilder requirements(scene);
    const auto sees = [&] { return requirements.model({scene, scene.cameras[0]}).mirrors[0].sees; };
    EXPECT_THAT(sees(), ElementsAre(1, 2));
    scene.objects.back().world_from_object[3] = {1.5, 0, 1, 1}; // out from behind the partition
    EXPECT_THAT(sees(), ElementsAre(1, 2, 3));
    scene.objects.back().world_from_object[3] = {0, 0, 5, 1};
    EXPECT_THAT(sees(), ElementsAre(1, 2));
}

TEST(RequireSight, MaskedAndCameraHiddenWallsHideNoMirror) {
    for (const bool is_masked : {true, false}) {
        scene::Scene scene = make_hall_with_partition();
        if (is_masked) {
            scene.objects[6].material = add_material(scene, {.alpha = 1, .alpha_cutoff = .5f});
        } else {
            scene.objects[6].seen_by_camera = false;
        }
        const WorkModel model = make_required_model({scene, scene.cameras[0]});
        EXPECT_TRUE(model.mirrors[3].is_captured);
        // An object that is hidden from cameras still shows in captures, so it blocks their view.
        EXPECT_EQ(model.mirrors[0].sees.size(), is_masked ? 3u : 2u);
    }
}

TEST(RequireSight, NoMirrorIsCapturedIfNoneIsSeen) {
    scene::Scene scene = make_hall_with_partition();
    scene.cameras[0].target = {0, -1, -2.01}; // the camera looks at the floor
    scene.cameras[0].vertical_fov_degrees = 10;
    const WorkModel model = make_required_model({scene, scene.cameras[0]});
    for (const MirrorRequirements& needs : model.mirrors) EXPECT_FALSE(needs.is_captured);
    ASSERT_EQ(model.left_out.size(), 1u);
    EXPECT_EQ(model.left_out[0].what, "the captures of mirrors 1-4");
    EXPECT_EQ(model.left_out[0].why, "they are not in the camera's picture, and no mirror is seen "
                                     "in which they could show");
}

TEST(RequireFrustum, FrustumTestsATriangleAndNotItsBounds) {
    const scene::Camera camera{.target = {0, 0, 1}, .vertical_fov_degrees = 90};
    const PictureFrustum square(camera, {100, 100});
    // A triangle 10 in front of the eye, near a corner of the picture. Its bounds reach into the
    // picture, the triangle does not.
    const std::array<dvec3, 3> aslant{{{-14, 9, 10}, {-9, 15, 10}, {-14, 16, 10}}};
    Bounds<double> box;
    for (const dvec3& corner : aslant) box.add(corner);
    EXPECT_TRUE(square.may_contain_box(box));
    EXPECT_FALSE(square.may_contain_triangle(aslant, 0));
    EXPECT_TRUE(square.may_contain_triangle(aslant, 2));
    // A triangle around the whole picture, so that none of its corners is inside.
    EXPECT_TRUE(square.may_contain_triangle({{{-99, -50, 10}, {99, -50, 10}, {0, 99, 10}}}, 0));
    EXPECT_FALSE(square.may_contain_triangle({{{-99, -50, -10}, {99, -50, -10}, {0, 99, -10}}}, 0));
    EXPECT_TRUE(square.may_contain_ball({0, 11, 10}, .8)); // the centre is .707 outside the plane
    EXPECT_FALSE(square.may_contain_ball({0, 11, 10}, .7));
}

/// The bounds of mirror 1 of the gallery reach into the first camera's picture, but the mirror's
/// surface does not.
TEST(RequireSight, MirrorIsSeenByItsSurfaceNotByItsBounds) {
    const scene::Scene gallery = scene::load("gallery", {});
    const scene::Scene now = scene::scene_at(gallery, 0);
    const WorkModel model = make_required_model({now, scene::camera_at(gallery.cameras[0], 0)});
    const std::string text = describe_model(model, now);
    EXPECT_THAT(text, testing::Not(HasSubstr("mirror 1 'large ball': in the camera's view")));
    const PictureFrustum picture(gallery.cameras[0], {512, 512});
    const scene::Object& ball = now.objects[scene::mirrors(now)[0]];
    EXPECT_TRUE(picture.may_contain_box(scene::bounds(now, ball)));
}

/// Number of mirrors called unseen, of mirrors that a capture was said not to show, and of traced
/// rays.
struct SightTestCounts {
    int unseen = 0, not_shown = 0, rays = 0;
};

/// Traces rays from the camera to random points of all mirrors. The model must call every mirror
/// that such a ray meets seen, captured and directly seen.
void check_mirrors_seen_from_camera(const test::ObjectRayCaster& tree, const scene::Scene& scene,
                                    const WorkModel& model, test::RandomNumbers& numbers,
                                    SightTestCounts& found) {
    const PictureFrustum picture(scene.cameras[0], {64, 64});
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    for (std::size_t i = 0; i < mirrors.size(); ++i)
        for (int k = 0; k < 60; ++k) {
            const dvec3 to = tree.random_point_on_object(mirrors[i], numbers);
            if (!picture.may_contain_box({to, to})) continue;
            const dvec3 from = picture.is_orthographic()
                                   ? to - dot(to - picture.eye(), picture.forward()) *
                                              picture.forward()
                                   : picture.eye();
            const auto met = tree.find_first_object(from, to - from, scene.objects.size(),
                                                    bvh::kHiddenFromCameraFlag |
                                                        bvh::kOneSidedFlag);
            const auto mirror = met ? std::ranges::find(mirrors, met->object) : mirrors.end();
            ++found.rays;
            if (mirror == mirrors.end()) continue;
            const MirrorRequirements& needs =
                model.mirrors[static_cast<std::size_t>(mirror - mirrors.begin())];
            EXPECT_TRUE(needs.is_seen && needs.is_captured && !needs.seen_in);
        }
}

/// Traces rays from the centre and the surface of mirror `viewer` to all other mirrors. The model
/// must capture every mirror that such a ray meets. If the ray starts at the centre, the model must
/// also say that the capture of `viewer` shows the mirror.
void check_mirrors_seen_from_mirror(const test::ObjectRayCaster& tree, const scene::Scene& scene,
                                    const WorkModel& model, std::size_t viewer,
                                    test::RandomNumbers& numbers, SightTestCounts& found) {
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    const dvec3 centre = scene::bounds(scene, scene.objects[mirrors[viewer]]).centre();
    for (std::size_t i = 0; i < mirrors.size(); ++i)
        for (int k = 0; k < 60 && i != viewer; ++k) {
            const bool is_captured = k % 2 == 0;
            const dvec3 from = is_captured ? centre
                                           : tree.random_point_on_object(mirrors[viewer], numbers);
            const dvec3 to = tree.random_point_on_object(mirrors[i], numbers);
            const auto met = tree.find_first_object(from, to - from, mirrors[viewer],
                                                    bvh::kOneSidedFlag);
            const auto mirror = met ? std::ranges::find(mirrors, met->object) : mirrors.end();
            ++found.rays;
            if (mirror == mirrors.end()) continue;
            const auto number = static_cast<std::uint32_t>(mirror - mirrors.begin());
            EXPECT_TRUE(model.mirrors[number].is_captured);
            if (is_captured) {
                EXPECT_THAT(model.mirrors[viewer].sees, testing::Contains(number));
            }
        }
}

TEST(RequireSight, RandomRaysMeetNoMirrorThatIsCalledUnseen) {
    SightTestCounts found;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        const scene::Scene scene = test::make_random_hall(seed, 6);
        const WorkModel model = make_required_model({scene, scene.cameras[0], {64, 64}});
        const test::ObjectRayCaster tree(scene);
        test::RandomNumbers numbers(seed);
        SCOPED_TRACE(seed);
        check_mirrors_seen_from_camera(tree, scene, model, numbers, found);
        for (std::size_t i = 0; i < model.mirrors.size(); ++i) {
            if (!model.mirrors[i].is_captured) {
                ++found.unseen;
                continue;
            }
            found.not_shown += static_cast<int>(model.mirrors.size() - 1 -
                                                model.mirrors[i].sees.size());
            check_mirrors_seen_from_mirror(tree, scene, model, i, numbers, found);
        }
        if (testing::Test::HasFailure()) break;
    }
    EXPECT_GT(found.unseen, 150); // at least 150 of 900 mirrors are unseen
    EXPECT_GT(found.not_shown, 200);
    EXPECT_GT(found.rays, 100'000);
    RecordProperty("unseen", found.unseen), RecordProperty("not_shown", found.not_shown);
    RecordProperty("rays", found.rays);
}

} // namespace
