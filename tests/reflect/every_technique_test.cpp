// Tests of the properties that every technique must have. A new technique is tested as soon as it
// is registered.
#include "core/knob.hpp"
#include "places.hpp"
#include "reflect/plan.hpp"
#include "scene/built_in.hpp"
#include "session/access.hpp"
#include "session/technique_choice.hpp"
#include "support/rendering.hpp"

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <regex>

namespace {

using namespace catoptric;

constexpr uvec2 kEveryTechniquePictureSize{48, 48};

class EveryTechniqueTest : public testing::TestWithParam<session::TechniqueInfo> {
protected:
    /// Returns the technique with small captures and small shadow maps, if it has these knobs, and
    /// with `settings`.
    std::string technique_with_small_captures(
        std::vector<std::pair<std::string, std::string>> settings = {}) const {
        for (const auto& cheap :
             std::vector<std::pair<std::string, std::string>>{{"face", "32"}, {"shadow_map", "64"}})
            if (std::ranges::find(settings, cheap.first,
                                  &std::pair<std::string, std::string>::first) == settings.end())
                settings.push_back(cheap);
        return test::technique_with_knobs(GetParam(), settings);
    }
};
INSTANTIATE_TEST_SUITE_P(Table, EveryTechniqueTest, testing::ValuesIn(session::techniques()),
                         [](const auto& instance) { return instance.param.name; });

/// Relative error allowed in pictures of a furnace, a box that emits the same light everywhere. Its
/// colours are exact in binary16, and the weights of a texture filter add up to 1 within one
/// rounding.
constexpr float kFurnaceTolerance = 0x1p-10f;

TEST_P(EveryTechniqueTest, MirrorInAFurnaceShowsTheFurnace) {
    const measure::Picture picture = test::render_technique(test::make_furnace_scene(1),
                                                            technique_with_small_captures(),
                                                            kEveryTechniquePictureSize, 3)
                                         .hdr;
    for (const vec3& pixel : picture.pixels)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(pixel[c], test::kFurnaceWallRadiance[c],
                        kFurnaceTolerance * test::kFurnaceWallRadiance[c]);
}

/// Returns the share of pixels that are darker than the furnace. Fails if a pixel is brighter than
/// 1.002 times the furnace.
double dark_pixel_share(const measure::Picture& picture, const std::string& what) {
    std::size_t dark = 0, bright = 0;
    for (const vec3& pixel : picture.pixels) {
        dark += !glm::all(
            glm::greaterThanEqual(pixel, test::kFurnaceWallRadiance * (1 - kFurnaceTolerance)));
        bright += !glm::all(glm::lessThanEqual(pixel, test::kFurnaceWallRadiance * 1.002f));
    }
    EXPECT_EQ(bright, 0u) << what;
    return static_cast<double>(dark) / static_cast<double>(picture.pixels.size());
}

TEST_P(EveryTechniqueTest, MirrorsInAFurnaceGrowNoDarkerWithFramesOrBounces) {
    session::Request request = test::make_test_request(test::make_furnace_scene(2), {},
                                                       kEveryTechniquePictureSize);
    request.ambient = 0;
    session::Session session(test::get_test_engine(), request.scene);
    /// Renders the next frame of the session.
    const auto render = [&](const std::string& technique) {
        request.techniques = {technique};
        return session.frame(request).hdr();
    };
    const auto expect_falling_share = [&](const std::string& name,
                                          const std::function<measure::Picture(int)>& picture_at) {
        double last = 1;
        for (int i = 0; i <= 4; ++i) {
            const std::string what = GetParam().name + " at " + name + " " + std::to_string(i);
            const double share = dark_pixel_share(picture_at(i), what);
            EXPECT_LE(share, last) << what;
            last = share;
        }
        EXPECT_LT(last, .1) << GetParam().name << ": most of the picture is box";
    };
    expect_falling_share("frame", [&](int) { return render(technique_with_small_captures()); });
    for (const std::string knob : {"bounces", "depth"})
        if (std::ranges::find(GetParam().knobs, knob, &session::KnobInfo::name) !=
            GetParam().knobs.end())
            expect_falling_share(knob, [&](int i) {
                session.forget();
                return render(technique_with_small_captures({{knob, std::to_string(i)}}));
            });
}

TEST_P(EveryTechniqueTest, SceneIsRenderedAsOftenAsTheTechniqueDeclares) {
    for (const auto& [mirrors, lights] : {std::pair{0, 1}, {1, 0}, {1, 1}, {2, 3}, {3, 1}}) {
        session::Request asked = test::make_test_request(test::make_lit_room(mirrors, lights), {},
                                                         {16, 16});
        session::Session session(test::get_test_engine(), asked.scene);
        for (const session::KnobInfo& knob : GetParam().knobs) {
            // Test each choice of a knob, and a number between its limits, because the number of
            // scene passes may depend on any of them.
            std::vector<std::string> values = knob.choices;
            if (values.empty() &&
                (knob.name == "bounces" || knob.name == "depth" || knob.name == "continue"))
                values = {"0", "2"};
            if (values.empty()) values = {knob.value};
            for (const std::string& value : values) {
                if (knob.name == "samples" || (knob.name == "face" && value == knob.value))
                    continue;
                if (value == "float" && !test::has_float_colour()) continue;
                const std::string text = technique_with_small_captures(
                    {{knob.name, knob.name == "shadow_map" ? "64" : value}});
                // The techniques of some mirrors are left to another technique, so the test asks
                // which technique draws balls.
                const std::size_t balls = static_cast<std::size_t>(mirrors);
                const reflect::TechniqueChoice choice =
                    reflect::replace_unfit(
                        reflect::assign_techniques(reflect::parse_plan(text),
                                                   std::vector<std::string>(balls, "ball")),
                        std::vector<scene::FlatFaces>(balls), 0)
                        .choices.front();
                asked.techniques = {text};
                const auto plan = nlohmann::json::parse(
                    session::Access::format_plan(session, asked, session::PlanFormat::json));
                EXPECT_EQ(plan.at("scene_passes"),
                          choice.technique->scene_passes(mirrors, lights, choice.settings))
                    << text << " with " << mirrors << " mirrors and " << lights << " lights";
            }
        }
    }
}

/// Returns the lowest and highest value of a knob, or smaller ones if these would take too much
/// memory or time.
std::vector<std::string> list_extreme_knob_values(const session::KnobInfo& knob) {
    if (!knob.choices.empty()) return knob.choices;
    double high = knob.high;
    // A face or shadow map of 16384 texels an edge would take gigabytes of memory.
    if (knob.name == "face" || knob.name == "shadow_map") high = 64;
    if (knob.name == "samples" || knob.name == "rays") high = 16; // 65536 would take minutes
    const auto text = [](double value) {
        const bool whole = value == std::floor(value);
        return whole ? std::to_string(static_cast<long long>(value)) : std::to_string(value);
    };
    std::vector<std::string> values{text(knob.low), text(high)};
    if (!knob.special.empty()) values.push_back(knob.special);
    return values;
}

TEST_P(EveryTechniqueTest, PixelsAreFiniteAndNotNegativeAtTheLimitsOfEachKnob) {
    const scene::Scene room = test::make_lit_room(2, 1);
    for (const session::KnobInfo& knob : GetParam().knobs)
        for (const std::string& value : list_extreme_knob_values(knob)) {
            if (value == "float" && !test::has_float_colour()) continue;
            std::vector<std::pair<std::string, std::string>> settings{{knob.name, value}};
            if (knob.name == "range")
                // `range` has an effect only on unorm8 distances.
                settings.push_back({"distance", "unorm8"});
            const std::string text = technique_with_small_captures(settings);
            const session::TechniqueResult part = test::render_technique(room, text, {32, 24}, 3);
            EXPECT_EQ(test::count_nonfinite(part.hdr), 0u) << text;
            EXPECT_EQ(
                std::ranges::count_if(part.hdr.pixels,
                                      [](const vec3& c) { return c.x < 0 || c.y < 0 || c.z < 0; }),
                0)
                << text;
        }
}

TEST_P(EveryTechniqueTest, TwoRunsRenderTheSameBytes) {
    session::Request request = test::make_test_request(
        scene::make_cornell(), {technique_with_small_captures()}, kEveryTechniquePictureSize);
    for (const bool animate : {false, true}) {
        request.animate = animate;
        request.frames = 3;
        const session::TechniqueResult first = std::move(
            session::run(test::get_test_engine(), request).parts.front());
        const session::TechniqueResult second = std::move(
            session::run(test::get_test_engine(), request).parts.front());
        EXPECT_TRUE(test::have_equal_pixel_bytes(first.hdr, second.hdr));
        EXPECT_TRUE(test::have_equal_pixel_bytes(first.display, second.display));
        EXPECT_EQ(first.hits, second.hits);
    }
}

/// A technique without history must render its best picture in the first frame. With history,
/// mirrors seen in mirrors start black.
TEST_P(EveryTechniqueTest, SecondFrameDiffersExactlyIfTheTechniqueHasHistory) {
    const std::string text = technique_with_small_captures({{"continue", "0"}});
    const session::TechniqueResult first = test::render_technique(test::make_lit_room(3, 1), text,
                                                                  kEveryTechniquePictureSize),
                                   second = test::render_technique(test::make_lit_room(3, 1), text,
                                                                   kEveryTechniquePictureSize, 2);
    EXPECT_EQ(first.remembers, second.remembers);
    const bool is_equal = test::have_equal_pixel_bytes(first.hdr, second.hdr);
    // A mean over frames is that of the first frame where frames do not differ.
    if (session::parse_technique(text).traits().noise == TechniqueTraits::Noise::history)
        EXPECT_TRUE(first.remembers);
    else
        EXPECT_EQ(is_equal, !first.remembers);
}

TEST_P(EveryTechniqueTest, EachPlannedPassHasOneTime) {
    session::Request request = test::make_test_request(
        test::make_lit_room(2, 2), {technique_with_small_captures()}, kEveryTechniquePictureSize);
    request.frames = 3;
    session::Session session(test::get_test_engine(), request.scene);
    const auto plan = nlohmann::json::parse(
        session::Access::format_plan(session, request, session::PlanFormat::json));
    for (const session::FrameTimes& frame : session::run(test::get_test_engine(), request).frames) {
        ASSERT_EQ(frame.passes.size(), plan["passes"].size());
        double time = 0;
        for (std::size_t i = 0; i < frame.passes.size(); ++i) {
            const session::PassTime& pass = frame.passes[i];
            EXPECT_EQ(pass.name, plan["passes"][i]["name"]);
            EXPECT_EQ(pass.begin_ms, time) << pass.name << " begins where the one before it ended";
            EXPECT_GE(pass.end_ms, pass.begin_ms) << pass.name;
            time = pass.end_ms;
        }
        EXPECT_EQ(time, frame.gpu_ms);
    }
}

TEST_P(EveryTechniqueTest, ScenesWithoutMirrorsOrLightsAreRendered) {
    for (const auto& [mirrors, lights] : {std::pair{0, 1}, {2, 0}, {0, 0}}) {
        const session::TechniqueResult part = test::render_technique(
            test::make_lit_room(mirrors, lights), technique_with_small_captures(), {24, 24}, 2);
        EXPECT_EQ(test::count_nonfinite(part.hdr), 0u);
        EXPECT_GT(measure::mean_of(part.hdr, measure::ValueRange::unclamped).all, 0.0)
            << "ambient light is left";
    }
}

TEST(Table, EveryTechniqueInTheSourceFolderIsRegistered) {
    std::size_t rows = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(test::source_folder() / "engine/reflect")) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream file(entry.path());
        const std::string text{std::istreambuf_iterator<char>(file), {}};
        const std::regex row(R"((^|\n)const RegisteredTechnique \w+\{)");
        rows += static_cast<std::size_t>(
            std::distance(std::sregex_iterator(text.begin(), text.end(), row), {}));
    }
    const auto techniques = session::techniques(); // with those of tests, whose order is above 1000
    EXPECT_EQ(
        std::ranges::count_if(reflect::techniques(),
                              [](const reflect::Technique* row) { return row->order < 1000; }),
        static_cast<std::ptrdiff_t>(rows));
    EXPECT_GE(techniques.size(), rows);
    EXPECT_GE(rows, 4u);
}

} // namespace
