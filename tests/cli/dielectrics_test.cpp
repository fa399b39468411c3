// Tests of a smooth dielectric: a polished floor that reflects without being a mirror.
#include "cli/program.hpp"

#include <cmath>

namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Writes a scene of a room with a mirror at the back wall. A polished floor covers about 39 % of
/// the picture.
class SmoothDielectricsCliTest : public CommandLineTest {
protected:
    SmoothDielectricsCliTest() {
        write_input_file("room.mtl",
                         "newmtl wall\nKd .7 .7 .7\nnewmtl red\nKd .7 .2 .2\n"
                         "newmtl floor\nKd .4 .3 .2\nKs .05 .05 .05\nNs 1000\nillum 5\n"
                         "newmtl lamp\nKe 15 14 12\nnewmtl mirror\nKs .9 .9 .9\nillum 3\n");
        write_input_file("room.obj",
                         "mtllib room.mtl\n# catoptric camera c 0 1.6 2.6 0 .9 -1 0 1 0 55\n"
                         "# catoptric exposure 2\n"
                         "v -2 0 3\nv 2 0 3\nv 2 0 -3\nv -2 0 -3\n"
                         "v -2 3 3\nv 2 3 3\nv 2 3 -3\nv -2 3 -3\n"
                         "v -.5 2.9 -.5\nv .5 2.9 -.5\nv .5 2.9 .5\nv -.5 2.9 .5\n"
                         "v -1 .8 -2.95\nv 1 .8 -2.95\nv 1 2.2 -2.95\nv -1 2.2 -2.95\n"
                         "o floor\nusemtl floor\nf 1 2 3 4\no ceiling\nusemtl wall\nf 8 7 6 5\n"
                         "o back\nf 4 3 7 8\no front\nf 2 1 5 6\n"
                         "o left\nusemtl red\nf 1 4 8 5\no right\nusemtl wall\nf 3 2 6 7\n"
                         "o lamp\nusemtl lamp\nf 9 10 11 12\n"
                         "o mirror\nusemtl mirror\nf 13 14 15 16\n");
    }
    json compare_on_polished_floor(const Words& more) const {
        Words words{"compare", "room.obj", "-o",       "out", "--techniques", "planar", "raytrace",
                    "--size",  "64x64",    "--frames", "2",   "--warmup",     "1"};
        words.insert(words.end(), more.begin(), more.end());
        const test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return json::parse(read_output_file("out/report.json"));
    }
};

TEST_F(SmoothDielectricsCliTest, RowsShowTheErrorOfMissingDielectricReflections) {
    const json report = compare_on_polished_floor({});
    const json &planar = report["rows"][0], &traced = report["rows"][1];
    const double pixels = planar["error_dielectrics"]["pixels"];
    EXPECT_EQ(planar["error_dielectrics"]["mask"], "dielectrics");
    const double share = 100 * pixels / (64 * 64);
    EXPECT_NEAR(share, 39, 3) << "the floor's part of the picture, percent";
    EXPECT_GT(planar["error_dielectrics"]["flip"], .02) << "no reflection on the floor";
    EXPECT_EQ(traced["error_dielectrics"]["pixels"], pixels);
    EXPECT_EQ(traced["error_dielectrics"]["max"], 0);
    EXPECT_LT(pixels + planar["error"]["pixels"].get<double>(), 64 * 64) << "walls are neither";
    for (const char* page : {"out/report.md", "out/report.html"}) {
        const std::string text = read_output_file(page);
        EXPECT_THAT(text, HasSubstr("FLIP, smooth dielectrics")) << page;
        EXPECT_THAT(text, HasSubstr("Not drawn: " + std::to_string(std::lround(share)) +
                                    " % of the pixels show smooth surfaces that are no mirrors, "
                                    "and no row but raytrace draws what they reflect"))
            << page;
    }
    EXPECT_THAT(read_output_file("out/rows.csv"), HasSubstr("dielectrics_flip"));
}

TEST_F(SmoothDielectricsCliTest, OptionMakesSmoothDielectricsMirrors) {
    const json report = compare_on_polished_floor({"--dielectric-mirrors"});
    const json& planar = report["rows"][0];
    EXPECT_EQ(planar["error_dielectrics"]["pixels"], 0);
    EXPECT_TRUE(planar["error_dielectrics"]["flip"].is_null());
    EXPECT_EQ(planar["error_per_mirror"].size(), 2u);
    EXPECT_THAT(read_output_file("out/report.md"), testing::Not(HasSubstr("smooth dielectrics")));
    EXPECT_THAT(read_output_file("out/report.md"), testing::Not(HasSubstr("Not drawn: ")));
}

TEST_F(SmoothDielectricsCliTest, GraphWhyNamesReflectionsThatNoRowDraws) {
    const test::ProcessResult text = run_cli({"graph", "room.obj", "--why"});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_THAT(text.out,
                HasSubstr("not drawn\n  what smooth surfaces that are no mirrors reflect: "
                          "39."));
    EXPECT_THAT(text.out, HasSubstr(" % of the picture (first: materials[2] 'floor')"));
    const json why = json::parse(run_cli({"graph", "room.obj", "--why", "--json"}).out);
    ASSERT_EQ(why["not_drawn"].size(), 1u);
    EXPECT_NEAR(why["not_drawn"][0]["pixel_share"], .39, .01);
    const json mirrors = json::parse(
        run_cli({"graph", "room.obj", "--why", "--json", "--dielectric-mirrors"}).out);
    EXPECT_EQ(mirrors["not_drawn"], json::array());
}

} // namespace
