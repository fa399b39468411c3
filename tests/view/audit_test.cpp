// Tests of the audit in the window: what the window shows, how an alarm changes the plan, and which
// files are refused.
#include "view/window.hpp"

#include <nlohmann/json.hpp>

namespace {

using namespace catoptric;
using namespace catoptric::view;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class ViewAuditTest : public test::ViewWindowTest {
protected:
    /// Writes a file of plans as `choose` writes it, with `limit` as the limit of FLIP. The last
    /// plan of the list is the chosen plan.
    std::string write_plan_file(double limit) const {
        json proofs = json::array();
        for (const char* plan : {"parallax:face=32", "reuse:face=32", "reuse:face=16"})
            proofs.push_back({{"technique", plan}, {"keeps_error", true}, {"keeps_time", true}});
        proofs.push_back({{"technique", "reuse:face=8"}, {"keeps_error", false}});
        const json plan{{"proofs", proofs},
                        {"certificate",
                         {{"quantity", "flip"},
                          {"max_error", limit},
                          {"share", .95},
                          {"confidence", .95},
                          {"reference", "raytrace:depth=16"}}}};
        write_input_file("plan.json", plan.dump());
        return path_in_test_folder("plan.json");
    }
    Words make_audit_command_words(double limit, const std::string& frames) const {
        return {"cornell-mirrors", "--audit", write_plan_file(limit),
                "--audit-every",   "1",       "--audit-percent",
                "1000000",         "--size",  "32x32",
                "--frames",        frames};
    }
};

TEST_F(ViewAuditTest, AlarmChangesThePlanUpToTheSurest) {
    Words words = make_audit_command_words(0, "120");
    words.emplace_back("--animate");
    std::vector<std::string> plans, said;
    SimulatedUser driver;
    driver.after = [&](const ViewReport& report) {
        const std::string plan = technique_text(report.state.plan);
        if (plans.empty() || plans.back() != plan) plans.push_back(plan);
        if (!report.state.said.empty() && (said.empty() || said.back() != report.state.said))
            said.push_back(report.state.said);
        EXPECT_THAT(report.command, Not(HasSubstr("audit")));
    };
    EXPECT_EQ(run_view_in_test(words, driver), 0);
    EXPECT_THAT(plans, testing::ElementsAre("reuse:face=16", "reuse:face=32", "parallax:face=32"));
    ASSERT_EQ(said.size(), 4u);
    EXPECT_EQ(said[0], "audit: 2 of 2 frames break flip <= 0; the plan is now reuse:face=32");
    EXPECT_EQ(said[1], "audit: 2 of 2 frames break flip <= 0");
    EXPECT_EQ(said[2], "audit: the plan is now parallax:face=32");
    EXPECT_EQ(said[3], "audit: 2 of 2 frames break flip <= 0; no surer plan is proved");
}

/// If the plan keeps its limit, it stays, and the audit changes no byte of the pictures.
TEST_F(ViewAuditTest, AuditedWindowShowsThePicturesOfRender) {
    Words words = make_audit_command_words(1, "40");
    words.insert(words.end(), {"--animate", "--screenshot", path_in_test_folder("a.exr")});
    EXPECT_EQ(run_view_in_test(words), 0);
    expect_same_as_rendered("a.exr", {"cornell-mirrors", "--technique", "reuse:face=16", "--size",
                                      "32x32", "--frames", "40", "--animate", "--warmup", "0"});
}

TEST_F(ViewAuditTest, StillSceneIsNotAudited) {
    std::string said;
    SimulatedUser driver;
    driver.after = [&](const ViewReport& report) { said += report.state.said; };
    EXPECT_EQ(run_view_in_test(make_audit_command_words(0, "60"), driver),
              0); // every audited frame would break
                  // the limit of 0
    EXPECT_EQ(said, "");
}

TEST_F(ViewAuditTest, InvalidPlansAreRefused) {
    const auto refused_file = [&](const json& plan, const std::string& text) {
        write_input_file("bad.json", plan.dump());
        expect_view_refused({"--audit", path_in_test_folder("bad.json"), "--frames", "1"},
                            Failure::bad_data, "bad.json: " + text);
    };
    Words both = make_audit_command_words(1, "1");
    both.insert(both.end(), {"--technique", "reuse"});
    expect_view_refused(both, Failure::usage, "wanted no --technique and no --plan beside it");
    expect_view_refused({"--audit", path_in_test_folder("none.json")}, Failure::missing_input,
                        "none.json");
    refused_file(json::array(),
                 "certificate: wanted the one that 'catoptric choose' writes, found nothing");
    json plan{{"certificate",
               {{"quantity", "flip"}, {"max_error", .1}, {"share", .95}, {"confidence", .95}}},
              {"proofs", {{{"technique", "reuse"}, {"keeps_error", true}, {"keeps_time", false}}}}};
    refused_file(plan, "proofs: wanted a plan that keeps the limits, found none");
    plan["proofs"][0]["keeps_time"] = true;
    plan["certificate"]["share"] = 1;
    refused_file(plan, "certificate.share: wanted a number from 0.5 to 0.9999, found 1");
    plan["certificate"]["share"] = .95, plan["certificate"].erase("max_error");
    refused_file(plan, "certificate.error_bound: wanted a number from 0 to 1, found nothing");
    plan["certificate"]["quantity"] = "mae";
    refused_file(plan, R"(certificate.quantity: wanted "flip" or "rmse", found "mae")");
    plan["proofs"][0]["technique"] = 1;
    refused_file(plan, "proofs[0].technique: wanted text, found number");
    Words rough = make_audit_command_words(1, "1");
    rough.front() = "cornell-rough";
    expect_view_refused(rough, Failure::usage, "audit: reference: wanted one with rays=N");
}

} // namespace
