// Tests of finding flat mirrors and flat faces, and of the mirrored views that show their
// reflections.
#include "render/mirrored.hpp"
#include "render/views.hpp"
#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/material_facts.hpp"
#include "scene/shapes.hpp"

#include <gtest/gtest.h>

#include <ranges>

#include <glm/gtc/matrix_transform.hpp>

namespace {

using namespace catoptric;

scene::Mesh make_flat_board() {
    return scene::quad("board", {-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0});
}

const dmat4 kTurnedObjectPlacement = glm::rotate(glm::translate(dmat4(1), dvec3(30, -7, 2)), .7,
                                                 glm::normalize(dvec3(1, 2, -1))) *
                                     glm::scale(dmat4(1), dvec3(3, .5, 2));

TEST(FlatMirror, RoughMirrorHasFlatFacesAndBumpyMirrorHasNone) {
    scene::Scene scene;
    scene.mirror_max_roughness = .6f;
    const std::size_t metal = scene::add_material(
        scene, {.name = "metal", .albedo = vec3(.9f), .metallic = 1, .roughness = .3f});
    scene::add_mesh(scene, make_flat_board(), metal);
    scene.objects.front().mirror = true;
    const scene::FlatFaces rough = scene::find_flat_faces(scene, scene.objects.front());
    EXPECT_EQ(rough.misfit, "");
    EXPECT_TRUE(rough.is_rough);
    EXPECT_TRUE(rough.is_plane());
    scene.materials.front().roughness = .03f;
    const scene::FlatFaces sharp = scene::find_flat_faces(scene, scene.objects.front());
    EXPECT_EQ(sharp.misfit, "");
    EXPECT_FALSE(sharp.is_rough);
    EXPECT_TRUE(sharp.is_plane());
    scene.materials.front().normal_texture = scene::Texture{
        .image = std::make_shared<scene::Image>(
            scene::Image{.name = "normals", .size = {1, 1}, .texels = {0xffff8080u}})};
    const scene::FlatFaces bumpy = scene::find_flat_faces(scene, scene.objects.front());
    EXPECT_EQ(bumpy.misfit, "bumpy");
    EXPECT_TRUE(bumpy.faces.empty());
    EXPECT_EQ(bumpy.bent, (std::vector<scene::TriangleRun>{{0, 2}}));
}

TEST(FlatMirror, FlatMirrorIsFoundUnderAnyTransform) {
    const auto flat = scene::find_mesh_plane(make_flat_board(), kTurnedObjectPlacement);
    ASSERT_TRUE(flat);
    EXPECT_LE(flat->off, 1e-12);
    const dvec3 normal = glm::normalize(glm::dmat3(kTurnedObjectPlacement)[2]);
    EXPECT_NEAR(std::abs(dot(flat->normal, normal)), 1, 1e-12);
    ASSERT_EQ(flat->corners.size(), 4u);
    for (const dvec3& p : make_flat_board().positions) {
        const dvec3 at(kTurnedObjectPlacement * dvec4(p, 1));
        EXPECT_LE(std::ranges::min(flat->corners | std::views::transform([&](const dvec3& c) {
                                       return distance(c, at);
                                   })),
                  1e-12);
        EXPECT_NEAR(dot(at - flat->point, flat->normal), 0, 1e-12);
    }
    EXPECT_FALSE(scene::find_mesh_plane(scene::ball("ball", 2), dmat4(1)));
    EXPECT_FALSE(scene::find_mesh_plane({}, dmat4(1)));
    EXPECT_FALSE(scene::find_mesh_plane(make_flat_board(), dmat4(0))) << "without an area";
}

TEST(FlatMirror, DeviationFromFlatCoversNormalsAndVertices) {
    scene::Mesh turned = make_flat_board();
    turned.normals[2] = glm::normalize(vec3(.003f, 0, 1));
    EXPECT_NEAR(scene::find_mesh_plane(turned, dmat4(1))->off, .003, 1e-6);
    turned.normals[2] = glm::normalize(vec3(.03f, 0, 1));
    EXPECT_FALSE(scene::find_mesh_plane(turned, dmat4(1)));
    scene::Mesh bent = make_flat_board();
    // The vertex is sqrt(2) from the diagonal, so its triangle tilts by .004 / sqrt(2) against the
    // other triangle.
    bent.positions[3].z = .004;
    EXPECT_NEAR(scene::find_mesh_plane(bent, dmat4(1))->off, .004 / std::sqrt(2.0), 1e-7);
    scene::Mesh back = make_flat_board();
    for (vec3& normal : back.normals) normal = -normal;
    EXPECT_EQ(scene::find_mesh_plane(back, dmat4(1))->off, 0) << "a mirror has two sides";
}

/// A rotated board, modelled as a thin closed box, has two large faces and four narrow faces at the
/// rim.
TEST(FlatFaces, ThinBoxHasSixFlatFaces) {
    const scene::Mesh box = scene::box("board", {-1, -1, -.02}, {1, 1, .02});
    ASSERT_FALSE(scene::find_mesh_plane(box, kTurnedObjectPlacement));
    const scene::FlatFaces flats = scene::find_flat_faces(box, kTurnedObjectPlacement);
    ASSERT_EQ(flats.faces.size(), 6u);
    EXPECT_TRUE(flats.bent.empty());
    EXPECT_NEAR(flats.flat_share(1e-9), 1, 1e-9);
    std::uint32_t triangles = 0;
    for (const scene::FlatFace& face : flats.faces) {
        EXPECT_TRUE(face.is_one_sided);
        EXPECT_EQ(face.corners.size(), 4u);
        EXPECT_LT(dot(dvec3(kTurnedObjectPlacement[3]) - face.point, face.normal), 0)
            << "it looks outwards";
        for (const auto& [first, end] : face.triangles) triangles += end - first;
    }
    EXPECT_EQ(triangles, box.triangles.size());
    EXPECT_GT(flats.faces[0].share + flats.faces[1].share, .9) << "the largest first";
    scene::Mesh open = box;
    open.triangles.pop_back();
    EXPECT_FALSE(scene::find_flat_faces(open, kTurnedObjectPlacement).faces.front().is_one_sided)
        << "somebody may look in";
    scene::Mesh inside_out = box;
    for (uvec3& t : inside_out.triangles) std::swap(t.y, t.z);
    for (const scene::FlatFace& face :
         scene::find_flat_faces(inside_out, kTurnedObjectPlacement).faces)
        EXPECT_LT(dot(dvec3(kTurnedObjectPlacement[3]) - face.point, face.normal), 0);
}

TEST(FlatFaces, BentSurfacesBelongToNoFlatFace) {
    scene::Mesh rounded = scene::box("board", {-1, -1, -.1}, {1, 1, .1});
    for (const uvec3& t : rounded.triangles)
        // Normals of the rim are bent, as if the rim were round.
        for (int k = 0; k < 3; ++k)
            if (std::abs(rounded.normals[t[k]].z) < .5f)
                rounded.normals[t[k]] = glm::normalize(rounded.normals[t[k]] + vec3(0, 0, .2f));
    const scene::FlatFaces flats = scene::find_flat_faces(rounded, dmat4(1));
    EXPECT_EQ(flats.faces.size(), 2u);
    EXPECT_NEAR(flats.flat_share(1e-6), 8 / 9.6, 1e-6);
    ASSERT_FALSE(flats.bent.empty());
    const scene::FlatFaces ball = scene::find_flat_faces(scene::ball("ball", 3), dmat4(1));
    EXPECT_TRUE(ball.faces.empty());
    EXPECT_EQ(ball.bent.size(), 1u);
    const scene::FlatFaces quad = scene::find_flat_faces(make_flat_board(), kTurnedObjectPlacement);
    EXPECT_TRUE(quad.is_plane());
    EXPECT_FALSE(quad.faces.front().is_one_sided) << "a mirror has two sides";
}

// The expected tolerance is a sixteenth of a pixel's angle, atan(2 tan(30 deg) / 600).
TEST(FlatMirror, FlatToleranceIsASixteenthOfAPixel) {
    const scene::Camera camera{.vertical_fov_degrees = 60};
    EXPECT_NEAR(scene::flat_tolerance(camera, {10, 600}), 2 * std::tan(M_PI / 6) / 600 / 16, 1e-9);
    EXPECT_NEAR(scene::flat_tolerance({.orthographic_height = 3}, {10, 600}), 2.0 / 600 / 16, 1e-9);
}

render::MirroredViewEye make_eye_at(const dvec3& place, const dvec3& target) {
    render::MirroredViewEye eye;
    eye.view = render::make_camera_view(
        {.eye = place, .target = target, .vertical_fov_degrees = 90}, {}, {64, 64}, .1f);
    eye.place = place;
    return eye;
}

std::optional<render::MirrorPlane> find_mirror_plane(const scene::Mesh& mesh, int bounces = 2) {
    return render::MirrorPlane{*scene::find_mesh_plane(mesh, dmat4(1)), bounces};
}

TEST(MirroredViews, MirroredEyeIsBehindTheMirrorAndSeesTheReflection) {
    int most = 2;
    const auto views = render::find_mirrored_views(make_eye_at({.5, .25, 3}, {.5, .25, 0}),
                                                   {find_mirror_plane(make_flat_board())}, {64, 64},
                                                   most);
    ASSERT_EQ(views.size(), 1u);
    EXPECT_NEAR(distance(views[0].eye, dvec3(.5, .25, -3)), 0, 1e-12);
    EXPECT_EQ(views[0].view.forward, vec3(0, 0, 1));
    EXPECT_EQ(views[0].view.clip, vec4(0, 0, 1, -3)) << "kept: what is in front of the mirror";
    const auto behind = render::find_mirrored_views(make_eye_at({.5, .25, -3}, {.5, .25, 0}),
                                                    {find_mirror_plane(make_flat_board())},
                                                    {64, 64}, most);
    EXPECT_EQ(behind.at(0).view.clip, vec4(0, 0, -1, -3)) << "on whichever side the eye is";
    // The mirror covers x from -1.5 / 3 to .5 / 3 of half the picture, and y from -1.25 / 3 to .75
    // / 3, upside down. The area has a margin of one pixel.
    EXPECT_EQ(views[0].area, (graph::PixelRectangle{15, 23, 24, 24}));
    // A point p lies in the mirrored view where the mirror image of p lies in the camera's view.
    const vec3 p(.3f, -.6f, 2), image(.3f, -.6f, -2);
    const render::MirroredViewEye eye = make_eye_at({.5, .25, 3}, {.5, .25, 0});
    const vec3 seen = image - eye.view.eye, mirrored = p - views[0].view.eye;
    EXPECT_NEAR(dot(eye.view.right, seen), dot(views[0].view.right, mirrored), 1e-5f);
    EXPECT_NEAR(dot(eye.view.down, seen), dot(views[0].view.down, mirrored), 1e-5f);
    EXPECT_NEAR(dot(eye.view.forward, seen), dot(views[0].view.forward, mirrored), 1e-5f);
    EXPECT_EQ(most, 2);
}

TEST(MirroredViews, OnlyMirrorsInThePictureGetMirroredViews) {
    const auto count = [](const dvec3& place, const dvec3& target) {
        int most = 2;
        return render::find_mirrored_views(make_eye_at(place, target),
                                           {find_mirror_plane(make_flat_board())}, {64, 64}, most)
            .size();
    };
    EXPECT_EQ(count({0, 0, 3}, {0, 0, 0}), 1u);
    EXPECT_EQ(count({0, 0, -3}, {0, 0, 0}), 1u) << "from behind";
    EXPECT_EQ(count({0, 0, 3}, {0, 0, 6}), 0u) << "behind the eye";
    EXPECT_EQ(count({9, 0, 3}, {9, 0, 0}), 0u) << "beside the picture";
    EXPECT_EQ(count({0, 3, 0}, {.5, 0, 0}), 0u) << "edge on";
}

TEST(MirroredViews, OnlyFacesTowardsTheEyeGetMirroredViews) {
    std::vector<std::optional<render::MirrorPlane>> faces;
    for (scene::FlatFace& face :
         scene::find_flat_faces(scene::box("b", {-1, -1, -.1}, {1, 1, .1}), dmat4(1)).faces)
        faces.emplace_back(render::MirrorPlane{std::move(face), 2});
    ASSERT_EQ(faces.size(), 6u);
    const auto count = [&](const dvec3& place) {
        int most = 2;
        return render::find_mirrored_views(make_eye_at(place, {0, 0, 0}), faces, {64, 64}, most)
            .size();
    };
    EXPECT_EQ(count({.2, .3, 3}), 1u) << "its front";
    EXPECT_EQ(count({2, .3, 3}), 2u) << "and one side of the rim";
    EXPECT_EQ(count({2, 2, 3}), 3u);
}

TEST(MirroredViews, NestingDepthIsLimitedByBouncesAndNumberOfViews) {
    std::vector<std::optional<render::MirrorPlane>> corner; // the six walls of a box around the eye
    for (int face = 0; face < 6; ++face)
        corner.push_back(find_mirror_plane(scene::make_box_wall(face, dvec3(-1), dvec3(1)), 16));
    const render::MirroredViewEye eye = make_eye_at({.1, .2, -.3}, {1, 1, 1});
    for (int asked = 1; asked <= 3; ++asked) {
        int most = asked;
        const auto views = render::find_mirrored_views(eye, corner, {64, 64}, most);
        std::vector<int> depth(views.size(), 1);
        for (std::size_t i = 0; i < views.size(); ++i) {
            if (!views[i].within) continue;
            ASSERT_LT(*views[i].within, i) << "after the view that shows it";
            EXPECT_NE(views[*views[i].within].plane_index, views[i].plane_index);
            depth[i] = depth[*views[i].within] + 1;
            const graph::PixelRectangle &inner = views[i].area,
                                        &outer = views[*views[i].within].area;
            EXPECT_TRUE(inner.x >= outer.x && inner.y >= outer.y &&
                        inner.x + inner.width <= outer.x + outer.width &&
                        inner.y + inner.height <= outer.y + outer.height);
        }
        EXPECT_EQ(std::ranges::max(depth), asked);
        EXPECT_EQ(most, asked);
    }
    int most = 16;
    const auto views = render::find_mirrored_views(eye, corner, {64, 64}, most);
    EXPECT_LE(views.size(), render::kMaxMirroredViews);
    EXPECT_LT(most, 16);
    EXPECT_GT(most, 2);
    corner[0]->bounces = 0;
    for (std::size_t i = 1; i < 6; ++i) corner[i]->bounces = 1;
    most = 16;
    for (const auto& view : render::find_mirrored_views(eye, corner, {64, 64}, most)) {
        EXPECT_FALSE(view.within);
        EXPECT_NE(view.plane_index, 0u) << "black";
    }
}

TEST(MirroredViews, MirroredViewCullsBoxesBehindOrBesideTheMirror) {
    int most = 1;
    const render::MirroredView view = render::find_mirrored_views(
                                          make_eye_at({.5, .25, 3}, {.5, .25, 0}),
                                          {find_mirror_plane(make_flat_board())}, {64, 64}, most)
                                          .front();
    const auto meets = [&](const vec3& low, const vec3& high) {
        return may_show(view, {64, 64}, {low, high});
    };
    EXPECT_TRUE(meets({0, 0, 1}, {.1f, .1f, 1.1f}));
    EXPECT_FALSE(meets({0, 0, -1}, {.1f, .1f, -.1f})) << "behind it";
    EXPECT_TRUE(meets({0, 0, -1}, {.1f, .1f, .1f})) << "on both sides";
    EXPECT_FALSE(meets({3, 0, 1}, {3.1f, .1f, 1.1f}))
        << "the camera's field of view has it, the mirror has not";
}

} // namespace
