#include "import/load.hpp"
#include "places.hpp"

#include "scene/build.hpp"
#include "scene/built_in.hpp"
#include "scene/light.hpp"
#include "scene/number.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <random>

namespace {

using namespace test::loading;

const fs::path kSamples = test::source_folder() / "samples" / "scenes";

void expect_near_loaded_positions(const dvec3& found, const dvec3& wanted, double tolerance) {
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], tolerance) << "component " << i;
}

dvec3 world_position_of_vertex(const Scene& scene, const Object& object, std::size_t vertex) {
    return dvec3(object.world_from_object * dvec4(scene.meshes[object.mesh].positions[vertex], 1));
}

/// Returns the largest distance between corresponding vertices in world space. Expects all other
/// properties of the objects to be equal.
double compare_objects_of_scenes(const Scene& found, const Scene& wanted) {
    double difference = 0;
    EXPECT_EQ(found.objects.size(), wanted.objects.size());
    for (std::size_t i = 0; i < std::min(found.objects.size(), wanted.objects.size()); ++i) {
        const Object &a = found.objects[i], &b = wanted.objects[i];
        const Mesh &mesh = found.meshes[a.mesh], &other = wanted.meshes[b.mesh];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.seen_by_camera, b.seen_by_camera);
        EXPECT_EQ(mesh.triangles, other.triangles) << a.name;
        EXPECT_EQ(mesh.positions.size(), other.positions.size()) << a.name;
        if (mesh.positions.size() != other.positions.size()) continue;
        for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
            difference = std::max(difference,
                                  glm::distance(world_position_of_vertex(found, a, v),
                                                world_position_of_vertex(wanted, b, v)));
            EXPECT_LT(glm::distance(mesh.normals[v], other.normals[v]),
                      3e-7f); // tolerance: two float ulps
        }
        EXPECT_EQ(a.sphere.has_value(), b.sphere.has_value()) << a.name;
        if (!a.sphere || !b.sphere) continue;
        expect_near_loaded_positions(a.sphere->centre, b.sphere->centre, 1e-12);
        EXPECT_NEAR(a.sphere->radius, b.sphere->radius, 1e-12);
    }
    return difference;
}

void expect_same_materials(const Scene& found, const Scene& wanted) {
    ASSERT_EQ(found.materials.size(), wanted.materials.size());
    for (std::size_t i = 0; i < found.materials.size(); ++i) {
        const Material &a = found.materials[i], &b = wanted.materials[i];
        EXPECT_EQ(a.name, b.name);
        EXPECT_EQ(a.albedo, b.albedo) << a.name;
        EXPECT_EQ(a.mirror, b.mirror) << a.name;
        EXPECT_EQ(a.reflectance, b.reflectance) << a.name;
        EXPECT_EQ(a.two_sided, b.two_sided) << a.name;
        for (int c = 0; c < 3; ++c) EXPECT_FLOAT_EQ(a.emission[c], b.emission[c]) << a.name;
    }
}

void expect_same_cameras(const Scene& found, const Scene& wanted) {
    ASSERT_EQ(found.cameras.size(), wanted.cameras.size());
    for (std::size_t i = 0; i < found.cameras.size(); ++i) {
        const Camera &a = found.cameras[i], &b = wanted.cameras[i];
        EXPECT_EQ(a.name, b.name);
        expect_near_loaded_positions(a.eye, b.eye, 1e-12);
        expect_near_loaded_positions(a.target, b.target, 1e-10);
        expect_near_loaded_positions(a.up, b.up, 1e-12);
        EXPECT_NEAR(a.vertical_fov_degrees, b.vertical_fov_degrees, 1e-12);
    }
}

// ---- built-in scenes and missing files

TEST_F(Load, BuiltInScenesLoadAndUnknownNamesAreRefused) {
    for (const BuiltInScene& scene : built_in_scenes())
        EXPECT_EQ(load(scene.name).name, scene.name);
    try {
        load("cornel-mirors");
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::usage);
        EXPECT_THAT(error.what(), AllOf(HasSubstr("cornel-mirors"), HasSubstr("did you mean"),
                                        HasSubstr("cornell-mirrors-closed")));
    }
}

