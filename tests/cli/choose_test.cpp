// Tests of `catoptric choose`. Its certificate is checked by a comparison in the same views.
#include "cli/program.hpp"

#include <algorithm>
#include <cmath>
#include <csignal>

namespace {

using nlohmann::json;
using testing::HasSubstr;

class Choose : public CommandLineTest {
protected:
    /// Runs `choose` on a scene of flat mirrors. A plan is proved on 6 views, which prove that a
    /// share of .5 of all views keeps the limit.
    test::ProcessResult run_choose(const Words& more) const {
        Words words{"choose", "flat", "--size", "32x32", "--frames", "6", "--warmup", "1"};
        words.insert(words.end(), more.begin(), more.end());
        for (const char* word : {"--share", ".5", "--confidence", ".9", "--training-views", "6"})
            words.emplace_back(word);
        return run_cli(words);
    }
    test::ProcessResult choose_between_two_techniques(const Words& more) const {
        Words words{"-o", "plan.json"};
        words.insert(words.end(), more.begin(), more.end());
        for (const char* word : {"--techniques", "reuse:face=16", "raytrace:depth=4"})
            words.emplace_back(word);
        return run_choose(words);
    }
    json read_plan() const { return json::parse(read_file_at_path(folder / "plan.json")); }

    /// Returns the FLIP over the mirrors in each view drawn from `seed`, for the plan in the file.
    std::vector<double> measure_plan_errors(int views, int seed) const {
        const test::ProcessResult ended = run_cli(
            {"compare", "flat", "--size", "32x32", "--frames", "6", "--warmup", "1", "--views",
             std::to_string(views), "--seed", std::to_string(seed), "-o", "out", "--techniques",
             "plan:plan.json"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return json::parse(read_file_at_path(
            folder / "out/report.json"))["rows"][0]["views"]["error"]["flip"]["values"];
    }
};

TEST_F(Choose, CertificateIsWhatAComparisonInTheSameViewsFinds) {
    const test::ProcessResult ended = choose_between_two_techniques({"--max-flip", "0.5"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    EXPECT_THAT(ended.out, HasSubstr("chosen: "));
    const json plan = read_plan(), &certificate = plan["certificate"];
    EXPECT_EQ(plan["schema"], "catoptric/plan/1");
    ASSERT_EQ(certificate["views"], 6); // at least 4 views prove a share of .5 with confidence .9;
                                        // 6 is the least accepted number
    const std::vector<double> errors = measure_plan_errors(6, certificate["proof_seed"]);
    const auto failures = std::ranges::count_if(errors, [](double error) { return error > .5; });
    EXPECT_EQ(certificate["failures"], failures);
    EXPECT_THAT(ended.out, HasSubstr("; at least 50 % of views have flip <= 0.5, with 90 % "
                                     "confidence (6 views of 32x32, " +
                                     std::to_string(failures) + " failures)"));
    EXPECT_NEAR(certificate["share_bound"], std::pow(.1, 1.0 / 6), 1e-9);
    // If the error bound were the second largest of six errors, its confidence would be too small:
    // P(Binomial(6, .5) <= 1) = 7/64 > .1. The bound is therefore the largest error.
    EXPECT_NEAR(certificate["error_bound"], std::ranges::max(errors), 1e-6);
    // A report with a plan of `choose` quotes the plan's certificate, and states if the certificate
    // is for another scene.
    const std::string statement =
        "at least 50 % of views have flip <= 0.5, with 90 % confidence (6 "
        "views, " +
        std::to_string(failures) + " failures), at 32x32";
    const json quoted = json::parse(
        read_output_file("out/report.json"))["rows"][0]["certificate"][0];
    EXPECT_EQ(quoted, (json{{"statement", statement}, {"of_this_scene", true}}));
    EXPECT_THAT(read_output_file("out/report.html"),
                HasSubstr("plan:plan.json was chosen: at least 50 % of views have flip &lt;= 0.5"));
    ASSERT_EQ(
        run_cli(add_small_frame_options({"compare", "-o", "out", "--techniques", "plan:plan.json"}))
            .exit_code,
        0);
    EXPECT_THAT(read_output_file("out/report.html"),
                HasSubstr("plan:plan.json was chosen for another scene: at least 50 %"));
    // Plans are proved from the slowest to the fastest.
    const json& proofs = plan["proofs"];
    for (std::size_t i = 0; i + 1 < proofs.size(); ++i)
        EXPECT_GE(proofs[i]["ms"], proofs[i + 1]["ms"]);
    EXPECT_EQ(run_cli({"render", "flat", "--size", "32x32", "--plan", "plan.json", "-o", "x.png"})
                  .exit_code,
              0);
}

TEST_F(Choose, NearestPlanIsWrittenWithWhatItProvesIfNoPlanKeepsTheLimit) {
    const test::ProcessResult none = run_choose(
        {"-o", "plan.json", "--max-error", "flip=0", "--techniques", "reuse:face=16"});
    EXPECT_EQ(none.exit_code, 1) << none.err;
    EXPECT_THAT(none.out,
                HasSubstr("no plan: no candidate keeps flip <= 0 in the 6 training views; "
                          "the best that is reachable is reuse:face=16, at most "));
    EXPECT_THAT(none.out, HasSubstr("flip above 0 in 6 of 6 training views; comes nearest\n"));
    EXPECT_THAT(none.err, HasSubstr("written, the nearest plan: plan.json"));
    const json plan = read_plan();
    EXPECT_EQ(plan["nearest"]["max_error"], 0);
    EXPECT_EQ(plan["certificate"]["max_error"], json());
    const std::vector<double> errors = measure_plan_errors(6, plan["certificate"]["proof_seed"]);
    EXPECT_NEAR(plan["certificate"]["error_bound"], std::ranges::max(errors), 1e-6);
    // The bound is a limit that --certify proves again.
    const test::ProcessResult again = run_choose({"--certify", "plan.json"});
    EXPECT_THAT(again.out, HasSubstr("plan:plan.json: ")) << again.err;
    EXPECT_THAT(again.out, HasSubstr(" of views have flip <= 0."));

    const test::ProcessResult slow = choose_between_two_techniques({"--max-ms", "0"});
    EXPECT_EQ(slow.exit_code, 1);
    EXPECT_THAT(slow.out, HasSubstr("no plan: no candidate takes at most 0 ms; the best that is "
                                    "reachable is "));
    EXPECT_THAT(slow.out, HasSubstr("\nnearest: "));
    EXPECT_EQ(read_plan()["nearest"]["max_ms"], 0);
}

TEST_F(Choose, PredictedTimeMayHold) {
    write_input_file("card.json",
                     R"({"schema": "catoptric/costs/1", "device": "card", "origin": "given",
        "costs": [{"work": "frames", "ns": 3e6, "range": [1.2e6, 1.3e7]}]})");
    const test::ProcessResult ended = choose_between_two_techniques(
        {"--max-ms", "4", "--costs", "card.json"});
    EXPECT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    EXPECT_THAT(ended.out, HasSubstr("may hold, 1.2 to 13 ms: "));
    EXPECT_THAT(ended.out, testing::Not(HasSubstr("\nholds: ")));
    EXPECT_EQ(read_plan()["proofs"][0]["keeps_time"], "may");
}

/// In each phase, an interrupted run ends and leaves the old file.
TEST_F(Choose, InterruptedRunKeepsTheOldFile) {
    for (const char* phase : {"measuring 2 candidates", "judging 1 candidate ", "proving "}) {
        write_input_file("plan.json", "old");
        test::ProcessStartOptions process = make_process_start(
            {"choose",           "flat",   "--size",       "16x16",
             "--frames",         "40",     "--warmup",     "1",
             "--share",          ".5",     "--confidence", ".9",
             "--training-views", "6",      "-o",           "plan.json",
             "--max-error",      "flip=1", "--techniques", "reuse:face=16",
             "raytrace:depth=4"});
        process.signal = SIGINT;
        process.signal_at = phase;
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 130) << phase << ended.err;
        EXPECT_EQ(ended.out, "") << phase;
        EXPECT_EQ(read_file_at_path(folder / "plan.json"), "old") << phase;
    }
}

TEST_F(Choose, LimitOfTimeAsksForTheLeastErrorAndProvesItsBound) {
    const test::ProcessResult ended = choose_between_two_techniques({"--max-ms", "100000"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const json plan = read_plan();
    EXPECT_EQ(plan["plan"][0]["technique"],
              "raytrace:depth=4"); // rays err less than a small capture
    EXPECT_EQ(plan["certificate"]["max_error"], json());
    const std::vector<double> errors = measure_plan_errors(6, plan["certificate"]["proof_seed"]);
    EXPECT_NEAR(plan["certificate"]["error_bound"], std::ranges::max(errors), 1e-6);
}

/// `choose` may choose `auto`, for all mirrors. Every verb with --plan takes its file.
TEST_F(Choose, ChosenAutoIsDrawnFromItsFile) {
    write_input_file("plan.json", R"({"plan": [{"mirror": "*", "technique": "auto"}]})");
    const auto draw = [&](const std::string& option, const std::string& value) {
        const test::ProcessResult ended = run_cli(
            {"render", "flat", "--size", "16x16", option, value, "-o", "x.exr"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return read_file_at_path(folder / "x.exr");
    };
    EXPECT_EQ(draw("--plan", "plan.json"), draw("--technique", "auto"));
    for (const Words& more : {Words{}, Words{"--why"}}) {
        Words words{"graph", "flat", "--size", "16x16", "--plan", "plan.json"};
        words.insert(words.end(), more.begin(), more.end());
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
    }
}

/// The answer `auto` says what it drew, and that plan is one that --technique takes.
TEST_F(Choose, ChosenAutoSaysWhatItDrew) {
    const test::ProcessResult ended = run_choose(
        {"-o", "plan.json", "--max-flip", "0.5", "--techniques", "auto"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    const json plan = read_plan();
    const std::string drawn = plan["proofs"][0]["drawn"];
    EXPECT_THAT(ended.out,
                HasSubstr("chosen: auto, which drew " + drawn + " in the request's own view"));
    const auto draw = [&](const std::string& technique) {
        EXPECT_EQ(
            run_cli({"render", "flat", "--size", "32x32", "--technique", technique, "-o", "x.exr"})
                .exit_code,
            0);
        return read_file_at_path(folder / "x.exr");
    };
    EXPECT_EQ(draw(drawn), draw("auto")) << drawn;
}

TEST_F(Choose, CertificateIsProvedAgainOnOtherViews) {
    const auto certify = [&](const Words& more) {
        Words words{"--certify", "plan.json"};
        words.insert(words.end(), more.begin(), more.end());
        return run_choose(words);
    };
    write_input_file("plan.json", R"({"plan": [{"mirror": "*", "technique": "auto"}],
        "certificate": {"quantity": "rmse", "max_error": 0.9, "exposure": 1.25}})");
    const test::ProcessResult holds = certify({"--proof-seed", "7", "-o", "again.json"});
    EXPECT_EQ(holds.exit_code, 0) << holds.err;
    EXPECT_THAT(holds.out, HasSubstr("holds: plan:plan.json: "));
    EXPECT_THAT(holds.out, HasSubstr("rmse <= 0.9"));
    const json again = json::parse(read_file_at_path(folder / "again.json"));
    EXPECT_EQ(again["certificate"]["proof_seed"], 7);
    EXPECT_EQ(again["certificate"]["exposure"], 1.25);
    EXPECT_EQ(again["plan"], read_plan()["plan"]);
    const test::ProcessResult darker = certify(
        {"--proof-seed", "7", "--exposure=-2", "-o", "darker.json"});
    EXPECT_EQ(darker.exit_code, 0) << darker.err;
    EXPECT_EQ(json::parse(read_file_at_path(folder / "darker.json"))["certificate"]["exposure"],
              -2);

    write_input_file("plan.json", R"({"plan": [{"mirror": "*", "technique": "reuse:face=16"}],
        "certificate": {"quantity": "flip", "max_error": 1e-9}})");
    const test::ProcessResult fails = certify({"-o", "failed.json"});
    EXPECT_EQ(fails.exit_code, 1) << fails.err;
    EXPECT_THAT(fails.out, HasSubstr("does not hold: "));
    EXPECT_THAT(fails.out, HasSubstr("6 failures"));

    EXPECT_FALSE(std::filesystem::exists(folder / "failed.json"));

    // Views that chose or proved the plan are not fresh, so `--certify` refuses them.
    write_input_file("plan.json", R"({"plan": [{"mirror": "*", "technique": "planar"}],
        "certificate": {"max_error": 1, "training_seed": 5, "proof_seed": 6, "share": 0.5}})");
    EXPECT_EQ(certify({"--proof-seed", "5"}).exit_code, 2);
    EXPECT_EQ(certify({"--proof-seed", "6"}).exit_code, 2);
    ASSERT_EQ(certify({"-o", "fresh.json"}).exit_code, 0);
    const json fresh = json::parse(read_file_at_path(folder / "fresh.json"))["certificate"];
    EXPECT_EQ(fresh["proof_seed"], 7);
    EXPECT_EQ(fresh["training_seed"], 5);
    const test::ProcessResult onto = certify({"-o", "plan.json"});
    EXPECT_EQ(onto.exit_code, 2);
    EXPECT_THAT(onto.err,
                HasSubstr("plan.json: cannot be written: it is the same file as plan.json"));

    write_input_file("plan.json", R"([{"mirror": "*", "technique": "reuse"}])");
    EXPECT_EQ(certify({"--max-error", "flip=1"}).exit_code,
              0); // a plan without a certificate
    const test::ProcessResult bare = certify({});
    EXPECT_EQ(bare.exit_code, 2);
    EXPECT_THAT(bare.err, HasSubstr("plan.json: has no certificate with a limit"));
    write_input_file("plan.json", R"({"plan": [], "certificate": {"max_error": "x"}})");
    EXPECT_EQ(certify({}).exit_code, 65);
}

TEST_F(Choose, CertificateIsProvedAgainAtItsOwnSizeAndWithItsReference) {
    const auto certify = [&](const Words& more) {
        Words words{"choose",    "flat",         "--frames", "6",          "--warmup", "1",
                    "--share",   ".5",           "-o",       "again.json", "-q",       "--certify",
                    "plan.json", "--confidence", ".9"};
        words.insert(words.end(), more.begin(), more.end());
        return run_cli(words);
    };
    const auto find_certificate = [&] {
        return json::parse(read_file_at_path(folder / "again.json"))["certificate"];
    };
    write_input_file("plan.json", R"({"plan": [{"mirror": "*", "technique": "reuse:face=16"}],
        "certificate": {"max_error": 1, "width": 24, "height": 20, "reference": "raytrace:depth=2"}})");
    const test::ProcessResult same = certify({});
    ASSERT_EQ(same.exit_code, 0) << same.err;
    EXPECT_THAT(same.out, HasSubstr("(6 views of 24x20, "));
    EXPECT_EQ(find_certificate()["width"], 24);
    EXPECT_EQ(find_certificate()["height"], 20);
    EXPECT_EQ(find_certificate()["reference"], "raytrace:depth=2");
    ASSERT_EQ(certify({"--size", "20x24", "--reference", "raytrace:depth=3"}).exit_code, 0);
    EXPECT_EQ(find_certificate()["width"], 20) << "options win over the certificate";
    EXPECT_EQ(find_certificate()["reference"], "raytrace:depth=3");

    write_input_file("plan.json", R"({"plan": [{"mirror": "*", "technique": "reuse:face=16"}],
        "certificate": {"max_error": 1, "reference": "raytracer"}})");
    const test::ProcessResult unknown = certify({});
    EXPECT_EQ(unknown.exit_code, 65);
    EXPECT_THAT(unknown.err, HasSubstr("plan.json: certificate.reference: "));
}

TEST_F(Choose, BadRequestsAreRefusedBeforeMeasuring) {
    const auto refused = [&](const Words& more, const std::string& says) {
        const test::ProcessResult ended = choose_between_two_techniques(more);
        EXPECT_EQ(ended.exit_code, 2) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr(says));
        EXPECT_FALSE(std::filesystem::exists(folder / "plan.json"));
    };
    refused({}, "'choose' needs --max-flip, --max-rmse or --max-ms: the limit to keep");
    refused({"--max-flip", "2"}, "--max-flip: wanted");
    refused({"--max-rmse", "-1"}, "--max-rmse: wanted");
    refused({"--max-flip", ".1", "--max-rmse", ".1"}, "found several");
    refused({"--max-error", "flip=.1", "--max-rmse", ".1"}, "found several");
    refused({"--max-error", "0.05"}, "--max-error: wanted flip=VALUE or rmse=VALUE, found '0.05'");
    refused({"--max-error", "flip=2"}, "--max-error");
    refused({"--max-error", "flip=.1", "--proof-seed", "1"},
            "wanted another than that of the training views, found 1");
    refused({"--max-error", "flip=.1", "--model", "both"}, "--model both");
    for (const std::string option :
         {"--cameras-per-instant", "--training-views", "--proof-views", "--reference-seconds"})
        refused({"--max-error", "flip=.1", option, "-1"}, option + ": wanted");
    const test::ProcessResult hopeless = run_cli(
        {"choose", "flat", "--max-rmse", ".1", "--proof-views", "58", "-o", "plan.json"});
    EXPECT_EQ(hopeless.exit_code, 2);
    EXPECT_THAT(hopeless.err,
                HasSubstr("views of the proof: wanted at least 59, since fewer cannot "
                          "prove a share of 0.95 with a confidence of 0.95, found 58"));
    const test::ProcessResult nowhere = run_choose({"--max-error", "flip=.1"});
    EXPECT_EQ(nowhere.exit_code, 2);
    EXPECT_THAT(nowhere.err, HasSubstr("'choose' needs -o PLAN.json"));
}

} // namespace
