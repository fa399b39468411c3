// Tests of what mirrors show of surfaces that show what is behind them: blended, cut out and glass.
// Each is judged beside an opaque twin.
#include "scene/pattern.hpp"
#include "support/rendering.hpp"
#include "support/scenes.hpp"
#include "support/special_values.hpp"

#include <iostream>

namespace {

using namespace catoptric;

enum class Kind { opaque, blended, faint, cut_out, glass };

scene::Material make_card_material(Kind kind) {
    scene::Material card{.name = "card", .albedo = {.9f, .3f, .1f}, .unlit = true};
    if (kind == Kind::blended || kind == Kind::faint)
        card.alpha = kind == Kind::faint ? .3f : .7f, card.blended = true;
    if (kind == Kind::cut_out) {
        card.albedo_texture = scene::make_checker_texture({250, 90, 60}, {60, 90, 250}, 4);
        scene::Image holes = *card.albedo_texture->image;
        for (std::size_t i = 0; i < holes.texels.size(); ++i)
            if ((i / 4 + i / holes.size.x / 4) % 2 == 0) holes.texels[i] &= 0xffffffu;
        card.albedo_texture->image = std::make_shared<const scene::Image>(std::move(holes));
        card.alpha_cutoff = .5f;
    }
    if (kind != Kind::glass) return card;
    return {.name = "card",
            .albedo = {.5f, .9f, .6f},
            .roughness = 0,
            .dielectric_f0 = vec3(.04f),
            .dielectric_f90 = vec3(1),
            .transmission = 1,
            .ior = 1.5f};
}

/// Returns a mirror, flat or a ball, with cards or balls of this kind one behind the other before
/// it, and a wall of two colours far behind them.
scene::Scene make_scene(Kind kind, bool has_balls, int count, bool is_flat) {
    scene::Scene scene{.name = "cards"};
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    if (is_flat)
        test::add_quad(scene, "mirror", mirror, {-1.5, -1.5, 0}, {1.5, -1.5, 0}, {1.5, 1.5, 0},
                       {-1.5, 1.5, 0});
    else
        test::add_ball(scene, "mirror", mirror, {0, 0, -.6}, 1);
    scene::Material made = make_card_material(kind);
    made.two_sided = true;
    made.solid = has_balls && kind == Kind::glass;
    const std::size_t material = test::add_material(scene, made);
    for (int i = 0; i < count; ++i) {
        const dvec3 centre(-.3 + .35 * i, .1 * i, 1 + .9 * i);
        if (has_balls)
            test::add_ball(scene, "ball", material, centre, .4, 3);
        else
            test::add_quad(scene, "card", material, centre + dvec3(-.6, -.6, 0),
                           centre + dvec3(-.6, .6, 0), centre + dvec3(.6, .6, 0),
                           centre + dvec3(.6, -.6, 0));
    }
    for (const double side : {-1., 1.}) {
        const std::size_t wall = test::add_material(
            scene,
            {.name = "wall", .emission = side < 0 ? vec3(.1f, .2f, .8f) : vec3(.9f, .9f, .8f)});
        test::add_quad(scene, "wall", wall, {0, -6, 4.5}, {0, 6, 4.5}, {side * 6, 6, 4.5},
                       {side * 6, -6, 4.5});
    }
    scene.cameras.push_back({.eye = {1.2, .2, 3}, .target = {0, 0, 0}, .vertical_fov_degrees = 40});
    return scene;
}

/// Returns the share of mirror pixels that are off by more than .1.
double share_off(const scene::Scene& scene, const char* technique) {
    const uvec2 size{96, 96};
    const app::TechniqueResult traced = test::render_technique(scene, "raytrace", size);
    const measure::Picture found = test::render_technique(scene, technique, size, 2).hdr;
    int off = 0, mirrors = 0;
    for (std::size_t i = 0; i < traced.hits.size(); ++i) {
        if (!measure::first_mirror_of_hit_word(traced.hits[i])) continue;
        ++mirrors;
        off += test::max_channel_difference(found.pixels[i], traced.hdr.pixels[i]) > .1f;
    }
    EXPECT_GT(mirrors, 400);
    return static_cast<double>(off) / mirrors;
}

TEST(SeeThrough, HybridTracesWhatShowsMoreThanOneSurface) {
    double worst = 0;
    for (const bool has_balls : {false, true})
        for (const bool is_flat : {true, false})
            for (const int count : {1, 3}) {
                const auto share = [&](Kind kind) {
                    return share_off(make_scene(kind, has_balls, count, is_flat), "hybrid");
                };
                const double twin = share(Kind::opaque);
                for (const Kind kind : {Kind::blended, Kind::faint, Kind::cut_out, Kind::glass}) {
                    const double found = share(kind);
                    worst = std::max(worst, found);
                    EXPECT_LE(found, .02 + twin)
                        << (has_balls ? "balls" : "cards") << " x " << count << ", kind "
                        << int(kind) << (is_flat ? ", flat" : ", ball");
                }
            }
    std::cout << "[ MEASURED ] at most " << worst << " of the mirrors' pixels off\n";
    EXPECT_LE(worst, .05);
}

TEST(SeeThrough, SearchesFindABlendedCardWhereItIs) {
    const double opaque = share_off(make_scene(Kind::opaque, false, 1, true), "secant"),
                 blended = share_off(make_scene(Kind::blended, false, 1, true), "secant");
    std::cout << "[ MEASURED ] secant: opaque card " << opaque << ", blended card " << blended
              << " off\n";
    EXPECT_LE(blended, opaque + .1);
}

/// A search keeps what is seen through a nearly clear surface where it is, and not the surface.
TEST(SeeThrough, FaintSurfacesDoNotMoveWhatIsBehindThem) {
    scene::Scene scene = make_scene(Kind::faint, false, 1, true);
    for (scene::Material& material : scene.materials)
        if (material.blended) material.alpha = .02f;
    scene::Scene without = scene;
    std::erase_if(without.objects,
                  [](const scene::Object& object) { return object.name == "card"; });
    EXPECT_LE(share_off(scene, "secant"), share_off(without, "secant") + .02);
}

} // namespace