TEST_F(Load, LoadingAMissingFileIsAMissingInputError) {
    for (const char* name : {"gone.glb", "gone.gltf", "gone.obj", "gone.OBJ"}) {
        try {
            load((folder / name).string());
            FAIL();
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::missing_input);
            EXPECT_THAT(error.what(), HasSubstr(name));
        }
    }
}

// ---- the scene files in samples/scenes

TEST_F(Load, ShippedFilesEqualTheOutputOfTheWriters) {
    save_glb(make_cornell(), folder / "cornell-mirrors.glb");
    save_obj(make_cornell(), folder / "cornell-mirrors.obj");
    for (const char* name : {"cornell-mirrors.glb", "cornell-mirrors.obj", "cornell-mirrors.mtl"})
        EXPECT_TRUE(read_file(folder / name) == read_file(kSamples / name)) << name;
}

TEST_F(Load, ShippedObjEqualsTheBuiltInScene) {
    const Scene scene = load((kSamples / "cornell-mirrors.obj").string());
    const Scene wanted = make_cornell();
    EXPECT_EQ(compare_objects_of_scenes(scene, wanted),
              0); // doubles written in shortest form read back exactly
    expect_same_materials(scene, wanted);
    expect_same_cameras(scene, wanted);
    EXPECT_EQ(scene.name, "cornell-mirrors");
    EXPECT_THAT(scene.warnings, testing::IsEmpty());
    EXPECT_EQ(mirrors(scene), mirrors(wanted));
    const auto* motion = std::get_if<HarmonicMotion>(&scene.objects.back().motion);
    ASSERT_NE(motion, nullptr);
    EXPECT_EQ(motion->amplitude, dvec3(0, 50, 0));
    EXPECT_EQ(motion->period, 4);
}

TEST_F(Load, ShippedGlbEqualsTheBuiltInSceneWithinFloatRounding) {
    const Scene scene = load((kSamples / "cornell-mirrors.glb").string());
    const Scene wanted = make_cornell();
    // Half an ulp of a float below 1024 is 2^-15 for each component. Coordinates of the Cornell box
    // reach 559.2.
    EXPECT_LT(compare_objects_of_scenes(scene, wanted), std::sqrt(3.0) * std::ldexp(1.0, -15));
    expect_same_materials(scene, wanted);
    expect_same_cameras(scene, wanted);
    EXPECT_EQ(scene.meshes.size(), 7u) << "the balls share one mesh";
    EXPECT_EQ(scene.objects[6].mesh, scene.objects[9].mesh);
    EXPECT_THAT(scene.warnings, testing::IsEmpty());
    for (const double t : {0.0, 0.03125, 1.0, 1.7, 2.0, 3.99, 4.0, 9.3}) {
        const dvec3 found = scene_at(scene, t).objects.back().sphere->centre;
        // The tolerance covers the Hermite error of 2.5e-7 times 50, and the rounding of floats
        // below 256.
        expect_near_loaded_positions(found, scene_at(wanted, t).objects.back().sphere->centre,
                                     4e-5);
    }
}

TEST_F(Load, TwoSidedLampsSurviveBothFormats) {
    Scene scene = make_cornell();
    for (const bool two_sided : {false, true}) {
        scene.materials[3].two_sided = two_sided;
        save_glb(scene, folder / "x.glb");
        expect_same_materials(load((folder / "x.glb").string()), scene);
        save_obj(scene, folder / "x.obj");
        expect_same_materials(load((folder / "x.obj").string()), scene);
        // A surface that emits no light always has two sides. The written file says so for other
        // programs.
        const std::string file = read_file(folder / "x.glb");
        std::size_t count = 0;
        for (std::size_t at = 0; (at = file.find("\"doubleSided\":true", at)) != file.npos; ++at)
            ++count;
        EXPECT_EQ(count, two_sided ? 5u : 4u);
    }
}

TEST_F(Load, AlphaOfBlendedSurfacesSurvivesBothFormats) {
    Scene scene = make_cornell();
    scene.materials[1].blended = true;
    scene.materials[1].alpha = .3f, scene.materials[1].alpha_cutoff = .5f;
    save_glb(scene, folder / "x.glb");
    save_obj(scene, folder / "x.obj");
    for (const char* file : {"x.glb", "x.obj"}) {
        const Scene found = load((folder / file).string());
        EXPECT_TRUE(found.materials[1].blended) << file;
        EXPECT_EQ(found.materials[1].alpha, .3f) << file;
        EXPECT_FALSE(found.materials[2].blended) << file;
    }
}

