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

class PdfFigures : public CommandLineTest {
protected:
    test::ProcessResult write_figures_with_path(const std::string& path) const {
        test::ProcessStartOptions start = make_process_start(
            add_small_frame_options({"compare", "-o", "out", "--figures", "paper", "--techniques",
                                     "reuse:face=16", "raytrace:depth=3"}));
        start.environment["PATH"] = path;
        return test::run_process(start);
    }
    /// Writes a script in place of rsvg-convert and returns the PATH in which it is found.
    std::string write_stand_in_for_converter(const std::string& then) const {
        fs::create_directory(folder / "bin");
        const fs::path script = folder / "bin/rsvg-convert";
        std::ofstream(script) << "#!/bin/sh\n" << then << "\n";
        fs::permissions(script, fs::perms::owner_all);
        return (folder / "bin").string() + ":/usr/bin:/bin";
    }
};

TEST_F(PdfFigures, ConverterMakesAPdfOfEachDrawing) {
    const test::ProcessResult ended = write_figures_with_path(
        write_stand_in_for_converter("[ \"$1 $2 $3\" = \"-f pdf -o\" ] && cp \"$5\" \"$4\""));
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    for (const std::string drawing : {"plot", "passes"})
        EXPECT_EQ(read_output_file("paper/" + drawing + ".pdf"),
                  read_output_file("paper/" + drawing + ".svg"));
    EXPECT_FALSE(fs::exists(folder / "paper/causes.pdf")) << "no row has causes";
    EXPECT_THAT(read_output_file("paper/figures.tex"), Not(testing::HasSubstr("rsvg-convert")));
}

TEST_F(PdfFigures, ANoteSaysThatThereIsNoConverter) {
    fs::create_directory(folder / "paper");
    write_input_file("paper/plot.pdf", "the drawing of an earlier run");
    const test::ProcessResult ended = write_figures_with_path((folder / "none").string());
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.err, testing::HasSubstr("--figures: SVG without PDF: wanted the program "
                                              "rsvg-convert in PATH (apt install librsvg2-bin), "
                                              "found none"));
    EXPECT_TRUE(fs::exists(folder / "paper/plot.svg"));
    EXPECT_FALSE(fs::exists(folder / "paper/plot.pdf"));
    EXPECT_THAT(read_output_file("paper/figures.tex"),
                testing::HasSubstr("% Drawings as PDF: for f in *.svg; do rsvg-convert -f pdf"));
}

TEST_F(PdfFigures, FailureOfTheConverterNamesTheFileAndKeepsTheOldOne) {
    fs::create_directory(folder / "paper");
    write_input_file("paper/plot.pdf", "old");
    const test::ProcessResult ended = write_figures_with_path(
        write_stand_in_for_converter("echo no fonts >&2; echo half > \"$4\"; exit 3"));
    EXPECT_EQ(ended.exit_code, 74) << ended.err;
    for (const char* part : {"paper/plot.pdf: cannot be written: ",
                             "rsvg-convert, wanted exit "
                             "code 0, found 3",
                             "no fonts"})
        EXPECT_THAT(ended.err, testing::HasSubstr(part));
    EXPECT_EQ(read_output_file("paper/plot.pdf"), "old");
    EXPECT_FALSE(fs::exists(folder / "paper/figures.tex"));
}

/// A failure to write figures does not keep the other scenes from being measured.
TEST_F(PdfFigures, FailureOfTheConverterKeepsTheReportOfAllScenes) {
    test::ProcessStartOptions start = make_process_start(
        add_small_frame_options({"compare", "cornell-mirrors", "flat", "-o", "out", "--figures",
                                 "paper", "--techniques", "reuse:face=16"}));
    start.environment["PATH"] = write_stand_in_for_converter("exit 3");
    const test::ProcessResult ended = test::run_process(start);
    EXPECT_EQ(ended.exit_code, 74) << ended.err;
    EXPECT_THAT(ended.err, testing::HasSubstr("paper/1-cornell-mirrors/plot.pdf"));
    EXPECT_EQ(nlohmann::json::parse(read_output_file("out/report.json"))["scenes"].size(), 2u);
}

/// rsvg-convert itself writes a page with the drawing's own text.
TEST_F(PdfFigures, RsvgConvertWritesPdf) {
    if (!fs::exists("/usr/bin/rsvg-convert"))
        GTEST_SKIP() << "no /usr/bin/rsvg-convert: install the Debian package librsvg2-bin";
    const test::ProcessResult ended = write_figures_with_path("/usr/bin:/bin");
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    for (const std::string drawing : {"plot", "passes"}) {
        const std::string pdf = read_output_file("paper/" + drawing + ".pdf");
        EXPECT_THAT(pdf, testing::StartsWith("%PDF-"));
        EXPECT_THAT(pdf, testing::HasSubstr("%%EOF"));
        EXPECT_THAT(pdf, testing::HasSubstr("/Font")) << "text stays text";
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
