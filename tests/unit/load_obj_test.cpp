// Tests of loading surfaces and texture coordinates from .obj and .mtl files.
#include "import/file_options.hpp"
#include "import/image_file.hpp"
#include "scene/material_facts.hpp"
#include "support/refusal.hpp"
#include "unit/load_fixture.hpp"

#include <cmath>
#include <limits>

namespace {

using namespace test::loading;
using testing::ElementsAre;

const Image kLoadObjPicture{.name = "p", .size = {2, 1}, .texels = {0xff0000ff, 0xff00ff00}};

class LoadObj : public Load {
protected:
    /// Loads a triangle whose material has the given MTL statements, and returns the material.
    Material load_mtl_material(const std::string& statements) const {
        return load_obj_statements(statements).materials.at(0);
    }
    Scene load_obj_statements(const std::string& statements) const {
        write_loaded_file("m.mtl", "newmtl a\n" + statements);
        return load_obj(
            write_loaded_file("x.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\n"));
    }
    static std::vector<std::string> list_unsupported_feature_ids(const Scene& scene) {
        std::vector<std::string> list;
        for (const UnsupportedFeature& gap : scene.unsupported) list.push_back(gap.id);
        return list;
    }
    void expect_near_colour(const vec3& found, const vec3& wanted) const {
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(found[i], wanted[i], 1e-6f);
    }
};

TEST_F(LoadObj, TextureCoordinatesAreFlippedVertically) {
    const Scene scene = load(write_loaded_file("x.obj", kTriangle +
                                                            "vt 0 0\nvt 1 .25 9\nvt .5\nvn 0 0 1\n"
                                                            "f 1/1/1 2/2/1 3/-1/1\nf 1/3 2/2 3/1\n"
                                                            "f 1 2 3\n"));
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.uv[0].size(), mesh.positions.size());
    const uvec3 t = mesh.triangles[0], other = mesh.triangles[1], without = mesh.triangles[2];
    EXPECT_EQ(mesh.uv[0][t.x], vec2(0, 1));
    EXPECT_EQ(mesh.uv[0][t.y], vec2(1, .75f));
    EXPECT_EQ(mesh.uv[0][t.z], vec2(.5f, 1));
    EXPECT_EQ(mesh.uv[0][other.z], vec2(0, 1)) << "each corner its own";
    EXPECT_EQ(mesh.uv[0][without.y], vec2(0));
    EXPECT_TRUE(
        load(write_loaded_file("y.obj", kTriangle + "vt 0 0\nf 1 2 3\n")).meshes[0].uv[0].empty());
}

TEST_F(LoadObj, ColoursAfterPositionsBecomeVertexColours) {
    const Scene scene = load(write_loaded_file(
        "x.obj", "v 0 0 0\nv 1 0 0 1 .5 .25\nv 0 1 0 1 0 2 0\nv 0 0 1 9\nf 1 2 3\n"));
    const Mesh& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.colours.size(), 3u);
    EXPECT_EQ(mesh.colours[mesh.triangles[0].x], vec4(1));
    expect_near_colour(vec3(mesh.colours[mesh.triangles[0].y]), vec3(1, .214041f, .0508761f));
    EXPECT_EQ(mesh.colours[mesh.triangles[0].z], vec4(0, 1, 0, 1)) << "after a weight, within 0..1";
}

