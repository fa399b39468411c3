// Tests of `render_hybrid_with_lookups`, which traces only the pixels that its search cannot
// answer. The traced pixels must equal ray tracing, and their number must be reported.
#include "scene/built_in.hpp"
#include "support/searches.hpp"

namespace {

using namespace catoptric;

constexpr uvec2 kHybridPictureSize{512, 512};
/// State of a lookup whose search answers unknown. The fourth channel of a lookup holds 1 + state +
/// 4 layer + 8 mirror, and 0 outside mirrors.
constexpr std::uint32_t kUnknownLookupState = 1;

/// Renders one frame and records where mirrors looked.
session::TechniqueResult render_hybrid_with_lookups(const scene::Scene& scene,
                                                    const std::string& technique, uvec2 size) {
    session::Request request = test::make_test_request(scene, {technique}, size);
    request.with_lookup = true;
    return std::move(session::run(test::get_test_engine(), request).parts.front());
}

struct CountedLookups {
    std::size_t mirror = 0, unknown = 0;
};
CountedLookups count_lookups(const std::vector<vec4>& lookup) {
    CountedLookups counted;
    for (const vec4& pixel : lookup) {
        const auto code = static_cast<std::uint32_t>(pixel.w);
        counted.mirror += code != 0;
        counted.unknown += code != 0 && code % 4 == 1 + kUnknownLookupState;
    }
    return counted;
}

/// Expects that the number of traced pixels equals the number of pixels that the search calls
/// unknown, or of all mirror pixels with `every_mirror`.
void expect_traced_pixel_count(const session::TechniqueResult& part, bool every_mirror) {
    ASSERT_TRUE(part.rays.has_value());
    const CountedLookups counted = count_lookups(part.lookup);
    const std::size_t wanted = every_mirror ? counted.mirror : counted.unknown;
    if (every_mirror)
        EXPECT_LE(part.rays->primary, wanted / 100 + 5)
            << part.label << ": traced pixels start at the triangle that the view drew";
    else
        EXPECT_EQ(part.rays->primary, wanted) << part.label;
    EXPECT_EQ(part.traced_fraction.has_value(), counted.mirror > 0) << part.label;
    const double share = counted.mirror > 0
                             ? static_cast<double>(wanted) / static_cast<double>(counted.mirror)
                             : 0;
    EXPECT_DOUBLE_EQ(part.traced_fraction.value_or(0), share) << part.label;
}

/// Expects that `render_hybrid_with_lookups`, forced to call every pixel unknown, renders the same
/// bytes as ray tracing wherever both see a mirror.
void expect_forced_hybrid_is_traced(const scene::Scene& scene, const std::string& settings,
                                    const std::string& reference, uvec2 size) {
    const session::TechniqueResult traced = test::render_technique(scene, reference, size);
    const session::TechniqueResult part = render_hybrid_with_lookups(
        scene, "hybrid:force=unknown" + settings, size);
    expect_traced_pixel_count(part, true);
    const measure::Mask mirrors = measure::mask_mirrors(traced.hits);
    std::size_t both = 0, one = 0, different = 0;
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const bool here = part.lookup[i].w != 0, there = mirrors[i];
        both += here && there, one += here != there;
        different += here && there &&
                     std::memcmp(&part.hdr.pixels[i], &traced.hdr.pixels[i], sizeof(vec3)) != 0;
    }
    std::cout << "[ MEASURED ] " << part.label << ", " << scene.name << ": " << different << " of "
              << both << " mirror pixels differ, " << one << " are a mirror to one of the two\n";
    EXPECT_GT(both, 0u);
    EXPECT_EQ(different, 0u);
    EXPECT_LE(static_cast<double>(one), .001 * static_cast<double>(both));
}

