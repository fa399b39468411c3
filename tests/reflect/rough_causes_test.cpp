// Tests of the split of an error by cause where mirrors are rough. The shares must add up to the
// unbiased squared error of the row, and the cause that a scene is built for must get its share.
#include "compare.hpp"
#include "measure/causes.hpp"
#include "measure/display.hpp"
#include "measure/halves.hpp"
#include "measure/masks.hpp"
#include "measure/picture_mean.hpp"
#include "study/causes.hpp"
#include "study/reference_cache.hpp"
#include "support/boxes.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"
#include "support/scenes.hpp"
#include "support/smooth_environment.hpp"

#include <iostream>

namespace {

using namespace catoptric;

/// Splits errors of rows of one scene, against a reference of two halves.
class RoughErrorSplitter {
public:
    explicit RoughErrorSplitter(const scene::Scene& scene, uvec2 size = {16, 16},
                                double exposure = 0)
        : base_(make_base(scene, size, exposure)), session_(test::get_test_engine(), scene) {
        constexpr int kFramesPerHalf = 8;
        measure::PictureMean means[2];
        for (int i = 0; i < 2 * kFramesPerHalf; ++i)
            means[i % 2].add(
                render(std::string(study::kRoughReference) + ",seed=" + std::to_string(i + 1), 0)
                    .hdr);
        halves_ = measure::make_halves(means[0].mean(), means[1].mean(), exposure);
        measure::PictureMean both;
        for (const measure::PictureMean& mean : means) both.add(mean.mean());
        truth_ = both.mean();
        hits_ = render("raytrace:depth=1", 0).hits;
    }

    /// Returns the causes of a row's error. Expects that they add up.
    report::Causes split(const std::string& technique) {
        session::Request request = base_;
        request.techniques = {technique};
        const report::Causes found =
            study::CauseFinder(session_, request, truth_, hits_, {}, &halves_).find(technique);
        std::cout << "[ MEASURED ] " << technique << ": " << found.squared_error;
        double sum = 0;
        for (const report::CauseShare& cause : found.list) {
            sum += cause.squared_error;
            std::cout << ", " << cause.name << " " << cause.squared_error;
        }
        std::cout << '\n';
        EXPECT_NEAR(sum, found.squared_error, 1e-12) << technique;
        return found;
    }

    /// Returns the unbiased squared error of a row over the mirrors, as the report gives it. A
    /// scene of one mirror needs few frames before it, because no capture shows a mirror.
    double unbiased_error(const std::string& technique, int warmup = kWarmup) {
        const measure::Picture found = measure::apply_exposure(render(technique, warmup).hdr,
                                                               base_.exposure);
        return measure::estimate_noise_free(found, halves_, measure::mask_mirrors(hits_),
                                            halves_.floor_map)
            .squared_error;
    }

private:
    static constexpr int kWarmup = 16; ///< frames before a picture in which mirrors show mirrors
    static session::Request make_base(const scene::Scene& scene, uvec2 size, double exposure) {
        session::Request base = test::make_test_request(scene, {}, size);
        base.warmup = kWarmup;
        base.exposure = exposure;
        return base;
    }
    session::TechniqueResult render(const std::string& technique, int warmup = kWarmup) {
        session::Request request = base_;
        request.techniques = {technique}, request.warmup = warmup;
        return std::move(session::run(session_, request).parts.front());
    }

