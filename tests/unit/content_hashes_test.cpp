// Tests of the content hashes of captured faces and shadow maps. Hashes may be equal only if the
// pictures cannot have changed.
#include "core/shader_math.hpp"
#include "require/model.hpp"
#include "require/pieces.hpp"
#include "require/shadows.hpp"
#include "require/world.hpp"
#include "scene/built_in.hpp"
#include "scene/light.hpp"
#include "scene/shapes.hpp"
#include "support/drawn_hall.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace {

using namespace catoptric;
using namespace catoptric::require;

constexpr std::uint32_t kShadowMapEdgeTexels = 1024;

/// Computes the work that a scene's picture requires (the model) at given times in seconds.
class RequirementsAtInstants {
public:
    explicit RequirementsAtInstants(const scene::Scene& rest) : rest_(rest), requirements_(rest) {}
    WorkModel required_work_model_at_time(double seconds) {
        const scene::Scene now = scene::scene_at(rest_, seconds);
        return requirements_.model({now, rest_.cameras[0], {64, 64}, kShadowMapEdgeTexels});
    }

private:
    const scene::Scene& rest_;
    WorkModelBuilder requirements_;
};

int count_unchanged_faces(const WorkModel& before, const WorkModel& after) {
    int count = 0;
    for (std::size_t i = 0; i < after.mirrors.size(); ++i)
        for (std::size_t face = 0; face < 6; ++face)
            count += before.mirrors[i].content_hashes[face] == after.mirrors[i].content_hashes[face]
                         ? 1
                         : 0;
    return count;
}

TEST(RequireStamps, ContentHashesStayWhileNothingMoves) {
    const scene::Scene scene = scene::make_cornell();
    RequirementsAtInstants instants(scene);
    const WorkModel first = instants.required_work_model_at_time(0),
                    second = instants.required_work_model_at_time(0),
                    elsewhere = instants.required_work_model_at_time(1),
                    again = instants.required_work_model_at_time(1);
    EXPECT_EQ(count_unchanged_faces(first, second), 24);
    EXPECT_EQ(count_unchanged_faces(elsewhere, again), 24);
    EXPECT_EQ(first.lights[0].content_hash, second.lights[0].content_hash);
    EXPECT_EQ(first.lights[0].content_hash, elsewhere.lights[0].content_hash);
    ASSERT_EQ(first.casters.size(), 1u);
    EXPECT_EQ(first.casters[0].object, elsewhere.casters[0].object);
    EXPECT_EQ(elsewhere.casters[0].content_hash, again.casters[0].content_hash);
    EXPECT_NE(first.casters[0].content_hash, elsewhere.casters[0].content_hash);
}

TEST(RequireStamps, MovingBallChangesHashesOnlyWhereTheBallOrItsShadowShows) {
    const scene::Scene scene = scene::make_cornell();
    RequirementsAtInstants instants(scene);
    WorkModel before = instants.required_work_model_at_time(0);
    int stays = 0;
    for (int frame = 1; frame <= 20; ++frame) {
        const WorkModel after = instants.required_work_model_at_time(.1 * frame);
        stays += count_unchanged_faces(before, after);
        for (std::size_t face = 0; face < 6; ++face)
            // The moving ball's own capture changes.
            EXPECT_NE(before.mirrors[3].content_hashes[face],
                      after.mirrors[3].content_hashes[face]);
        before = after;
    }
    EXPECT_GE(stays, 20 * 24 / 3);
    RecordProperty("kept", stays);
}

TEST(RequireStamps, EditsOfLampsMaterialsAndObjectsChangeContentHashes) {
    const scene::Scene rest = scene::make_cornell();
    scene::Scene scene = rest;
    WorkModelBuilder requirements(scene);
    const auto model = [&] {
        return WorkModel(requirements.model({scene, scene.cameras[0], {64, 64}}));
    };
    const WorkModel first = model();
    scene.materials[3].emission = {1, 1, 1};
    const WorkModel dimmed = model();
    EXPECT_EQ(count_unchanged_faces(first, dimmed), 0);
    EXPECT_NE(first.lights[0].content_hash, dimmed.lights[0].content_hash);
    scene.materials[0].albedo = {.1f, .1f, .1f};
    const WorkModel painted = model();
    EXPECT_EQ(count_unchanged_faces(dimmed, painted), 0);
    EXPECT_EQ(count_unchanged_faces(painted, model()), 24);
    scene.materials[3].emission = vec3(0);
    EXPECT_TRUE(model().lights.empty());
    scene.materials[3].emission = {1, 1, 1};
    EXPECT_EQ(count_unchanged_faces(painted, model()), 24);
    // Edits the floor, which has no motion.
    scene.objects[0].world_from_object[3].y = -1;
    const WorkModel lowered = model();
    EXPECT_EQ(count_unchanged_faces(painted, lowered), 0);
    EXPECT_EQ(count_unchanged_faces(lowered, model()), 24);
    scene.punctual.push_back({.name = "bare", .intensity = vec3(1)});
    EXPECT_EQ(count_unchanged_faces(lowered, model()), 0);
}