TEST(Hybrid, AllUnknownEqualsRayTracing) {
    expect_forced_hybrid_is_traced(scene::make_cornell(), ",face=64", "raytrace:depth=16",
                                   kHybridPictureSize);
    expect_forced_hybrid_is_traced(scene::make_cornell(), ",face=64,shadow=none",
                                   "raytrace:depth=16,shadow=none", kHybridPictureSize);
    expect_forced_hybrid_is_traced(test::make_lit_room(3, 2), ",face=32", "raytrace:depth=16",
                                   kHybridPictureSize);
}

TEST(Hybrid, LookupsAreReturnedOnlyIfTheyAreAskedFor) {
    const session::TechniqueResult part = test::render_technique(scene::make_cornell(),
                                                                 "hybrid:face=32", {32, 32});
    EXPECT_TRUE(part.lookup.empty());
}

/// Returns a scene whose pictures show only a mirror.
scene::Scene make_close_mirror() {
    scene::Scene close = test::make_lit_room(1, 1);
    close.cameras = {{.name = "close",
                      .eye = {-.9, -1.2, -.9},
                      .target = {-.9, -1.2, .3},
                      .vertical_fov_degrees = 50}};
    return close;
}

TEST(Hybrid, PictureOfOneRowIsTracedAsWell) {
    expect_forced_hybrid_is_traced(make_close_mirror(), ",face=32", "raytrace:depth=16", {9, 1});
}

TEST(Hybrid, MoreWorkGroupsThanOneDimensionAllows) {
    expect_forced_hybrid_is_traced(make_close_mirror(), ",face=32", "raytrace:depth=16",
                                   // All pixels are mirror. They need 66049 work groups, and one
                                   // dimension allows 65535.
                                   {2056, 2056});
}

TEST(Hybrid, ExactlyTheUnknownPixelsAreTraced) {
    for (const uvec2 size : {uvec2{1, 1}, uvec2{33, 17}, uvec2{200, 177}})
        for (const std::string force : {"search", "unknown"})
            expect_traced_pixel_count(render_hybrid_with_lookups(scene::make_cornell(),
                                                                 "hybrid:face=32,force=" + force,
                                                                 size),
                                      force == "unknown");
}

TEST(Hybrid, OnlyTracedPixelsDifferFromTheSearch) {
    constexpr uvec2 kOddPictureSize{201, 177};
    const scene::Scene scene = scene::make_cornell();
    const measure::Picture searched =
        test::render_technique(scene, "pyramid:face=64,captures=all", kOddPictureSize).hdr;
    const measure::Picture traced =
        test::render_technique(scene, "raytrace:depth=16", kOddPictureSize).hdr;
    const session::TechniqueResult part = render_hybrid_with_lookups(scene, "hybrid:face=64",
                                                                     kOddPictureSize);
    ASSERT_GT(count_lookups(part.lookup).unknown, 64u) << "more than one work group";
    for (std::size_t i = 0; i < part.lookup.size(); ++i) {
        const auto code = static_cast<std::uint32_t>(part.lookup[i].w);
        const vec3 wanted =
            (code != 0 && code % 4 == 1 + kUnknownLookupState ? traced : searched).pixels[i];
        ASSERT_EQ(part.hdr.pixels[i], wanted) << "pixel " << i;
    }
}

TEST(Hybrid, EmptyListOfPixelsTracesNothing) {
    const session::TechniqueResult one = render_hybrid_with_lookups(
        test::make_furnace_scene(1), "hybrid:face=32",
        {48, 48}); // no object hides another, so no pixel is unknown
    EXPECT_EQ(one.rays->primary, 0u);
    EXPECT_EQ(one.traced_fraction, 0.0);
    scene::Scene away = test::make_furnace_scene(1);
    std::swap(away.cameras.front().eye.z, away.cameras.front().target.z);
    away.cameras.front().eye.z = 4.5, away.cameras.front().target.z = 9;
    const session::TechniqueResult none = render_hybrid_with_lookups(
        away, "hybrid:face=32,force=unknown", {48, 48});
    EXPECT_EQ(none.rays->primary, 0u);
    EXPECT_FALSE(none.traced_fraction.has_value()) << "of no mirror pixels at all";
}

} // namespace
