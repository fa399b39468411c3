// The split of an error by cause: complete, and blaming what is to blame.
#include "app/causes.hpp"
#include "app/compare.hpp"
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

constexpr uvec2 kSize{96, 96};

struct Split {
    report::Causes causes;

    double in_turn(const std::string& name) const {
        return find(name).in_turn / causes.squared_error;
    }
    double alone(const std::string& name) const { return find(name).alone / causes.squared_error; }
    const report::Cause& find(const std::string& name) const {
        const auto found = std::ranges::find(causes.list, name, &report::Cause::name);
        if (found == causes.list.end()) throw std::runtime_error("no cause '" + name + "'");
        return *found;
    }
};

Split split(const app::Request& request, const std::string& technique) {
    app::Request reference = request;
    reference.techniques = {app::kReference};
    if (request.animate)
        reference.time = request.instant(request.total()), reference.animate = false;
    const app::Part truth = std::move(app::run(test::engine(), reference).parts.front());
    app::Session session(test::engine(), request.scene);
    return {app::CauseFinder(session, request, truth.hdr, truth.hits).find(technique)};
}

Split split(const scene::Scene& scene, const std::string& technique, uvec2 size = kSize) {
    app::Request request = test::request(scene, {}, size);
    request.warmup = 7;
    return split(request, technique);
}

std::vector<app::TechniqueInfo> that_capture() {
    std::vector<app::TechniqueInfo> list = app::techniques();
    std::erase_if(list, [](const app::TechniqueInfo& technique) {
        return std::ranges::find(technique.knobs, "face", &app::Knob::name) ==
               technique.knobs.end();
    });
    return list;
}

class EveryCause : public testing::TestWithParam<app::TechniqueInfo> {};
INSTANTIATE_TEST_SUITE_P(Table, EveryCause, testing::ValuesIn(that_capture()),
                         [](const auto& instance) { return instance.param.name; });

TEST_P(EveryCause, IsThere) {
    const Split found = split(scene::cornell_mirrors(),
                              test::with(GetParam(), {{"face", "32"}, {"shadow_map", "256"}}));
    std::cout << "[ MEASURED ] " << GetParam().name << ": rmse "
              << std::sqrt(found.causes.squared_error) << ", left " << found.causes.rest_rmse
              << "\n";
    EXPECT_GT(found.causes.squared_error, 1e-6) << "something to split";
    EXPECT_LE(found.causes.rest_rmse, 1e-3);
    EXPECT_LE(std::abs(found.in_turn("silhouettes")), .03)
        << "the last step takes what is true: it must be next to nothing";
    EXPECT_EQ(found.causes.squared_error_per_mirror.size(), 4u);
}

TEST(Causes, AreThereForEveryFormatAndKindOfShadow) {
    constexpr uvec2 kSmall{48, 48}; // whatever the size, nothing may be left
    for (const std::string technique :
         {"secant:face=32,shadow=none", "layered:face=32,distance=r16f",
          "pyramid:face=32,distance=unorm8,shadow=none", "hybrid:face=32,captures=own,continue=0",
          "march:face=32,mirrors=left_out,lookup=object"})
        EXPECT_LE(split(scene::cornell_mirrors_closed(), technique, kSmall).causes.rest_rmse, 1e-3)
            << technique;
    EXPECT_LE(split(test::room(2, 3), "secant:face=32", kSmall).causes.rest_rmse, 1e-3)
        << "three lights";
    EXPECT_LE(split(test::hall(), "pyramid:face=32", kSmall).causes.rest_rmse, 1e-3)
        << "mirrors of any shape";
}

// What eight bits lose is blamed on them, whichever way one looks.
TEST(Causes, EightBitsOfDistanceAreStorageFormat) {
    const Split coarse = split(scene::cornell_mirrors(), "parallax:face=128,distance=unorm8");
    EXPECT_GT(coarse.in_turn("storage format"), .7);
    EXPECT_GT(coarse.alone("storage format"), .7);
    EXPECT_EQ(split(scene::cornell_mirrors(), "parallax:face=64").in_turn("storage format"), 0.0);
}

TEST(Causes, LookingUpThePlainDirectionIsSearchDirection) {
    const Split plain = split(scene::cornell_mirrors(), "reuse:face=64");
    EXPECT_GT(plain.in_turn("search direction"), .6);
    EXPECT_EQ(plain.in_turn("stored distance"), 0.0); // it stores none
}

TEST(Causes, MissingShadowsAreShadowMap) {
    const Split dark = split(test::room(1, 1), "pyramid:face=64,shadow=none"),
                lit = split(test::room(1, 1), "pyramid:face=64");
    EXPECT_GT(dark.find("shadow map").in_turn, 10 * std::abs(lit.find("shadow map").in_turn));
    EXPECT_GT(dark.find("shadow map").alone, 10 * std::abs(lit.find("shadow map").alone));
}

TEST(Causes, CoarseTexelsAreTexels) {
    EXPECT_GT(split(test::room(1, 1), "pyramid:face=16").alone("texels"), .5);
}

TEST(Causes, OneBallMirrorsNeitherOthersNorItself) {
    const Split found = split(test::room(1, 1), "parallax:face=32");
    EXPECT_EQ(found.in_turn("mirror in mirror"), 0.0);
    EXPECT_EQ(found.in_turn("own reflection"), 0.0);
    EXPECT_EQ(found.alone("own reflection"), 0.0);
}

// Two boards at a right angle are one mirror that sees itself, which its own capture leaves out.
TEST(Causes, AHollowMirrorReflectsItself) {
    scene::Scene scene = test::room(0, 1);
    const std::size_t mirror = test::add_material(scene, {.name = "mirror", .mirror = true});
    test::add_mesh(scene, test::hollow_corner(), mirror);
    const Split found = split(scene, "pyramid:face=64");
    EXPECT_GT(found.in_turn("own reflection"), .3);
    EXPECT_LE(found.causes.rest_rmse, 1e-3);
}

TEST(Causes, OnlyWhatMovesLags) {
    app::Request request = test::request(scene::cornell_mirrors(), {}, kSize);
    request.warmup = 7;
    EXPECT_EQ(split(request, "reuse:face=64").alone("last frame"), 0.0);
    request.animate = true;
    request.time = 0.7;
    const Split moving = split(request, "reuse:face=64");
    EXPECT_NE(moving.alone("last frame"), 0.0);
    EXPECT_LE(moving.causes.rest_rmse, 1e-3);
}

TEST(Causes, AddUpToTheError) {
    const report::Causes causes = split(scene::cornell_mirrors(), "secant:face=64").causes;
    double sum = causes.rest_rmse * causes.rest_rmse;
    std::vector<double> per_mirror(causes.squared_error_per_mirror.size());
    for (const report::Cause& cause : causes.list) {
        sum += cause.in_turn;
        for (std::size_t i = 0; i < per_mirror.size(); ++i)
            per_mirror[i] += cause.in_turn_per_mirror[i];
    }
    EXPECT_NEAR(sum, causes.squared_error, 1e-12);
    for (std::size_t i = 0; i < per_mirror.size(); ++i)
        EXPECT_NEAR(per_mirror[i], causes.squared_error_per_mirror[i], 1e-5) << "mirror " << i + 1;
}

} // namespace
