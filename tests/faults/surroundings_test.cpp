// Tests of failure R6 of docs/extremes.md: the reader of stdout has closed the pipe, or a cache
// cannot be written.
#include "faults/faults.hpp"

namespace {

namespace fs = std::filesystem;

class RunEnvironmentFaultTest : public CommandLineTest {
protected:
    static Words add_small_picture_options(Words words) {
        words.insert(words.end(), {"--size", "32x32", "--frames", "1", "--warmup", "0"});
        return words;
    }
};

TEST_F(RunEnvironmentFaultTest, ClosedPipeAfterTheWorkExitsWith74) {
    for (const Words& words :
         {add_small_picture_options({"render", "--technique", "raytrace:depth=1", "-o", "-"}),
          add_small_picture_options(
              {"render", "--technique", "raytrace:depth=1", "--json", "-o", "x.png"}),
          add_small_picture_options({"compare", "-o", "out", "--techniques", "raytrace:depth=1"}),
          add_small_picture_options(
              {"compare", "-o", "json", "--json", "--techniques", "raytrace:depth=1"}),
          Words{"diff", "--json", "x.png", "x.png"}}) {
        test::ProcessStartOptions process = make_process_start(words);
        process.no_reader = true;
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 74) << words[0];
        EXPECT_EQ(ended.err, "") << words[0];
    }
    EXPECT_TRUE(fs::exists(folder / "out/report.json"))
        << "the files are there, whoever reads the table";
}

TEST_F(RunEnvironmentFaultTest, UnwritableCacheFolderOnlyGivesAWarning) {
    write_input_file("file", "");
    for (const fs::path& place : {fs::path("/proc/none"), folder / "file"}) {
        test::ProcessStartOptions process = make_process_start(add_small_picture_options(
            {"render", "--technique", "parallax", "-o", "x.png", "--quiet"}));
        for (const char* variable : {"HOME", "XDG_CACHE_HOME", "MESA_SHADER_CACHE_DIR"})
            process.environment[variable] = place.string();
        const test::ProcessResult ended = test::run_process(process);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        // stderr may hold one warning of the program and one of the driver, each about its own
        // cache.
        EXPECT_LE(std::count(ended.err.begin(), ended.err.end(), '\n'), 2) << ended.err;
        EXPECT_THAT(ended.err, testing::HasSubstr("catoptric: warning: " + place.string()));
        EXPECT_EQ(ended.err.find("catoptric: "), ended.err.rfind("catoptric: ")) << ended.err;
        EXPECT_TRUE(fs::exists(folder / "x.png"));
    }
}

} // namespace