TEST_F(Load, ClearCoatSurvivesBothFormats) {
    Scene scene = make_cornell();
    scene.materials[1].clearcoat = .75f, scene.materials[1].clearcoat_roughness = .2f;
    save_glb(scene, folder / "x.glb");
    save_obj(scene, folder / "x.obj");
    for (const char* file : {"x.glb", "x.obj"}) {
        const Scene found = load((folder / file).string());
        EXPECT_EQ(found.materials[1].clearcoat, .75f) << file;
        EXPECT_EQ(found.materials[1].clearcoat_roughness, .2f) << file;
        EXPECT_EQ(found.materials[2].clearcoat, 0) << file;
    }
}

TEST_F(Load, HiddenFrontWallSurvivesBothFormats) {
    const Scene wanted = make_closed_cornell();
    save_glb(wanted, folder / "x.glb");
    save_obj(wanted, folder / "x.obj");
    EXPECT_LT(compare_objects_of_scenes(load((folder / "x.glb").string()), wanted), 1e-4);
    EXPECT_EQ(compare_objects_of_scenes(load((folder / "x.obj").string()), wanted), 0);
}

/// Builds a scene with features that the built-in scene lacks: rotated, scaled and mirrored
/// objects, keyframes, and names that clash.
Scene build_scene_with_rare_features() {
    Scene scene{.name = "awkward"};
    scene.materials = {{.name = "a b", .albedo = {0.1f, 0.2f, 0.3f}},
                       {.name = "a b", .mirror = true, .reflectance = {0.5f, 1, 0.25f}},
                       {.name = "", .emission = {0.5f, 0, 0.125f}}};
    scene.meshes = {ball("ball", 1), quad("q", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0})};
    // A rotation about y with cosine .6, and a move by 3 along x.
    dmat4 turned(1);
    turned[0] = dvec4(0.6, 0, -0.8, 0), turned[2] = dvec4(0.8, 0, 0.6, 0), turned[3].x = 3;
    dmat4 mirrored(1);
    mirrored[0].x = -2;
    scene.objects = {{.name = "x", .mesh = 0, .material = 1, .world_from_object = turned},
                     {.name = "x", .mesh = 1, .material = 0, .world_from_object = mirrored},
                     {.name = "light", .mesh = 1, .material = 2}};
    // Reverses the triangles, because the object that uses the mesh is mirrored.
    for (uvec3& t : scene.meshes[1].triangles) std::swap(t.y, t.z);
    scene.objects[0].sphere = Sphere{{3, 0, 0}, 1};
    scene.objects[0].motion = Keyframes{std::make_shared<const TranslationTrack>(
        TranslationTrack{.times = {0, 1, 2}, .values = {{0, 0, 0}, {1, 2, 4}, {0, 0, 1}}})};
    scene.cameras.push_back(
        {.name = "from above", .eye = {0, 9, 0}, .target = {0, 1, 0}, .up = {1, 0, 0}});
    return scene;
}

TEST_F(Load, TransformsKeyframesAndClashingNamesSurviveBothFormats) {
    const Scene wanted = build_scene_with_rare_features();
    save_glb(wanted, folder / "awkward.glb");
    save_obj(wanted, folder / "awkward.obj");
    for (const char* name : {"awkward.glb", "awkward.obj"}) {
        SCOPED_TRACE(name);
        const Scene scene = load((folder / name).string());
        ASSERT_EQ(scene.objects.size(), 3u);
        EXPECT_THAT(mirrors(scene), testing::ElementsAre(0));
        EXPECT_EQ(scene.materials[scene.objects[0].material].reflectance, vec3(0.5f, 1, 0.25f));
        EXPECT_EQ(scene.materials[scene.objects[1].material].albedo, vec3(0.1f, 0.2f, 0.3f));
        EXPECT_EQ(scene.materials[scene.objects[2].material].emission, vec3(0.5f, 0, 0.125f));
        for (const double t : {0.0, 0.5, 1.75}) {
            const Scene found = scene_at(scene, t), still = scene_at(wanted, t);
            for (std::size_t i = 0; i < 3; ++i) {
                const auto a = bounds(found, found.objects[i]), b = bounds(still, still.objects[i]);
                expect_near_loaded_positions(a.lo, b.lo, 1e-6);
                expect_near_loaded_positions(a.hi, b.hi, 1e-6);
            }
            expect_near_loaded_positions(found.objects[0].sphere->centre,
                                         still.objects[0].sphere->centre, 1e-6);
        }
        expect_near_loaded_positions(scene.cameras.at(0).up, {1, 0, 0}, 1e-12);
        expect_near_loaded_positions(scene.cameras.at(0).target, {0, 1, 0}, 1e-12);
        const auto found = list_lights(scene), still = list_lights(wanted);
        ASSERT_EQ(found.size(), 1u);
        expect_near_loaded_positions(found[0].normal, still[0].normal, 1e-6);
        const Mesh& flipped = scene.meshes[scene.objects[1].mesh];
        const uvec3 t = flipped.triangles[0];
        const auto p = [&](unsigned i) {
            return world_position_of_vertex(scene, scene.objects[1], i);
        };
        EXPECT_GT(glm::cross(p(t.y) - p(t.x), p(t.z) - p(t.x)).z, 0) << "faces +z as its normals";
    }
}