TEST_F(LoadObj, TextureMapsAndTheirOptionsAreRead) {
    write_loaded_file("wood and stone.png", encode_png(kLoadObjPicture));
    const Scene plain = load_obj_statements("map_Kd wood and stone.png\n");
    const Material& material = plain.materials[0];
    ASSERT_TRUE(material.albedo_texture);
    EXPECT_EQ(material.albedo, vec3(1)) << "without a Kd the map is all of it";
    EXPECT_EQ(material.albedo_texture->image->texels, kLoadObjPicture.texels);
    EXPECT_TRUE(material.albedo_texture->srgb);
    EXPECT_EQ(material.albedo_texture->wrap_u, Texture::Wrap::repeat);
    EXPECT_EQ(material.albedo_texture->v_row, vec3(0, 1, 0));
    EXPECT_THAT(plain.files, testing::SizeIs(3));
    const Texture texture = *load_mtl_material(
                                 "Kd .5 .5 .5\nmap_Kd -s 2 4 1 -o .5 .25 -clamp on -bm 1 "
                                 "wood and stone.png\n")
                                 .albedo_texture;
    EXPECT_EQ(texture.wrap_v, Texture::Wrap::clamp);
    // In MTL coordinates, where v points up, (.25, .5) becomes (2 * .25 + .5, 4 * .5 + .25).
    const vec3 downwards(.25f, .5f, 1);
    EXPECT_EQ(glm::dot(texture.u_row, downwards), 1);
    EXPECT_EQ(glm::dot(texture.v_row, downwards), 1 - 2.25f);
    // Paths in the style of Windows; the second path has a drive that does not exist here.
    for (const char* name : {".\\wood and stone.png", "C:\\maps\\wood and stone.png"})
        EXPECT_TRUE(load_mtl_material(std::string("map_Kd ") + name + "\n").albedo_texture) << name;
    const Scene missing = load_obj_statements("Kd .5 0 0\nmap_Kd gone.png\n");
    EXPECT_EQ(missing.materials[0].albedo, vec3(.5f, 0, 0));
    EXPECT_THAT(list_unsupported_feature_ids(missing), ElementsAre("missing-image"));
}

TEST_F(LoadObj, MaterialColoursAreReadAndHaveDefaults) {
    expect_near_colour(load_mtl_material("").albedo, vec3(.8f));
    expect_near_colour(load_mtl_material("Kd .25\n").albedo, vec3(.25f));
    expect_near_colour(load_mtl_material("Kd 2 .5 -1\n").albedo, vec3(1, .5f, 0));
    EXPECT_EQ(load_mtl_material("Ke 3 2 1\n").emission, vec3(3, 2, 1));
    EXPECT_EQ(load_mtl_material("Ke 3\n").albedo, vec3(0)) << "a lamp that says no more is black";
    EXPECT_TRUE(load_mtl_material("Kd 1 1 1\n").two_sided);
    EXPECT_FALSE(load_mtl_material("Ke 1\n").two_sided);
    EXPECT_THAT(load_error_text("x.obj", "mtllib m.mtl\n"), testing::Not(testing::IsEmpty()));
}

TEST_F(LoadObj, IlluminationModelDecidesTheKindOfReflection) {
    const Material constant = load_mtl_material("Kd .5 .5 .5\nKs .25 .5 1\nillum 3\n");
    EXPECT_TRUE(constant.mirror);
    EXPECT_EQ(constant.reflectance, vec3(.25f, .5f, 1));
    EXPECT_EQ(constant.albedo, vec3(.5f)) << "shows between";
    EXPECT_TRUE(load_mtl_material("Ks 1 1 1\nNs 100\nillum 8\n").mirror);
    const Material faint = load_mtl_material("Ks .1 .1 .1\nillum 3\n");
    EXPECT_FALSE(faint.mirror);
    EXPECT_EQ(faint.roughness, 0);
    EXPECT_EQ(faint.dielectric_f0, vec3(.1f));
    EXPECT_EQ(faint.dielectric_f90, vec3(.1f)) << "at any angle";
    const Material rough = load_mtl_material("Ks 1 1 1\nNs 30\nillum 3\n");
    EXPECT_FALSE(rough.mirror);
    EXPECT_NEAR(rough.roughness, .5, 1e-6) << "alpha^2 = 2 / (Ns + 2)";
    const Material schlick = load_mtl_material("Ks .5 .25 .125\nillum 5\n");
    EXPECT_FALSE(schlick.mirror);
    EXPECT_EQ(schlick.roughness, 0);
    EXPECT_EQ(schlick.dielectric_f0, vec3(.5f, .25f, .125f));
    EXPECT_EQ(schlick.dielectric_f90, vec3(1));
    const Material metal = load_mtl_material("Kd 1 .5 0\nKs 1 1 1\nNs 5\nPr .05\nPm 1\nillum 3\n");
    EXPECT_FALSE(metal.mirror);
    EXPECT_EQ(metal.metallic, 1);
    EXPECT_EQ(metal.roughness, .05f) << "wins over Ns";
    const Material coated = load_mtl_material("Kd 1 .5 0\nPc .75\nPcr .25\n");
    EXPECT_EQ(coated.clearcoat, .75f);
    EXPECT_EQ(coated.clearcoat_roughness, .25f);
    EXPECT_THAT(list_unsupported_feature_ids(load_obj_statements("Ks 1 1 1\nillum 3\nPc 1\n")),
                ElementsAre("clearcoat"));
    EXPECT_EQ(load_mtl_material("Kd 1 1 1\nPc 7\n").clearcoat, 1) << "kept between 0 and 1";
    for (const char* kind : {"0", "1"}) {
        const Material diffuse = load_mtl_material(std::string("Ks 1 1 1\nNs 900\nillum ") + kind +
                                                   "\n");
        EXPECT_FALSE(diffuse.mirror);
        EXPECT_EQ(diffuse.dielectric_f0, vec3(0));
        EXPECT_EQ(diffuse.dielectric_f90, vec3(0));
    }
}