    session::Request base_;
    session::Session session_;
    measure::NoisyHalves halves_;
    measure::Picture truth_;
    std::vector<std::uint32_t> hits_;
};

/// Bound of the noise of a sum over all mirror pixels of the small pictures.
constexpr double kMaxNoiseOfSum = 3e-4;

double part_of(const report::Causes& causes, const std::string& name) {
    const auto found = std::ranges::find(causes.list, name, &report::CauseShare::name);
    EXPECT_NE(found, causes.list.end()) << name;
    return found == causes.list.end() ? NAN : found->squared_error;
}

bool has_cause(const report::Causes& causes, const std::string& name) {
    return std::ranges::find(causes.list, name, &report::CauseShare::name) != causes.list.end();
}

scene::Scene make_rough_room(float roughness, int mirrors = 1) {
    scene::Scene scene = test::make_lit_room(mirrors, 1);
    test::make_mirrors_rough(scene, roughness);
    return scene;
}

/// Returns a metal floor below a smooth environment, which is infinitely far away. `slope` is the
/// angle of view above the floor, in degrees.
scene::Scene make_floor_below_sky(float roughness, double slope) {
    scene::Scene scene{.name = "floor"};
    scene.mirror_max_roughness = 1;
    const std::size_t metal = test::add_material(
        scene, {.name = "metal", .albedo = vec3(.9f), .metallic = 1, .roughness = roughness});
    test::add_quad(scene, "floor", metal, {-500, 0, 500}, {500, 0, 500}, {500, 0, -500},
                   {-500, 0, -500});
    scene.objects.back().mirror = true;
    scene.environment = test::make_smooth_environment();
    const double angle = glm::radians(slope);
    scene.cameras.push_back({.eye = {0, 6 * std::sin(angle), 6 * std::cos(angle)},
                             .target = {0, 0, 0},
                             .up = {0, 0, -1},
                             .vertical_fov_degrees = 8});
    return scene;
}

constexpr double kSkyExposure = -1; // the sky is up to 1.9 times as bright as white

TEST(RoughCauses, SharesAddUpToTheUnbiasedErrorOfTheRow) {
    RoughErrorSplitter splitter(make_rough_room(.3f, 2));
    for (const std::string technique :
         {"parallax:face=32,shadow_map=256,rough=mips", "hybrid:face=32,shadow_map=256",
          "naive:bounces=1,face=32", "secant:face=32,shadow_map=256,rough=rays,rays=2"}) {
        const report::Causes found = splitter.split(technique);
        EXPECT_NEAR(found.squared_error, splitter.unbiased_error(technique), 1e-9) << technique;
        EXPECT_LT(std::abs(part_of(found, "rest")), kMaxNoiseOfSum)
            << technique << ": a cause is missing";
        const bool is_filtered = technique.starts_with("parallax") ||
                                 technique.starts_with("hybrid");
        EXPECT_EQ(has_cause(found, "filter"), is_filtered) << technique;
        EXPECT_EQ(has_cause(found, "distance law"), is_filtered) << technique;
        EXPECT_EQ(has_cause(found, "lobe shape"), technique.find("rays") == std::string::npos)
            << technique;
    }
}

/// The filter, its width and its shape do not matter if light is the same everywhere, and the
/// look-up's weight is the albedo of the lobe.
TEST(RoughCauses, EqualLightFromEverywhereHasNoErrorOfTheLobe) {
    scene::Scene furnace = test::make_furnace_scene(1);
    test::make_mirrors_rough(furnace, .5f);
    RoughErrorSplitter splitter(furnace, {12, 12});
    for (const std::string technique : {"parallax:face=32", "reuse:face=16,rough=mips"}) {
        const report::Causes found = splitter.split(technique);
        for (const char* cause : {"noise", "filter", "distance law", "lobe shape"})
            // With the weight of the lobe's mean cosine left out, the error would be .015.
            EXPECT_LT(std::abs(part_of(found, cause)), 1.5e-3) << technique << ", " << cause;
    }
}

TEST(RoughCauses, SkyHasNoErrorOfTheDistanceLaw) {
    RoughErrorSplitter splitter(make_floor_below_sky(.4f, 30), {12, 12}, kSkyExposure);
    const report::Causes found = splitter.split("parallax:face=128");
    EXPECT_LT(std::abs(part_of(found, "distance law")), .02 * found.squared_error);
}

TEST(RoughCauses, LobeShapeErrsAtGrazingAngles) {
    const auto split = [](double slope) {
        return RoughErrorSplitter(make_floor_below_sky(.4f, slope), {12, 12}, kSkyExposure)
            .split("reuse:face=128");
    };
    const report::Causes above = split(89.9), grazing = split(12);
    EXPECT_GT(part_of(grazing, "lobe shape"), 20 * std::abs(part_of(above, "lobe shape")));
    EXPECT_GT(part_of(grazing, "lobe shape"), .8 * grazing.squared_error);
}

/// In a view from above of a smooth sky, filter and texels are all that coarse captures have worse.
TEST(RoughCauses, FilterIsTheDifferenceBetweenCoarseAndFineLevels) {
    RoughErrorSplitter splitter(make_floor_below_sky(.3f, 89.9), {12, 12}, kSkyExposure);
    const report::Causes coarse = splitter.split("reuse:face=16,taps=4");
    const double gone = coarse.squared_error -
                        splitter.unbiased_error("reuse:face=256,taps=1024", 2);
    std::cout << "[ MEASURED ] less error with fine levels: " << gone << '\n';
    EXPECT_GT(gone, .8 * coarse.squared_error) << "little to see";
    EXPECT_NEAR(part_of(coarse, "filter") + part_of(coarse, "texels"), gone,
                .1 * coarse.squared_error);
    EXPECT_GT(part_of(coarse, "filter"), .7 * coarse.squared_error);
}

/// The existing knob rough=rays removes the three causes at once.
TEST(RoughCauses, FilterLawAndShapeAreTheDifferenceToManySearches) {
    scene::Scene box = test::make_coloured_box({});
    test::make_mirrors_rough(box, .4f);
    RoughErrorSplitter splitter(box, {12, 12});
    const report::Causes found = splitter.split("parallax:face=16,law=none,rough=mips");
    const double gone = found.squared_error -
                        splitter.unbiased_error("parallax:face=16,rough=rays,rays=1024", 2);
    std::cout << "[ MEASURED ] less error with 1024 searches: " << gone << '\n';
    EXPECT_GT(gone, .5 * found.squared_error) << "little to see";
    EXPECT_NEAR(part_of(found, "filter") + part_of(found, "distance law") +
                    part_of(found, "lobe shape"),
                gone, .1 * found.squared_error + kMaxNoiseOfSum);
}

TEST(RoughCauses, NoiseFallsWithTheNumberOfRays) {
    RoughErrorSplitter splitter(make_floor_below_sky(.5f, 30), {12, 12}, kSkyExposure);
    const report::Causes one = splitter.split("parallax:face=64,rough=rays,rays=1"),
                         many = splitter.split("parallax:face=64,rough=rays,rays=16");
    const double ratio = part_of(one, "noise") / part_of(many, "noise");
    std::cout << "[ MEASURED ] noise of 1 ray / noise of 16: " << ratio << '\n';
    EXPECT_GT(ratio, 12); // 16 for independent rays; those of a pixel are stratified
    EXPECT_GT(part_of(one, "noise"), .9 * one.squared_error);
    for (const char* cause : {"direction", "texels", "rest"})
        EXPECT_NEAR(part_of(one, cause), part_of(many, cause), 1e-12) << cause;
}

TEST(RoughCauses, SplitIsAFunctionOfTheSeed) {
    RoughErrorSplitter splitter(make_rough_room(.3f), {16, 16});
    const report::Causes first = splitter.split("hybrid:face=16"),
                         again = splitter.split("hybrid:face=16");
    for (std::size_t i = 0; i < first.list.size(); ++i)
        EXPECT_EQ(first.list[i].squared_error, again.list[i].squared_error) << first.list[i].name;
    EXPECT_GT(std::abs(part_of(first, "distance law")), .5 * first.squared_error) << "near walls";
}

TEST(RoughCauses, CoatedRoughMirrorsAndOtherReferencesAreRefused) {
    study::CompareRequest request;
    request.base = test::make_test_request(make_rough_room(.3f), {"reuse:face=16"}, {8, 8});
    request.studies = {{.name = "causes"}};
    request.reference = study::kReference;
    test::expect_error([&] { study::compare(test::get_test_engine(), request); }, Failure::usage,
                       {"--causes: wanted the default reference of this scene, "
                        "raytrace:depth=16,rays=64, found 'raytrace:depth=16'"});
    request.reference.clear();
    for (scene::Material& material : request.base.scene.materials)
        if (material.metallic == 1) material.clearcoat = .5f;
    test::expect_error(
        [&] { study::compare(test::get_test_engine(), request); }, Failure::usage,
        {"--causes: wanted rough mirrors without glass or clear coat, found mirror"});
}

} // namespace