TEST_F(Load, WritingASceneTwiceGivesTheSameBytes) {
    for (const char* name : {"1.glb", "2.glb"})
        save_glb(build_scene_with_rare_features(), folder / name);
    EXPECT_TRUE(read_file(folder / "1.glb") == read_file(folder / "2.glb"));
    // A scene of floats is read back unchanged, but with the file's name.
    fs::create_directories(folder / "again");
    save_glb(load((folder / "1.glb").string()), folder / "again" / "1.glb");
    save_glb(load((folder / "again" / "1.glb").string()), folder / "2.glb");
    EXPECT_TRUE(read_file(folder / "again" / "1.glb") == read_file(folder / "2.glb"));
}

TEST_F(Load, WritingASceneIntoAMissingFolderIsAnError) {
    EXPECT_THROW(save_glb(build_scene_with_rare_features(), folder / "no" / "x.glb"), Error);
    EXPECT_THROW(save_obj(build_scene_with_rare_features(), folder / "no" / "x.obj"), Error);
}

// ---- rules of .obj files

TEST_F(Load, ObjTrianglesWithoutAreaAreDroppedAndNormalsAdded) {
    const Scene scene = load(
        write_loaded_file("x.obj", kTriangle + "v 0 0 1\no a\nf 1 2 3\nf 1 3 4\nf 1 1 2\n"));
    const Mesh& mesh = scene.meshes[scene.objects.at(0).mesh];
    EXPECT_EQ(mesh.triangles.size(), 2u);
    EXPECT_EQ(mesh.positions.size(), 6u) << "flat shading shares no vertex";
    EXPECT_EQ(mesh.normals[mesh.triangles[0].x], vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[mesh.triangles[1].x], vec3(1, 0, 0));
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_THAT(scene.warnings[0],
                HasSubstr("triangles without area, left out: 1 (first: in 'a')"));
}

TEST_F(Load, ObjNormalWithoutLengthBecomesTheFacetNormal) {
    const Scene scene = load(
        write_loaded_file("x.obj", kTriangle + "vn 0 0 0\nvn 0 0 -5\nf 1//1 2//2 3//2\n"));
    const Mesh& mesh = scene.meshes[scene.objects.at(0).mesh];
    const uvec3 t = mesh.triangles[0];
    EXPECT_EQ(mesh.normals[t.x], vec3(0, 0, 1));
    EXPECT_EQ(mesh.normals[t.y], vec3(0, 0, -1));
}

TEST_F(Load, ObjMirrorsAreObjectsWithAMirrorMaterial) {
    write_loaded_file("x.mtl", "newmtl dull grey\nKd 2 .5 -1\nnewmtl shiny\nillum 3\nKs 1 2 .5\n");
    const Scene scene = load(write_loaded_file(
        "x.obj",
        "mtllib x.mtl\n" + kTriangle +
            "o a\nusemtl shiny\nf 1 2 3\nusemtl dull grey\nf 1 3 2\nusemtl shiny\nf 3 2 1\n"
            "g b\nf -1 -2 -3\n"));
    ASSERT_EQ(scene.objects.size(), 3u);
    EXPECT_EQ(scene.objects[0].name, "a/shiny");
    EXPECT_EQ(scene.objects[1].name, "a/dull grey");
    EXPECT_EQ(scene.objects[2].name, "b");
    EXPECT_THAT(mirrors(scene), testing::ElementsAre(0, 2));
    EXPECT_EQ(scene.meshes[0].triangles.size(), 2u);
    EXPECT_EQ(scene.materials[1].reflectance, vec3(1, 1, 0.5f));
    EXPECT_EQ(scene.materials[0].albedo, vec3(1, 0.5f, 0));
}