/// A block that comes nearer changes only the hash of the face that shows the block. Content hashes
/// do not cover near planes, which the owner of the views compares.
TEST(RequireStamps, ApproachingBlockChangesOnlyTheFaceThatShowsTheBlock) {
    scene::Scene scene{.name = "bare"};
    const std::size_t white = add_material(scene, {.albedo = vec3(.7f)});
    for (int face = 0; face < 6; ++face)
        test::add_mesh(scene, test::make_box_wall(face, dvec3(-10), dvec3(10)), white);
    test::add_ball(scene, "ball", add_material(scene, {.mirror = true}), {0, 0, 0}, .5, 2);
    test::add_mesh(scene, scene::box("block", dvec3(-.2), dvec3(.2)), white);
    scene.objects.back().world_from_object[3] = {3, 0, 0, 1};
    scene.objects.back().motion = scene::HarmonicMotion{.amplitude = {.5, 0, 0}, .period = 1};
    scene.cameras.push_back({.eye = {0, 0, -5}, .target = {0, 0, 0}});
    RequirementsAtInstants instants(scene);
    const WorkModel before = instants.required_work_model_at_time(.1),
                    after = instants.required_work_model_at_time(.2);
    // Five faces keep their hash: all but face +X.
    EXPECT_EQ(count_unchanged_faces(before, after), 5);
    EXPECT_NE(before.mirrors[0].content_hashes[0], after.mirrors[0].content_hashes[0]);
}

TEST(RequireShadows, ShadowBoundsFollowTheLight) {
    const Bounds<double> room{{-10, 0, -10}, {10, 10, 10}};
    scene::PointLight light{.position = {0, 10, 0}};
    // The shadow of the object's top reaches the floor at 2.5 times the top's distance from the
    // lamp.
    const ShadowedVolume below = shadowed_volume(light, {{-1, 5, -1}, {1, 6, 1}}, room);
    EXPECT_EQ(below.from.hi, dvec3(1, 6, 1));
    EXPECT_EQ(below.to.hi, dvec3(2.5, 0, 2.5));
    EXPECT_EQ(below.to.lo, dvec3(-2.5, -2.5, -2.5));
    // An object around the lamp may shade any place of the room.
    EXPECT_EQ(shadowed_volume(light, {{-1, 9, -1}, {1, 11, 1}}, room).to.hi, room.hi);
    light = {.axis = {0, -1, 0}, .directional = true};
    const ShadowedVolume along = shadowed_volume(light, {{-1, 5, -1}, {1, 6, 1}}, room);
    EXPECT_EQ(along.to.lo, dvec3(-1, -1, -1));
    EXPECT_EQ(along.to.hi, dvec3(1, 0, 1));
}

constexpr int kRaysAlongFaceEdge = 16; ///< rays along the edge of a face

/// Returns the direction of ray `k` of the kRaysAlongFaceEdge * kRaysAlongFaceEdge rays through a
/// cube map's face.
dvec3 face_ray_direction(int face, int k) {
    const double u = (2. * (k % kRaysAlongFaceEdge) + 1) / kRaysAlongFaceEdge - 1,
                 v = (2. * (k / kRaysAlongFaceEdge) + 1) / kRaysAlongFaceEdge - 1;
    return f64::cube_direction(face, dvec3(u, v, 1));
}

