// Tests of the controls that edit a plan. A simulated mouse clicks everywhere in the panel, without
// a window or a device.
#include "core/error.hpp"
#include "core/file.hpp"
#include "import/load.hpp"
#include "session/technique_choice.hpp"
#include "support/folder.hpp"
#include "view/panels.hpp"

#include <gmock/gmock.h>
#include <imgui.h>

#include <functional>
#include <set>

namespace {

using namespace catoptric;
using namespace catoptric::view;
using testing::Contains;
using testing::Each;
using testing::Not;
using testing::StartsWith;

constexpr float kWidth = 360, kHeight = 700; // of the panel, pixels

/// A Dear ImGui context that draws one panel without a window.
class PanelWithoutWindow {
public:
    explicit PanelWithoutWindow(const scene::Scene& scene, ImFontAtlas& fonts)
        : shown_scene_(scene), context_(ImGui::CreateContext(&fonts)) {
        ImGui::SetCurrentContext(context_);
        ImGuiIO& io = ImGui::GetIO();
        io.IniFilename = nullptr;
        io.DisplaySize = {kWidth, kHeight};
        io.DeltaTime = 1; // seconds, so that no click is a double click
    }
    ~PanelWithoutWindow() { ImGui::DestroyContext(context_); }
    PanelWithoutWindow(const PanelWithoutWindow&) = delete;
    PanelWithoutWindow& operator=(const PanelWithoutWindow&) = delete;

    void click_panel(ViewState& state, float x, float y) {
        for (const bool down : {false, true, false, false}) {
            ImGui::GetIO().MousePos = {x, y};
            ImGui::GetIO().MouseDown[0] = down;
            ImGui::NewFrame();
            ImGui::SetNextWindowPos({0, 0});
            ImGui::SetNextWindowSize({kWidth, kHeight});
            ImGui::Begin("panel", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
            draw_plan_controls(state, shown_scene_, {});
            ImGui::End();
            ImGui::Render();
        }
    }

    /// Returns the text of the scene's facts, with all lists open.
    std::string read_scene_facts(const std::filesystem::path& folder) {
        const std::string file = (folder / "facts.txt").string();
        PanelRequests requests;
        ImGui::NewFrame();
        ImGui::Begin("facts");
        ImGui::LogToFile(2, file.c_str());
        draw_scene_facts(shown_scene_, requests);
        ImGui::LogFinish();
        ImGui::End();
        ImGui::Render();
        return read_file(file);
    }

private:
    const scene::Scene& shown_scene_;
    ImGuiContext* context_;
};

class ViewPanelTest : public test::InFolder {
protected:
    ViewPanelTest() {
        unsigned char* texels = nullptr;
        int width = 0, height = 0;
        fonts.GetTexDataAsAlpha8(&texels, &width, &height);
    }

    /// Returns the plans that a click leads to, for clicks all over the panel. A second click below
    /// the first one may choose from a list that the first click opened.
    std::set<std::string>
    list_plans_reached_by_click(const ViewState& from,
                                const std::function<EditedPlan(const ViewState&)>& plan) {
        std::set<std::string> texts;
        for (const float x : {30.f, 220.f, 250.f, 284.f})
            for (float y = 6; y < kHeight; y += 8) {
                ViewState state = from;
                PanelWithoutWindow panel(scene, fonts);
                panel.click_panel(state, x, y);
                texts.insert(technique_text(plan(state)));
                panel.click_panel(state, 60, y + 44);
                texts.insert(technique_text(plan(state)));
                EXPECT_LE(state.chosen, 4u);
            }
        for (const std::string& text : texts)
            EXPECT_NO_THROW(static_cast<void>(session::parse_technique(text))) << text;
        return texts;
    }
    static EditedPlan plan_of_view_state(const ViewState& state) { return state.plan; }

    scene::Scene scene = scene::load("cornell-mirrors", {});
    ImFontAtlas fonts;
};

TEST_F(ViewPanelTest, ControlsChangeTheKnobsOfAllMirrors) {
    ViewState state;
    state.plan = parse_plan("secant");
    const std::set<std::string> texts = list_plans_reached_by_click(state, plan_of_view_state);
    for (const char* text : {"secant:face=128", "secant:face=512", "secant:face=auto",
                             "secant:shadow_map=512", "secant:distance=r16f"})
        EXPECT_THAT(texts, Contains(text));
    EXPECT_THAT(texts, Contains(StartsWith("secant:steps=")));
    EXPECT_THAT(texts, Contains(Not(StartsWith("secant")))) << "another technique";
    EXPECT_THAT(texts, Each(Not(testing::HasSubstr(" ")))) << "for all mirrors";
}

TEST_F(ViewPanelTest, ControlsChangeTheKnobsOfTheChosenMirror) {
    ViewState state;
    state.plan = parse_plan("secant:face=64");
    state.chosen = 2;
    std::set<std::string> texts = list_plans_reached_by_click(state, plan_of_view_state);
    texts.erase("secant:face=64"); // the plan after a click beside all controls
    EXPECT_THAT(texts, Contains("2=secant:face=128 *=secant:face=64"));
    EXPECT_THAT(texts, Contains("2=secant:face=auto *=secant:face=64"));
    EXPECT_THAT(texts, Each(testing::EndsWith(" *=secant:face=64")));
    state.plan.own[2] = {"reuse", {}};
    EXPECT_THAT(list_plans_reached_by_click(state, plan_of_view_state), Contains("secant:face=64"))
        << "as all others";
}

TEST_F(ViewPanelTest, ControlsEditTheChosenOneOfTwoPlans) {
    ViewState state;
    state.mode = ViewMode::split;
    state.plan = parse_plan("secant"), state.other = parse_plan("parallax");
    state.edits_other = true;
    EXPECT_THAT(list_plans_reached_by_click(state, [](const ViewState& s) { return s.other; }),
                Contains("parallax:face=512"));
    const std::set<std::string> texts = list_plans_reached_by_click(
        state, [](const ViewState& s) { return s.edits_other ? s.plan : ViewState().plan; });
    EXPECT_THAT(texts, Each(technique_text(parse_plan("secant"))));
}

TEST_F(ViewPanelTest, FactsOfTheSceneListMirrorsAndCameras) {
    scene.objects.back().sphere.reset();
    const std::size_t number = scene::mirrors(scene).size();
    ASSERT_EQ(scene::mirrors(scene).back(), scene.objects.size() - 1);
    const std::string facts = PanelWithoutWindow(scene, fonts).read_scene_facts(folder);
    EXPECT_THAT(facts, testing::HasSubstr(std::to_string(scene.objects.size()) + " objects, "));
    EXPECT_THAT(facts, testing::HasSubstr("mirror 1: ball1, a sphere\n"));
    EXPECT_THAT(facts, testing::HasSubstr("mirror " + std::to_string(number) + ": " +
                                          scene.objects.back().name + "\n"));
    EXPECT_THAT(facts, testing::HasSubstr("0 " + scene.cameras[0].name));
}

} // namespace
