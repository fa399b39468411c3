// Tests of what `compare` and `choose` say of the distance of their reference to path tracing.
#include "cli/program.hpp"

namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class PathDistanceOfVerbs : public CommandLineTest {
protected:
    test::ProcessResult run_verb(const Words& words) const {
        test::ProcessStartOptions start = make_process_start(words);
        start.environment["XDG_CACHE_HOME"] = (folder / "cache").string(); // nothing is kept yet
        return test::run_process(start);
    }
    test::ProcessResult compare_small_rows(const Words& more) const {
        Words words{"compare",      "cornell-mirrors-closed",
                    "-o",           "out",
                    "--size",       "16x16",
                    "--frames",     "6",
                    "--warmup",     "1",
                    "--techniques", "reuse:face=16"};
        words.insert(words.end(), more.begin(), more.end());
        return run_verb(words);
    }
    json read_distance() const {
        return json::parse(read_output_file("out/report.json"))["reference"]["path_distance"];
    }
};

TEST_F(PathDistanceOfVerbs, ComparePrintsItAfterTheTable) {
    const test::ProcessResult ended = compare_small_rows({"--path-distance", "1000"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const std::string start = "\nThe reference itself, whose light is simplified, is FLIP ";
    EXPECT_THAT(ended.out, HasSubstr(start));
    EXPECT_GT(ended.out.find(start), ended.out.find("reuse:face=16"));
    EXPECT_THAT(ended.out, HasSubstr("16x16, "));
    EXPECT_THAT(read_output_file("out/report.md"),
                HasSubstr("> The reference itself, whose light is simplified, is FLIP "));
    EXPECT_THAT(read_output_file("out/report.html"),
                HasSubstr("The reference itself, whose light is simplified, is FLIP "));
    const json distance = read_distance();
    EXPECT_EQ(distance["known"], true);
    EXPECT_EQ(distance["kept"], false);
    EXPECT_GT(distance["flip"], distance["noise"]);

    const test::ProcessResult quiet = compare_small_rows({"--quiet"});
    EXPECT_THAT(quiet.out, HasSubstr(start)) << "it belongs to the result";
    EXPECT_THAT(quiet.out, HasSubstr(", kept)")) << "a small picture takes no time, but reads";
    EXPECT_EQ(quiet.err, "");
    EXPECT_EQ(read_distance()["flip"], distance["flip"]);

    const test::ProcessResult document = compare_small_rows({"--json"});
    EXPECT_EQ(json::parse(document.out)["reference"]["path_distance"]["known"], true);
}

TEST_F(PathDistanceOfVerbs, SmallPicturesSayHowToFindOut) {
    const test::ProcessResult ended = compare_small_rows({});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    const std::string sentence =
        "How far the reference itself is from path tracing is not known: pictures of at most "
        "64x64 pixels are left out. To find out: catoptric compare cornell-mirrors-closed -o DIR --truth paths "
        "--techniques raytrace:depth=16, with the same options for scene and camera.";
    EXPECT_THAT(ended.out, HasSubstr("\n" + sentence + "\n"));
    EXPECT_EQ(read_distance()["why"], "pictures of at most 64x64 pixels are left out");
}

TEST_F(PathDistanceOfVerbs, PathTracedReferenceNeedsNoSentence) {
    const test::ProcessResult ended = compare_small_rows(
        {"--truth", "paths", "--path-distance", "1000", "--reference-seconds", "0"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, Not(HasSubstr("path tracing")));
    EXPECT_TRUE(read_distance().is_null());
}

TEST_F(PathDistanceOfVerbs, ChoosePrintsItAndWritesItIntoThePlan) {
    const test::ProcessResult ended = run_verb({"choose",
                                                "flat",
                                                "--size",
                                                "16x16",
                                                "--frames",
                                                "6",
                                                "--warmup",
                                                "1",
                                                "--share",
                                                ".5",
                                                "--confidence",
                                                ".9",
                                                "--training-views",
                                                "6",
                                                "--max-error",
                                                "flip=1",
                                                "-o",
                                                "plan.json",
                                                "--path-distance",
                                                "1000",
                                                "--techniques",
                                                "raytrace:depth=1"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    EXPECT_THAT(ended.out, HasSubstr("\nThe reference itself"));
    EXPECT_EQ(json::parse(read_output_file("plan.json"))["path_distance"]["known"], true);
}

} // namespace