/// The statements Ks and Ns make a rough lobe with `illum 2`, which is also the default without
/// `illum`.
TEST_F(LoadObj, HighlightsAreRoughLobes) {
    for (const char* kind : {"illum 2\n", ""}) {
        const Material lobe = load_mtl_material(std::string("Ks .5 .25 .125\nNs 160\n") + kind);
        EXPECT_FALSE(lobe.mirror);
        EXPECT_EQ(lobe.dielectric_f0, vec3(.5f, .25f, .125f));
        EXPECT_EQ(lobe.dielectric_f90, lobe.dielectric_f0) << "at any angle";
        EXPECT_NEAR(lobe.roughness, 1 / 3., 1e-6) << "alpha^2 = 2 / 162 = 1 / 81";
    }
    EXPECT_EQ(load_mtl_material("Ks .5 .5 .5\n").roughness, 1) << "without Ns";
    const Material none = load_mtl_material("Ks 0 0 0\nNs 30\n");
    EXPECT_EQ(none.dielectric_f0, vec3(0));
    EXPECT_EQ(none.dielectric_f90, vec3(0));
    const Material physical = load_mtl_material("Ks 1 1 1\nPr .5\n");
    EXPECT_EQ(physical.dielectric_f0, vec3(.04f)) << "Pr takes a dielectric of index 1.5";
    EXPECT_EQ(physical.dielectric_f90, vec3(1));
}

TEST_F(LoadObj, NormalMapsAreReadAndHeightMapsAreListed) {
    write_loaded_file("bumps.png", encode_png(kLoadObjPicture));
    const Scene mapped = load_obj_statements("Kd 1 1 1\nnorm bumps.png\n");
    ASSERT_TRUE(mapped.materials[0].normal_texture);
    EXPECT_FALSE(mapped.materials[0].normal_texture->srgb);
    EXPECT_THAT(list_unsupported_feature_ids(mapped), testing::IsEmpty());
    EXPECT_THAT(mapped.warnings, testing::IsEmpty());
    const Scene height = load_obj_statements("Kd 1 1 1\nmap_Bump bumps.png\n");
    EXPECT_FALSE(height.materials[0].normal_texture);
    EXPECT_THAT(list_unsupported_feature_ids(height), ElementsAre("normal-texture"));
}

TEST_F(LoadObj, GlassIsListedAndTransparencyBecomesAMask) {
    for (const char* glass : {"illum 4\n", "illum 6\n", "illum 7\n", "illum 9\n", "d .25\nNi 1.5\n",
                              "Tr .75\nNi 1.5\n"}) {
        const Scene scene = load_obj_statements(glass);
        EXPECT_FALSE(has_alpha_mask(scene.materials[0])) << glass;
        EXPECT_THAT(list_unsupported_feature_ids(scene),
                    ElementsAre("glass-approximated", "glass-shadow"))
            << glass;
    }
    const Material dense = load_obj_statements("illum 7\nNi 1e300\n").materials[0];
    EXPECT_EQ(dense.ior, std::numeric_limits<float>::max());
    EXPECT_EQ(dense.dielectric_f0, vec3(1));
    const Scene thin = load_obj_statements("d .25\n");
    EXPECT_EQ(thin.materials[0].alpha, .25f);
    EXPECT_EQ(thin.materials[0].alpha_cutoff, .5f);
    EXPECT_TRUE(thin.materials[0].blended);
    EXPECT_THAT(list_unsupported_feature_ids(thin), ElementsAre("blend-shadow"));
    EXPECT_EQ(load_mtl_material("Tr .25\nNi 1\n").alpha, .75f);
    EXPECT_FALSE(has_alpha_mask(load_mtl_material("d 1\nNi 1.5\n")));
    // The loader does not read a separate mask (map_d), so nothing is cut out.
    write_loaded_file("p.png", encode_png(kLoadObjPicture)),
        write_loaded_file("q.png", encode_png(kLoadObjPicture));
    const Scene other = load_obj_statements("map_Kd p.png\nmap_d q.png\n");
    EXPECT_FALSE(has_alpha_mask(other.materials[0]));
    EXPECT_THAT(list_unsupported_feature_ids(other), testing::Contains("material-extension"));
    EXPECT_THAT(list_unsupported_feature_ids(other),
                testing::Not(testing::Contains("blend-shadow")));
}