/// Returns three results for each ray through a face of a capture: the object that the ray hits,
/// the distance, and the lights that are shaded at the hit.
std::vector<std::vector<double>> results_of_rays_through_face(const test::ObjectRayCaster& tree,
                                                              const scene::Scene& now,
                                                              std::size_t mirror, int face) {
    const dvec3 centre = scene::bounds(now, now.objects[mirror]).centre();
    const std::vector<scene::PointLight> lights = scene::list_lights(now);
    std::vector<std::vector<double>> seen;
    for (int k = 0; k < kRaysAlongFaceEdge * kRaysAlongFaceEdge; ++k) {
        const dvec3 direction = face_ray_direction(face, k);
        const auto met = tree.find_first_object(centre, direction, mirror, bvh::kOneSidedFlag);
        std::vector<double>& ray = seen.emplace_back();
        ray.push_back(met ? static_cast<double>(met->object) : -1);
        ray.push_back(met ? met->t : 0);
        for (std::size_t i = 0; met && i < lights.size(); ++i) {
            const dvec3 place = centre + met->t * direction;
            ray.push_back(tree.is_in_shadow(place, lights[i].position) ? 1 : 0);
        }
    }
    return seen;
}

/// Counts rays whose results differ between two times, but that lie outside the part of the face
/// that `find_changed_part` reports.
int count_changed_rays_outside_part(const MirrorRequirements& before,
                                    const MirrorRequirements& after, int face,
                                    const std::vector<std::vector<double>>& then,
                                    const std::vector<std::vector<double>>& now) {
    const auto f = static_cast<std::size_t>(face);
    const FacePart part = find_changed_part(before.pieces->faces[f], after.pieces->faces[f]);
    int count = 0;
    for (int k = 0; k < kRaysAlongFaceEdge * kRaysAlongFaceEdge; ++k) {
        const dvec2 at(f64::cube_coordinates(face, face_ray_direction(face, k)));
        const bool holds = all(lessThanEqual(part.low, at)) && all(lessThanEqual(at, part.high));
        count += then[static_cast<std::size_t>(k)] != now[static_cast<std::size_t>(k)] && !holds;
    }
    return count;
}

TEST(RequireStamps, FacesWithEqualContentHashesShowRaysNoChange) {
    int stays = 0, changes = 0, faces = 0, parts = 0;
    for (std::uint64_t seed = 0; seed < 150; ++seed) {
        scene::Scene scene = test::make_random_hall(seed, 3);
        test::RandomNumbers numbers(seed + 1000);
        // Chooses one of the six objects before the lamp.
        const std::size_t mover = scene.objects.size() - 2 - numbers.random_integer_below(6);
        scene.objects[mover].motion = scene::HarmonicMotion{
            .amplitude = dvec3(numbers.random_unit_direction()), .period = 2};
        RequirementsAtInstants instants(scene);
        const WorkModel before = instants.required_work_model_at_time(.2),
                        after = instants.required_work_model_at_time(.5);
        const scene::Scene then = scene::scene_at(scene, .2), now = scene::scene_at(scene, .5);
        const test::ObjectRayCaster old_tree(then), new_tree(now);
        const std::vector<std::size_t> mirrors = scene::mirrors(scene);
        for (std::size_t i = 0; i < mirrors.size(); ++i) {
            if (!before.mirrors[i].is_captured || !after.mirrors[i].is_captured) continue;
            for (int face = 0; face < 6; ++face) {
                const auto f = static_cast<std::size_t>(face);
                const bool is_persistent = before.mirrors[i].content_hashes[f] ==
                                           after.mirrors[i].content_hashes[f];
                const auto saw = results_of_rays_through_face(old_tree, then, mirrors[i], face),
                           sees = results_of_rays_through_face(new_tree, now, mirrors[i], face);
                const bool is_same = saw == sees;
                EXPECT_TRUE(is_same || !is_persistent)
                    << "seed " << seed << ", mirror " << i + 1 << ", face " << face;
                ++faces, stays += is_persistent ? 1 : 0, changes += is_same ? 0 : 1;
                if (is_same ||
                    before.mirrors[i].still_hashes[f] != after.mirrors[i].still_hashes[f] ||
                    !before.mirrors[i].pieces || !after.mirrors[i].pieces)
                    continue;
                ++parts;
                EXPECT_EQ(count_changed_rays_outside_part(before.mirrors[i], after.mirrors[i], face,
                                                          saw, sees),
                          0)
                    << "seed " << seed << ", mirror " << i + 1 << ", face " << face;
            }
        }
    }
    EXPECT_GT(faces, 600);
    EXPECT_GT(changes, 120);
    EXPECT_GT(parts, 60);
    EXPECT_GT(stays, 300);
    RecordProperty("faces", faces), RecordProperty("kept", stays);
    RecordProperty("changed", changes);
}

} // namespace
