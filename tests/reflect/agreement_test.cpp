// Where no mirror is seen, raster and ray tracing are the same picture.
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

struct Sides {
    const char *name, *raster, *traced;
    double most; ///< rmse
    friend void PrintTo(const Sides& sides, std::ostream* out) { *out << sides.name; }
};
class Agreement : public testing::TestWithParam<Sides> {};
INSTANTIATE_TEST_SUITE_P(
    Shadows, Agreement,
    testing::Values(Sides{"map_and_ray", "naive:bounces=0", "raytrace:depth=16", .003},
                    Sides{"none", "naive:bounces=0,shadow=none", "raytrace:depth=16,shadow=none",
                          5e-4},
                    Sides{"map_on_both", "naive:bounces=0", "raytrace:depth=16,shadow=map", 5e-4}),
    [](const auto& instance) { return std::string(instance.param.name); });

TEST_P(Agreement, OfRasterAndRayTracing) {
    const auto& [name, raster, traced, most] = GetParam();
    for (const scene::Scene& scene : {scene::cornell_mirrors(), test::room(2, 2)}) {
        const app::Part truth = test::render(scene, traced, {512, 512});
        const double error = test::rmse(test::render(scene, raster, {512, 512}).hdr, truth.hdr,
                                        measure::non_mirror(truth.hits));
        std::cout << "[ MEASURED ] " << scene.name << ", shadows " << name << ": rmse " << error
                  << " on non-mirror pixels\n";
        EXPECT_LE(error, most) << scene.name;
    }
}

// What is lifted off its surface so that it does not shade itself is lifted no further: coarse maps
// show it, because they lift by texels.
TEST(ShadowMap, LiftsNoFurtherThanItMust) {
    const app::Part truth = test::render(scene::cornell_mirrors(), "raytrace:depth=16", {256, 256});
    const double error = test::rmse(
        test::render(scene::cornell_mirrors(), "naive:bounces=0,shadow_map=64", {256, 256}).hdr,
        truth.hdr, measure::non_mirror(truth.hits));
    std::cout << "[ MEASURED ] shadow_map=64: rmse " << error << " on non-mirror pixels\n";
    EXPECT_LE(error, .0052); // measured: .0049; lifted twice as far: .0055
}

// A node that is scaled flat is what it looks like: a quad lies as it did, a ball becomes a disc.
TEST(Flattened, NodesKeepTheirNormals) {
    scene::Scene flat{.name = "flat"};
    test::add_quad(flat, "lamp", test::add_material(flat, {.name = "lamp", .emission = vec3(9)}),
                   {-1, 3, -4}, {1, 3, -4}, {1, 3, -2}, {-1, 3, -2});
    test::add_quad(flat, "wall", test::add_material(flat, {.name = "grey", .albedo = vec3(.7f)}),
                   {-2, -2, 0}, {-2, 2, 0}, {2, 2, 0}, {2, -2, 0});
    test::add_ball(flat, "ball", test::add_material(flat, {.name = "mirror", .mirror = true}),
                   {0, 0, -.5}, .5);
    flat.objects.back().sphere.reset();
    flat.objects.back().world_from_object = dmat4(1);
    flat.objects.back().world_from_object[3] = dvec4(0, 0, -.5, 1);
    flat.objects.back().world_from_object[2] = dvec4(0); // a mirror disc
    flat.cameras.push_back({.eye = {0, 1, -6}, .target = {0, 0, 0}, .vertical_fov_degrees = 50});
    scene::Scene scaled = flat;
    scaled.objects[1].world_from_object[2] = dvec4(0); // its mesh has no extent along z
    for (const std::string technique : {"raytrace", "parallax:face=64"}) {
        const measure::Picture wanted = test::render(flat, technique, {128, 128}, 3).hdr,
                               found = test::render(scaled, technique, {128, 128}, 3).hdr;
        EXPECT_EQ(test::nonfinite(wanted), 0u) << technique;
        EXPECT_TRUE(test::same_bytes(found, wanted)) << technique;
        EXPECT_GT(wanted.at(20, 64).x, .1f) << technique << ": the wall is lit";
    }
}

} // namespace
