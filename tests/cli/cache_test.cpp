// Tests of the cache that keeps compiled pipelines from run to run. A failure of the cache prints
// one warning and has no other effect.
#include "cli/program.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

namespace {

namespace fs = std::filesystem;

class Cache : public CommandLineTest {
protected:
    /// Renders a.png with XDG_CACHE_HOME set to `cache_home`. Messages are in `err` of the result.
    test::ProcessResult render_with_cache_home(const std::string& cache_home) const {
        test::ProcessStartOptions asked = make_process_start(
            {"render", "--technique", "naive:bounces=1,face=8,shadow=none", "--size", "16x16", "-o",
             "a.png", "-q"});
        asked.environment = {{"XDG_CACHE_HOME", cache_home},
                             {"HOME", folder.string()},
                             {"MESA_SHADER_CACHE_DISABLE", "true"}}; // avoids driver messages
        return test::run_process(asked);
    }
    std::string read_rendered_picture() const { return read_output_file("a.png"); }
    /// Returns the regular files of the folder, without those of folders in it.
    static std::vector<fs::path> list_files_in_folder(const fs::path& where) {
        std::vector<fs::path> files;
        for (const auto& entry : fs::directory_iterator(where))
            if (entry.is_regular_file()) files.push_back(entry.path());
        return files;
    }
};

TEST_F(Cache, PipelineCacheIsMadeInTheUsersCacheFolder) {
    ASSERT_EQ(render_with_cache_home((folder / "mine").string()).err, "");
    ASSERT_EQ(list_files_in_folder(folder / "mine" / "catoptric").size(), 1u);
    ASSERT_EQ(render_with_cache_home("").err, "");
    EXPECT_EQ(list_files_in_folder(folder / ".cache" / "catoptric").size(), 1u)
        << "XDG_CACHE_HOME is empty";
    ASSERT_EQ(render_with_cache_home("relative").err, "");
    EXPECT_FALSE(fs::exists(folder / "relative")) << "no absolute path counts as none";
}

TEST_F(Cache, ReportSaysWhetherThePipelineCacheWasUsed) {
    test::ProcessStartOptions asked = make_process_start(
        {"compare", "-o", "out", "--techniques", "raytrace:depth=0", "--size", "16x16", "--frames",
         "1", "--warmup", "0", "--reference", "raytrace:depth=0", "-q"});
    const auto setup = [&](const std::string& cache_home) {
        asked.environment = {{"XDG_CACHE_HOME", cache_home}, {"HOME", ""}};
        EXPECT_EQ(test::run_process(asked).exit_code, 0);
        return nlohmann::json::parse(read_output_file("out/report.json"))["setup"];
    };
    EXPECT_EQ(setup("")["pipeline_cache"], "none");
    EXPECT_EQ(setup(folder.string())["pipeline_cache"], "made");
    const nlohmann::json last = setup(folder.string());
    EXPECT_EQ(last["pipeline_cache"], "used");
    EXPECT_GT(last["pipelines"], 0);
    for (const char* part : {"load_ms", "upload_ms", "hierarchy_ms", "compile_ms"})
        EXPECT_GT(last[part], 0) << part;
}

TEST_F(Cache, BrokenCacheFileGivesOneWarningAndIsReplaced) {
    ASSERT_EQ(render_with_cache_home(folder.string()).exit_code, 0);
    const std::string wanted = read_rendered_picture();
    const std::vector<fs::path> files = list_files_in_folder(folder / "catoptric");
    ASSERT_EQ(files.size(), 1u);
    const std::string whole = read_file_at_path(files[0]);
    for (const std::string& broken :
         {std::string(), whole.substr(0, whole.size() - 1), whole + "x"}) {
        std::ofstream(files[0], std::ios::binary) << broken;
        const test::ProcessResult said = render_with_cache_home(folder.string());
        EXPECT_EQ(said.exit_code, 0);
        EXPECT_THAT(said.err, testing::AllOf(testing::HasSubstr(files[0].string()),
                                             testing::HasSubstr("wanted a whole pipeline cache")));
        EXPECT_EQ(std::ranges::count(said.err, '\n'), 1) << said.err;
        EXPECT_EQ(read_rendered_picture(), wanted);
        EXPECT_EQ(render_with_cache_home(folder.string()).err, "") << "a new one was made";
    }
}

TEST_F(Cache, SpecialisedShadersAreReadAgain) {
    ASSERT_EQ(render_with_cache_home(folder.string()).exit_code, 0);
    const std::string wanted = read_rendered_picture();
    const std::vector<fs::path> files = list_files_in_folder(folder / "catoptric" / "shaders");
    ASSERT_GT(files.size(), 2u);
    std::map<fs::path, std::string> contents;
    for (const fs::path& file : files) contents[file] = read_file_at_path(file);
    // The program writes the two broken cache files again, and no other file.
    std::ofstream(files[0], std::ios::binary) << contents[files[0]].substr(0, 40);
    std::ofstream(files[1], std::ios::binary) << contents[files[1]] + "x";
    const fs::file_time_type before = fs::last_write_time(files[2]);
    const test::ProcessResult said = render_with_cache_home(folder.string());
    EXPECT_EQ(said.exit_code, 0);
    EXPECT_EQ(said.err, "");
    EXPECT_EQ(read_rendered_picture(), wanted);
    for (const fs::path& file : files) EXPECT_EQ(read_file_at_path(file), contents[file]);
    EXPECT_EQ(fs::last_write_time(files[2]), before);
    EXPECT_EQ(list_files_in_folder(folder / "catoptric" / "shaders").size(), files.size());
}

TEST_F(Cache, UnwritableCacheFolderOnlyGivesAWarning) {
    std::ofstream(folder / "file") << "not a folder";
    const test::ProcessResult said = render_with_cache_home((folder / "file").string());
    EXPECT_EQ(said.exit_code, 0);
    EXPECT_THAT(said.err, testing::AllOf(testing::HasSubstr("cannot be created"),
                                         testing::HasSubstr("XDG_CACHE_HOME")));
    EXPECT_EQ(std::ranges::count(said.err, '\n'), 1) << said.err;
    EXPECT_EQ(read_output_file("file"), "not a folder");
}

} // namespace