TEST_F(Load, ObjErrorsNameLineExpectedAndFound) {
    EXPECT_THAT(load_error_text("a.obj", kTriangle + "f 1 2 4\n"),
                AllOf(HasSubstr("a.obj:4"), HasSubstr("one of 3 vertices"), HasSubstr("found 4")));
    EXPECT_THAT(load_error_text("b.obj", kTriangle + "f 1 2 -4\n"), HasSubstr("found -4"));
    EXPECT_THAT(load_error_text("c.obj", kTriangle + "f 0 1 2\n"), HasSubstr("found '0'"));
    EXPECT_THAT(load_error_text("d.obj", kTriangle + "f 1//1 2//1 3//1\n"), HasSubstr("0 normals"));
    EXPECT_THAT(load_error_text("e.obj", "v 0 nan 0\n"),
                AllOf(HasSubstr("e.obj:1"), HasSubstr("'nan'")));
    EXPECT_THAT(load_error_text("f.obj", "v 0 1e999 0\n"), HasSubstr("'1e999'"));
    EXPECT_THAT(load_error_text("g.obj", "v 0 0\n"), HasSubstr("found 2"));
    EXPECT_THAT(load_error_text("h.obj", kTriangle + "f 1 2\n"), HasSubstr("found none"));
    EXPECT_THAT(load_error_text("i.obj", kTriangle + "vt 0 0\nf 1/2 2/1 3/1\n"),
                HasSubstr("one of 1 texture coordinates, found 2"));
    EXPECT_THAT(load_error_text("j.obj", kTriangle), HasSubstr("found none"));
    EXPECT_THAT(load_error_text("k.obj", ""), HasSubstr("found none"));
    EXPECT_THAT(load_error_text("l.obj", kTriangle + "f 1 1 2\n"), HasSubstr("found none"));
    EXPECT_THAT(load_error_text("m.obj", kTriangle + "f 99999999999999999999 1 2\n"),
                HasSubstr("9999"));
    EXPECT_THAT(load_error_text("n.obj", "mtllib ../x.mtl\n"), HasSubstr("'../x.mtl'"));
}

TEST_F(Load, ObjCatoptricCommentsAreChecked) {
    const std::string head = kTriangle + "o ball\nf 1 2 3\n# catoptric ";
    EXPECT_THAT(load_error_text("a.obj", head + "sphere bull 0 0 0 1"),
                HasSubstr("did you mean 'ball'"));
    EXPECT_THAT(load_error_text("b.obj", head + "sphere ball 0 0 0 0"),
                HasSubstr("radius above 0"));
    EXPECT_THAT(load_error_text("c.obj", head + "motion ball harmonic 0 1 0 0"),
                HasSubstr("period"));
    EXPECT_THAT(load_error_text("d.obj", head + "motion ball linear 2 0 0 0 0"),
                HasSubstr("each of 2"));
    EXPECT_THAT(load_error_text("e.obj", head + "motion ball waltz"), HasSubstr("'waltz'"));
    EXPECT_THAT(load_error_text("f.obj", head + "camera c 0 0 0 0 0 1 0 1 0 180"),
                HasSubstr("180"));
    EXPECT_THAT(load_error_text("g.obj", head + "camera c 0 0 0 0 1 0 0 1 0 45"), HasSubstr("up"));
    EXPECT_THAT(load_error_text("h.obj", head + "light"), HasSubstr("wants a name"));
    EXPECT_THAT(load_error_text("i.obj", head + "light ball"), HasSubstr("found 'light'"));
    write_loaded_file("x.mtl", "newmtl a\nKd 1 x 1\n");
    EXPECT_THAT([&] { load(write_loaded_file("j.obj", "mtllib x.mtl\n" + head)); },
                testing::ThrowsMessage<Error>(AllOf(HasSubstr("x.mtl:2"), HasSubstr("'x'"))));
}

