// Tests of the options of `compare` for figures of a paper.
#include "cli/program.hpp"
#include "core/file.hpp"
#include "measure/picture.hpp"

namespace {

namespace fs = std::filesystem;

TEST_F(CommandLineTest, FiguresOfEachSceneLieInAFolderOfTheirOwn) {
    const test::ProcessResult ended = run_cli(add_small_frame_options(
        {"compare", "cornell-mirrors", "room", "-o", "out", "--figures", "new/paper", "--crop",
         "4,8,16,12", "--techniques", "reuse:face=16", "raytrace:depth=3"}));
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    for (const std::string scene : {"1-cornell-mirrors", "2-room"}) {
        const fs::path paper = folder / "new/paper" / scene;
        const catoptric::measure::Picture crop = catoptric::measure::read_picture(
            paper / "crop-reuse-face16.png");
        EXPECT_EQ(crop.width, 512);
        EXPECT_EQ(crop.height, 384);
        for (const char* file : {"plot.svg", "passes.svg", "reference.png", "crop-reference.png",
                                 "crop-raytrace-depth3.png"})
            EXPECT_TRUE(fs::exists(paper / file)) << file;
        EXPECT_THAT(catoptric::read_file(paper / "figures.tex"),
                    testing::HasSubstr("scene " + scene.substr(2) + ","));
    }
}

TEST_F(CommandLineTest, CropThatIsNoPartOfThePictureIsRefused) {
    const auto expect_refused = [&](const Words& more, const Words& parts) {
        Words words{"compare", "-o", "out", "--size", "32x24"};
        words.insert(words.end(), more.begin(), more.end());
        expect_usage_refused(words, 2, parts);
        EXPECT_FALSE(fs::exists(folder / "out"));
    };
    expect_refused({"--crop", "0,0,8,8"}, {"--crop", "--figures"});
    for (const std::string crop : {"1,2,3", "1,2,3,4,5", "1,2,3,"})
        expect_refused({"--figures", "paper", "--crop", crop},
                       {"--crop", "X,Y,WIDTH,HEIGHT", "'" + crop + "'"});
    expect_refused({"--figures", "paper", "--crop", "1,2,x,4"}, {"--crop", "'x'"});
    expect_refused({"--figures", "paper", "--crop", "1,2,0,4"}, {"--crop", "1", "'0'"});
    expect_refused({"--figures", "paper", "--crop", "30,0,3,4"}, {"--crop", "32x24", "30,0,3,4"});
}

} // namespace
