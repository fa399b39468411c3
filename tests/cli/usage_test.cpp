// Tests of invalid command lines: exit code 2 and a message with the option, the wanted value and
// the value found.
#include "cli/program.hpp"

namespace {

TEST_F(CommandLineTest, CallWithoutArgumentsShowsHelp) {
    const test::ProcessResult ended = run_cli({});
    EXPECT_EQ(ended.exit_code, 2);
    EXPECT_EQ(ended.out, "");
    EXPECT_THAT(ended.err, testing::HasSubstr("compare"));
}

TEST_F(CommandLineTest, HelpOfEveryVerbHasExamples) {
    EXPECT_EQ(run_cli({"--help"}).exit_code, 0);
    for (const std::string verb :
         {"compare", "stress", "render", "diff", "graph", "list", "info"}) {
        const test::ProcessResult ended = run_cli({verb, "--help"});
        EXPECT_EQ(ended.exit_code, 0) << verb;
        EXPECT_EQ(ended.err, "");
        EXPECT_THAT(ended.out, testing::HasSubstr("Example")) << verb;
        EXPECT_THAT(ended.out, testing::HasSubstr("catoptric " + verb)) << verb;
        EXPECT_THAT(ended.out, testing::HasSubstr("--json")) << verb;
    }
}

TEST_F(CommandLineTest, HelpNamesEveryCommonOption) {
    const std::string help = run_cli({"render", "--help"}).out;
    for (const char* option : {"--size",
                               "--frames",
                               "--warmup",
                               "--time",
                               "--animate",
                               "--root",
                               "--camera",
                               "--seed",
                               "--ambient",
                               "--exposure",
                               "--model",
                               "--reference",
                               "--device",
                               "--device-profile",
                               "--timing",
                               "--validate",
                               "--json",
                               "--quiet",
                               "-v",
                               "--progress",
                               "--help",
                               "--mirror",
                               "--light",
                               "--mirror-max-roughness",
                               "--dielectric-mirrors",
                               "--multiple-scattering",
                               "--glass-shadow",
                               "--light-samples",
                               "--environment",
                               "--environment-shadows",
                               "--environment-scale",
                               "--environment-rotate",
                               "--up",
                               "--animation",
                               "--no-scene-file"})
        EXPECT_THAT(help, testing::HasSubstr(option));
}

TEST_F(CommandLineTest, VersionOptionPrintsNumberAndCommit) {
    const test::ProcessResult ended = run_cli({"--version"});
    EXPECT_EQ(ended.exit_code, 0);
    EXPECT_THAT(ended.out, testing::MatchesRegex("catoptric 0\\.1\\.0 \\([0-9a-z]+\\)\n"));
}

TEST_F(CommandLineTest, ErrorForAnUnknownVerbSuggestsASimilarName) {
    expect_usage_refused({"rendr"}, 2, {"'rendr'", "did you mean 'render'"});
    expect_usage_refused({"--versoin"}, 2, {"'--versoin'", "did you mean '--version'"});
}

TEST_F(CommandLineTest, ErrorForAnUnknownOptionSuggestsASimilarName) {
    expect_usage_refused({"render", "--sizee", "32x32"}, 2,
                         {"'render'", "'--sizee'", "did you mean '--size'"});
    expect_usage_refused({"compare", "-o", "x", "--tecniques", "reuse"}, 2,
                         {"'--tecniques'", "did you mean '--techniques'"});
    expect_usage_refused({"info", "--jsn=1"}, 2, {"'--jsn'", "did you mean '--json'"});
    expect_usage_refused({"list", "scenes", "devices"}, 2, {"'devices'"});
}

TEST_F(CommandLineTest, OptionWithoutItsValueIsRefused) {
    expect_usage_refused({"render", "--size"}, 2, {"--size", "render --help"});
}

TEST_F(CommandLineTest, ErrorForAnUnknownTechniqueSuggestsASimilarName) {
    expect_usage_refused({"render", "--technique", "paralax", "-o", "x.png"}, 2,
                         {"'paralax'", "did you mean 'parallax'"});
    expect_usage_refused({"compare", "-o", "x", "--techniques", "reuse", "naiv:bounces=1"}, 2,
                         {"'naiv'", "did you mean 'naive'"});
    expect_usage_refused({"graph", "--technique", "ruse"}, 2, {"'ruse'", "did you mean 'reuse'"});
    expect_usage_refused(
        {"compare", "-o", "x", "--causes", "--reference", "raytrace:depth=2"}, 2,
        {"--causes: wanted the default reference, raytrace:depth=16", "found 'raytrace:depth=2'"});
    expect_usage_refused({"compare", "-o", "x", "--reference", "raytracer"}, 2,
                         {"'raytracer'", "did you mean 'raytrace'"});
}

TEST_F(CommandLineTest, OptionsThatExcludeTheTruthAreNamed) {
    expect_usage_refused({"compare", "-o", "x", "--causes", "--truth", "paths"}, 2,
                         {"--causes: wanted the default reference, raytrace:depth=16",
                          "found 'raytrace:depth=16,rays=64,indirect=paths'"});
    expect_usage_refused({"compare", "-o", "x", "--truth", "paths", "--reference", "raytrace"}, 2,
                         {"--truth chooses the reference", "found raytrace"});
}

TEST_F(CommandLineTest, SceneAfterTheTechniquesIsRefused) {
    expect_usage_refused({"compare", "-o", "x", "--techniques", "reuse", "room.glb"}, 2,
                         {"'room.glb'", "SCENE comes before"});
}

/// Errors that the command line parser finds are worded like the program's own errors.
TEST_F(CommandLineTest, ParserErrorsUseTheProgramsOwnWording) {
    const std::pair<Words, std::string> cases[] = {
        {{"render", "--size"}, "--size: wanted a value, WxH, found none"},
        {{"render", "-o"}, "--output: wanted a value, OUT, found none"},
        {{"render", "--size", "8x8", "--size", "9x9"}, "--size: wanted once, found 2 times"},
        {{"compare", "-o", "out", "--techniques"}, "--techniques: wanted a value, T, found none"},
        {{"render", "--animate=maybe"}, "--animate: wanted no value, found 'maybe'"},
        {{"diff", "a.png"}, "wanted B, picture of the same size, found nothing"},
        {{"list"}, "found nothing"}};
    for (const auto& [words, message] : cases) {
        const test::ProcessResult ended = run_cli(words);
        expect_exit_code(ended, 2, {message, "(try 'catoptric " + words.front() + " --help')"});
        for (const char* raw : {"required", "missing", "At Most", "Could not convert", "Should be"})
            EXPECT_THAT(ended.err, testing::Not(testing::HasSubstr(raw))) << words.front();
    }
}

TEST_F(CommandLineTest, ErrorForAnUnknownKnobSuggestsASimilarName) {
    expect_usage_refused({"render", "--technique", "naive:bounce=3", "-o", "x.png"}, 2,
                         {"naive", "'bounce'", "did you mean 'bounces'"});
}

TEST_F(CommandLineTest, ErrorForAKnobOutOfRangeNamesTheRange) {
    expect_usage_refused({"render", "--technique", "naive:bounces=9", "-o", "x.png"}, 2,
                         {"'bounces'", "0 to 8", "9"});
    expect_usage_refused({"render", "--technique", "reuse:face=0", "-o", "x.png"}, 2,
                         {"'face'", "1 to 16384", "0"});
    expect_usage_refused({"render", "--technique", "reuse:face=many", "-o", "x.png"}, 2,
                         {"'face'", "whole number", "'many'"});
}

TEST_F(CommandLineTest, ErrorForAnUnknownSceneSuggestsASimilarName) {
    expect_usage_refused({"render", "cornel-mirrors", "--technique", "reuse", "-o", "x.png"}, 2,
                         {"'cornel-mirrors'", "did you mean 'cornell-mirrors'"});
}

TEST_F(CommandLineTest, ErrorForAnUnknownCameraListsTheScenesCameras) {
    expect_usage_refused({"render", "--camera", "nowhere", "--technique", "reuse", "-o", "x.png"},
                         2, {"'nowhere'", "it has: 0 '"});
    expect_usage_refused({"render", "--camera", "7", "--technique", "reuse", "-o", "x.png"}, 2,
                         {"'7'", "it has: 0 '"});
}

TEST_F(CommandLineTest, InvalidCameraIsRefused) {
    const auto camera = [](const std::string& text) {
        return Words{"render", "--camera", text, "--technique", "reuse", "-o", "x.png"};
    };
    expect_usage_refused(camera("0,0,0:0,0,0:40"), 2, {"--camera", "target away from the eye"});
    expect_usage_refused(camera("0,0:0,0,1:40"), 2, {"--camera", "X,Y,Z", "'0,0'"});
    expect_usage_refused(camera("0,0,0:0,0,1:180"), 2, {"--camera", "179", "'180'"});
    expect_usage_refused(camera("0,0,nan:0,0,1:40"), 2, {"--camera", "finite", "'nan'"});
    expect_usage_refused(camera("1e200,0,0:0,0,1:40"), 2, {"camera", "1e+18", "1e+200"});
    expect_usage_refused(camera("1e60,0,0:0,0,1:40"), 2, {"camera", "1e+18", "1e+60"});
    expect_usage_refused(camera("0,0,0:0,0,1:h=-1"), 2, {"--camera", "1e+18", "'-1'"});
    expect_usage_refused(camera("0,0,0:0,0,1"), 2, {"--camera", "EX,EY,EZ:TX,TY,TZ:FOV"});
}

TEST_F(CommandLineTest, ErrorForAnUnknownDeviceNamesIt) {
    expect_usage_refused({"info", "--device", "no such device"}, 2, {"no such device"});
}

TEST_F(CommandLineTest, ErrorForAnUnknownListSuggestsASimilarName) {
    expect_usage_refused({"list", "scene"}, 2, {"'scene'", "did you mean 'scenes'"});
}

TEST_F(CommandLineTest, InvalidNumberOfAnOptionIsRefused) {
    const auto refused = [&](const std::string& option, const std::string& found,
                             const std::string& wanted) {
        expect_usage_refused({"render", "--technique", "reuse", "-o", "x.png", option, found}, 2,
                             {option, wanted, "'" + found + "'"});
    };
    for (const std::string size :
         {"0x0", "32", "32x", "-5x5", "32x0", "32x32x32", "nanxnan", "99999999999x1", " 32x32", ""})
        refused("--size", size, "wanted WxH");
    for (const std::string count : {"0", "-1", "1.5", "nan", "abc", "", "99999999999999999999"})
        refused("--frames", count, "from 1 to");
    for (const std::string count : {"-1", "x"}) refused("--warmup", count, "from 0 to");
    for (const std::string time : {"nan", "inf", "-inf", "1e999", "soon", "1s"})
        refused("--time", time, "finite");
    for (const std::string ms : {"nan", "inf", "soon"}) refused("--budget-ms", ms, "finite");
    for (const std::string ms : {"0", "-1"}) refused("--budget-ms", ms, "above 0");
    for (const std::string light : {"nan", "-0.1", "inf"})
        refused("--ambient", light, "at least 0");
    for (const std::string stops : {"nan", "65", "-65", "Auto"})
        refused("--exposure", stops, "-64 to 64");
    for (const std::string share : {"-0.1", "1.1", "nan"})
        refused("--mirror-max-roughness", share, "from 0 to 1");
    refused("--multiple-scattering", "yes", "none or turquin");
    refused("--glass-shadow", "yes", "none or tint");
    for (const std::string scale : {"-1", "inf"}) refused("--environment-scale", scale, "from 0");
    refused("--environment-rotate", "north", "finite");
    for (const std::string rays : {"-1", "1025"})
        refused("--environment-shadows", rays, "from 0 to 1024");
    refused("--mirror", "a=2", "from 0 to 1");
    for (const std::string seed : {"-1", "1.5", "18446744073709551616"})
        refused("--seed", seed, "whole number");
}

TEST_F(CommandLineTest, MorePointsOnLampsThanADeviceHoldsAreRefused) {
    const std::vector<std::string> render{"render", "gallery", "--technique",
                                          "reuse",  "-o",      "x.png"};
    const auto with = [&](const char* samples) {
        std::vector<std::string> words = render;
        words.insert(words.end(), {"--light-samples", samples});
        return words;
    };
    expect_usage_refused(with("64"), 2,
                         {"--light-samples 64", "3 lamps would become 192 lights",
                          "wanted at most 128", "42 for each lamp"});
    expect_usage_refused(with("129"), 2, {"--light-samples", "from 1 to 128", "129"});
}

TEST_F(CommandLineTest, UnknownChoiceOfAnOptionIsRefused) {
    expect_usage_refused({"render", "--timing", "isolate"}, 2,
                         {"--timing", "isolated, pipelined", "did you mean 'isolated'"});
    expect_usage_refused({"render", "--progress", "sometimes"}, 2,
                         {"--progress", "auto, always, never"});
    expect_usage_refused({"graph", "--technique", "reuse", "--format", "dott"}, 2,
                         {"--format", "did you mean 'dot'"});
    expect_usage_refused({"graph", "--technique", "reuse", "--format", "dot", "--json"}, 2,
                         {"--format", "--json"});
}

TEST_F(CommandLineTest, SceneOverrideThatMatchesNothingIsRefused) {
    const auto refused = [&](const Words& wish, const Words& parts) {
        Words words{"render", "--technique", "reuse", "-o", "x.png"};
        words.insert(words.end(), wish.begin(), wish.end());
        expect_usage_refused(words, 2, parts);
    };
    refused({"--mirror", "bal1"}, {"--mirror 'bal1': matches no object or material of scene "
                                   "'cornell-mirrors'; it has: 'back', 'ball1'",
                                   "did you mean 'ball1'"});
    refused({"--light", "Light"}, {"--light 'Light'", "did you mean 'light'"});
    refused({"--light", "floor"}, {"--light 'floor': wanted something that emits light"});
    refused({"--up", "x"}, {"--up: wanted one of y, z, found 'x'"});
    refused({"--environment-scale", "2"}, {"--environment-scale: wanted an environment"});
    refused({"--environment", ""}, {"--environment: wanted FILE.exr"});
    expect_usage_refused({"info", "--write"}, 2, {"--write: wanted a SCENE"});
    expect_usage_refused({"info", "cornell-mirrors", "--write"}, 2,
                         {"--write: wanted a scene's file"});
    expect_usage_refused({"info", "--force"}, 2, {"--force: wanted --write"});
}

TEST_F(CommandLineTest, InvalidModelOptionIsRefused) {
    expect_usage_refused({"render", "--model", "evrything"}, 2,
                         {"--model", "did you mean 'everything'"});
    expect_usage_refused(
        {"render", "--technique", "reuse", "--model", "both", "-o", "x.png"}, 2,
        {"--model both: wanted everything or required, of which a picture has one"});
    expect_usage_refused({"graph", "--technique", "reuse", "--model", "both"}, 2,
                         {"--model both: wanted everything or required, of which a plan has one"});
    expect_usage_refused(
        {"compare", "-o", "x", "--techniques", "reuse", "--model", "both", "--together"}, 2,
        {"--model both and --together"});
    expect_usage_refused({"render", "--technique", "reuse", "--model", "everything", "--budget-ms",
                          "4", "-o", "x.png"},
                         2, {"--budget-ms and --model everything: wanted --model required"});
    expect_usage_refused({"graph", "--technique", "reuse", "--budget-ms", "4"}, 2,
                         {"--budget-ms: wanted --why"});
    expect_usage_refused({"graph", "--why", "--budget-ms", "4"}, 2, {"'graph'", "--technique T"});
}

TEST_F(CommandLineTest, MissingRequiredArgumentIsRefused) {
    expect_usage_refused({"compare"}, 2, {"'compare'", "-o DIR"});
    expect_usage_refused({"render", "--technique", "reuse"}, 2, {"'render'", "-o OUT"});
    expect_usage_refused({"graph"}, 2, {"'graph'", "--technique T"});
    expect_usage_refused({"diff", "a.png"}, 2,
                         {"wanted B, picture of the same size, found nothing", "diff --help"});
    expect_usage_refused({"list"}, 2, {"wanted WHAT, techniques", "found nothing", "list --help"});
}

TEST_F(CommandLineTest, PictureNameWithoutAKnownEndingIsRefused) {
    expect_usage_refused({"render", "--technique", "reuse", "-o", "x.jpg"}, 2,
                         {"'x.jpg'", ".exr, .png or .mp4"});
}

TEST_F(CommandLineTest, TwoResultsForStdoutAreRefused) {
    expect_usage_refused({"render", "--technique", "reuse", "-o", "-", "--json"}, 2,
                         {"-o -", "--json"});
}

TEST_F(CommandLineTest, SameTechniqueTwiceIsRefused) {
    expect_usage_refused(add_small_frame_options({"compare", "-o", "x", "--techniques", "reuse",
                                                  "reuse", "--together"}),
                         2, {"'reuse'", "twice"});
    expect_usage_refused(
        add_small_frame_options({"compare", "-o", "x", "--techniques", "reuse", "reuse:face=256"}),
        2, {"'reuse:face=256' is asked for twice"});
}

} // namespace