TEST_F(Load, ObjPolygonsAndContinuedLinesAreRead) {
    const Scene scene = load(
        write_loaded_file("x.obj", "v 0 0 0\r\nv 1 \\\n0 0\nv 1 1 0 # corner\nv 0 1 0\nvt 0 0\n"
                                   "f 1/1 2/1 3/1 4/1\ns 1\nl 1 2\nvp 1 2\n"));
    EXPECT_EQ(triangle_count(scene), 2u);
}

// ---- rules of glTF files

TEST_F(Load, GltfTriangleGetsDefaultNormalsAndMaterial) {
    const Scene scene = load(write_loaded_file("x.gltf", make_gltf_text()));
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_EQ(scene.objects[0].name, "n");
    EXPECT_EQ(scene.meshes[0].normals, std::vector<vec3>(3, vec3(0, 0, 1)));
    EXPECT_EQ(scene.materials[0].albedo, vec3(1));
}

TEST_F(Load, GltfErrorsNamePlaceExpectedAndFound) {
    int n = 0;
    const auto broken = [&](const std::string& from, const std::string& to) {
        return load_error_text(std::to_string(++n) + ".gltf", make_gltf_text(from, to));
    };
    EXPECT_THAT(broken("2.0", "1.0"), AllOf(HasSubstr("asset.version"), HasSubstr("\"1.0\"")));
    EXPECT_THAT(broken("\"asset\"", "\"ass\""), HasSubstr("found null"));
    EXPECT_THAT(broken("\"scene\":0", "\"extensionsRequired\":[\"KHR_draco\"],\"scene\":0"),
                HasSubstr("\"KHR_draco\""));
    EXPECT_THAT(broken("\"mesh\":0", "\"mesh\":7"), HasSubstr("found 7"));
    EXPECT_THAT(broken("\"POSITION\":0", "\"POSITION\":5"), HasSubstr("5"));
    EXPECT_THAT(broken("\"count\":3", "\"count\":4"), HasSubstr("holds 3"));
    EXPECT_THAT(broken("\"count\":3", "\"count\":2"), HasSubstr("three corners"));
    EXPECT_THAT(broken("\"VEC3\"", "\"VEC2\""), HasSubstr("VEC3"));
    EXPECT_THAT(broken("5126", "5123"), HasSubstr("floats"));
    EXPECT_THAT(broken("5126", "5127"), testing::Not(testing::IsEmpty()));
    EXPECT_THAT(broken("\"byteOffset\":0", "\"byteOffset\":4"), HasSubstr("from 4 on"));
    EXPECT_THAT(broken("AAAAAAAAAAAA", "AADAfwAAAAAA"), HasSubstr("finite")); // bytes of a NaN
    EXPECT_THAT(broken("\"mesh\":0", "\"mesh\":0,\"children\":[0]"), HasSubstr("within itself"));
    EXPECT_THAT(broken("\"nodes\":[0]", "\"nodes\":[0,0]"), HasSubstr("one parent"));
    EXPECT_THAT(broken("\"nodes\":[0]", "\"nodes\":[]"), HasSubstr("found none"));
    EXPECT_THAT(broken("\"mesh\":0", "\"mesh\":0,\"scale\":[0,0,0]"), HasSubstr("found none"));
    EXPECT_THAT(broken("\"mesh\":0",
                       "\"mesh\":0,\"scale\":[1e308,1e308,1e308],\"translation\":[1e308,1e308,0]"),
                HasSubstr("overflow"));
    EXPECT_THAT(broken("\"mesh\":0", "\"mesh\":0,\"extras\":{\"catoptric\":{\"sphere\":3}}"),
                HasSubstr("[x, y, z, r]"));
    EXPECT_THAT(broken("\"scene\":0", "\"scene\":0,\"extras\":" + std::string(9999, '[')),
                HasSubstr("nesting"));
}

TEST_F(Load, GltfSphereMarkOnAnotherShapeIsIgnored) {
    const std::string mark = "\"mesh\":0,\"extras\":{\"catoptric\":{\"sphere\":true}}";
    const Scene scene = load(write_loaded_file("x.gltf", make_gltf_text("\"mesh\":0", mark)));
    EXPECT_FALSE(scene.objects[0].sphere);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_THAT(scene.warnings[0], HasSubstr("marked as a sphere"));
}