TEST_F(LoadObj, IlluminationModelMustBeAWholeNumberUpTo10) {
    write_loaded_file("m.mtl", "newmtl a\nillum 10\n");
    write_loaded_file("x.obj", "mtllib m.mtl\nusemtl a\n" + kTriangle + "f 1 2 3\n");
    EXPECT_NO_THROW(load((folder / "x.obj").string()));
    for (const char* kind : {"1e300", "-1", "11", "2.5"}) {
        write_loaded_file("m.mtl", std::string("newmtl a\nillum ") + kind + "\n");
        EXPECT_THAT(
            test::catch_error_text(Failure::bad_data, [&] { load((folder / "x.obj").string()); }),
            HasSubstr("m.mtl:2: 'illum' wants a whole number from 0 to 10, found "))
            << kind;
    }
}

TEST_F(LoadObj, MissingMaterialsAreGrey) {
    const Scene scene = load(
        write_loaded_file("x.obj", "mtllib gone.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\n"));
    expect_near_colour(scene.materials.at(0).albedo, vec3(.8f));
    EXPECT_THAT(scene.warnings,
                testing::Contains(HasSubstr("material libraries that are not there: "
                                            "1 (first: ")));
    ASSERT_THAT(list_unsupported_feature_ids(scene), ElementsAre("missing-material"));
    EXPECT_EQ(scene.unsupported[0].count, 2u);
    write_loaded_file("m.mtl", "newmtl a\nKd 1 0 0\n");
    const Scene other = load(write_loaded_file(
        "x.obj", "mtllib m.mtl\n" + kTriangle + "usemtl a\nf 1 2 3\nusemtl b\nf 1 3 2\n"));
    ASSERT_EQ(other.objects.size(), 2u);
    expect_near_colour(other.materials[other.objects[0].material].albedo, vec3(1, 0, 0));
    expect_near_colour(other.materials[other.objects[1].material].albedo, vec3(.8f));
    EXPECT_THAT(other.warnings, testing::Contains(HasSubstr(
                                    "uses of materials that no library has, drawn grey: 1")));
}

TEST_F(LoadObj, FacesOfFewCornersPointsAndLinesAreListed) {
    const Scene scene = load(
        write_loaded_file("x.obj", kTriangle + "f 1\nf 1 2\nf 1 2 3\np 1 2\nl 1 2 3\n"));
    EXPECT_EQ(triangle_count(scene), 1u);
    ASSERT_THAT(list_unsupported_feature_ids(scene), ElementsAre("points-lines"));
    EXPECT_EQ(scene.unsupported[0].count, 4u);
}

TEST_F(LoadObj, FilesWithByteOrderMarksAndCrLfAreRead) {
    write_loaded_file("m n.mtl", "\xef\xbb\xbfnewmtl a b\r\nKd 1 0 0\r\n");
    const Scene scene = load(
        write_loaded_file("x.obj", "\xef\xbb\xbfmtllib m n.mtl\r\nv 0 0 0\r\nv 1 0 0\r\n"
                                   "v 0 1 0\r\no an object\r\nusemtl a b\r\nf 1 2 \\\r\n3\r\n"));
    EXPECT_EQ(scene.objects.at(0).name, "an object");
    EXPECT_EQ(scene.materials.at(0).name, "a b");
    expect_near_colour(scene.materials[0].albedo, vec3(1, 0, 0));
}

} // namespace