TEST_F(Load, GltfParentTransformsApplyToTheMotionOfChildren) {
    // The parent is turned by 90 degrees about z and scaled by 2, so the child's +x is the world's
    // +y.
    Scene inner{.name = "inner"};
    inner.materials.push_back({.name = "m"});
    inner.meshes.push_back(quad("q", {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}));
    inner.objects.push_back({.name = "o", .motion = HarmonicMotion{{1, 0, 0}, 2}});
    save_glb(inner, folder / "inner.glb");
    const std::string bytes = read_file(folder / "inner.glb");
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data() + 12, 4);
    GltfFileBuilder outer{.root = Json::parse(bytes.substr(20, length)),
                          .data = bytes.substr(28 + length)};
    outer.root["scenes"][0]["nodes"] = {1};
    outer.root["nodes"].push_back({{"children", {0}},
                                   {"scale", {2, 2, 2}},
                                   {"rotation", {0, 0, std::sqrt(.5), std::sqrt(.5)}}});
    const Scene scene = load(write_loaded_file("outer.glb", outer.glb_bytes()));
    const Scene moved = scene_at(scene, 1);
    expect_near_loaded_positions(dvec3(moved.objects[0].world_from_object[3]), {0, 4, 0}, 1e-6);
    expect_near_loaded_positions(bounds(moved).lo, {-2, 4, 0}, 1e-6);
}

// ---- damaged files must not crash the loader or cause exceptions of other types

void load_and_ignore_errors(const std::string& path) {
    try {
        load(path);
    } catch (const Error& error) {
        EXPECT_TRUE(error.failure == Failure::bad_data || error.failure == Failure::missing_input)
            << error.what();
    }
}

TEST_F(Load, TruncatedFilesAreRefused) {
    save_glb(build_scene_with_rare_features(), folder / "x.glb");
    const std::string glb = read_file(folder / "x.glb");
    for (std::size_t size = 0; size < glb.size(); size += size < 64 ? 1 : 17)
        load_error_text("y.glb", glb.substr(0, size));
    const std::string gltf = make_gltf_text();
    for (std::size_t size = 0; size + 1 < gltf.size(); size += 3)
        load_error_text("y.gltf", gltf.substr(0, size));
    save_obj(build_scene_with_rare_features(), folder / "x.obj");
    const std::string obj = read_file(folder / "x.obj");
    for (std::size_t size = 0; size < obj.size(); size += 7)
        load_and_ignore_errors(write_loaded_file("y.obj", obj.substr(0, size)));
}

TEST_F(Load, LoadingDamagedFilesNeverCrashes) {
    save_glb(build_scene_with_rare_features(), folder / "x.glb");
    save_obj(build_scene_with_rare_features(), folder / "x.obj");
    std::mt19937 random(1);
    for (const char* name : {"x.glb", "x.obj", "x.mtl", "x.gltf"}) {
        const std::string whole = name == std::string("x.gltf") ? make_gltf_text()
                                                                : read_file(folder / name);
        const std::string target = name == std::string("x.mtl") ? "x.obj" : name;
        const std::string digits = "0123456789-{}[],:\"./e# \n";
        for (int round = 0; round < 400; ++round) {
            std::string damaged = whole;
            for (unsigned i = 0; i <= random() % 3; ++i) {
                char& byte = damaged[random() % damaged.size()];
                byte = random() % 2 ? digits[random() % digits.size()]
                                    : static_cast<char>(random());
            }
            write_loaded_file(name, damaged);
            load_and_ignore_errors((folder / target).string());
        }
        write_loaded_file(name, whole);
    }
}

// ---- numbers as text

TEST(Number, NumbersWrittenAsTextReadBackExactly) {
    for (const double x : {0.1, 1e-300, 548.8, -1.0 / 3, 1e22, 5e-324})
        EXPECT_EQ(parse_number(format_number(x)), x);
    EXPECT_EQ(format_number(-0.0), "0");
    EXPECT_EQ(format_number(0.1f), "0.1");
    EXPECT_EQ(shortest_double(0.725f), 0.725);
    EXPECT_EQ(parse_number("+2.5"), 2.5);
    EXPECT_EQ(parse_number("1e-999"), 0);
    for (const char* text : {"", "+", "-", "x", "1x", "nan", "inf", "1e999", "+-1", "0x10", "1,5"})
        EXPECT_FALSE(parse_number(text).has_value()) << text;
}

} // namespace
