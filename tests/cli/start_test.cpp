// Tests of the libraries that the program loads, and of the error if the image module is missing.
// The image module is a plug-in that reads pictures with OpenImageIO.
#include "cli/program.hpp"

namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

class ProgramStartCliTest : public CommandLineTest {
protected:
    static constexpr const char* kLibrary = "libOpenImageIO.so";

    /// Runs the program so that the dynamic linker prints the libraries that it loads to stderr.
    test::ProcessResult run_with_library_trace(const Words& words) const {
        test::ProcessStartOptions asked = make_process_start(words);
        asked.environment = {{"LD_DEBUG", "files"}};
        return test::run_process(asked);
    }
    /// Writes a.hdr, a Radiance file of one grey pixel. The program reads it with OpenImageIO.
    void write_radiance_picture() const {
        write_input_file("a.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\n"
                                  "\x80\x80\x80\x81");
    }
};

TEST_F(ProgramStartCliTest, OpenImageIoIsLoadedOnlyIfAFileNeedsIt) {
    const auto expect_none = [&](const Words& words) {
        const test::ProcessResult ended = run_with_library_trace(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        EXPECT_THAT(ended.err, HasSubstr("libstdc++.so")) << "nothing was traced";
        EXPECT_THAT(ended.err, Not(HasSubstr(kLibrary))) << words.front();
    };
    expect_none({"--version"});
    for (const std::string picture : {"a.png", "a.exr"}) {
        expect_none(add_small_frame_options(
            {"render", "--technique", "raytrace:depth=0,shadow=none", "-o", picture}));
        expect_none({"diff", picture, picture});
    }
    write_radiance_picture();
    const test::ProcessResult reading = run_with_library_trace({"diff", "a.hdr", "a.hdr"});
    EXPECT_EQ(reading.exit_code, 0) << reading.err;
    EXPECT_THAT(reading.err, HasSubstr(kLibrary));
}

/// If memory ends while OpenImageIO is loaded, the error names memory and not a broken module.
TEST_F(ProgramStartCliTest, NoMemoryForOpenImageIoExitsWith75) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer itself takes address space without end";
#endif
    write_radiance_picture();
    test::ProcessStartOptions limited = make_process_start({"diff", "a.hdr", "a.hdr"});
    limited.memory_limit = 400 << 20;
    expect_exit_code(test::run_process(limited), 75, {"no memory for OpenImageIO", "ulimit -v"});
}

/// Fixture with the program in bin/, as it is installed. Tests put the image module into lib/ or
/// leave it out.
class Installed : public ProgramStartCliTest {
protected:
    void SetUp() override {
        write_radiance_picture();
        fs::create_directories(modules);
        fs::create_directories(program.parent_path());
        std::error_code other_disk;
        fs::create_hard_link(CATOPTRIC_CLI, program, other_disk);
        if (other_disk) fs::copy_file(CATOPTRIC_CLI, program);
    }
    test::ProcessResult run_installed_program(const Words& words) const {
        test::ProcessStartOptions asked = make_process_start(words);
        asked.command.front() = program.string();
        asked.environment = {{"VK_DRIVER_FILES", "/none"}}; // no driver is needed
        return test::run_process(asked);
    }
    void expect_missing_image_module(const Words& words, const Words& parts) const {
        const test::ProcessResult ended = run_installed_program(words);
        expect_exit_code(ended, 70, parts);
        expect_exit_code(ended, 70,
                         {"pictures other than PNG and usual OpenEXR files cannot be read: ",
                          "; this module comes with catoptric and wants OpenImageIO 2.4: "
                          "apt-get install libopenimageio2.4"});
    }
    const Words diff = {"diff", "a.hdr", "a.hdr"};
    const fs::path program = folder / "bin/catoptric";
    const fs::path modules =
        (program.parent_path() / CATOPTRIC_MODULES_FROM_PROGRAMS).lexically_normal();
    const fs::path module = modules / "catoptric-images.so";
};

TEST_F(Installed, ProgramFindsTheImageModule) {
    fs::create_symlink(CATOPTRIC_IMAGES, module);
    EXPECT_EQ(run_installed_program(diff).exit_code, 0) << run_installed_program(diff).err;
    fs::rename(module, folder / "bin/catoptric-images.so");
    EXPECT_EQ(run_installed_program(diff).exit_code, 0) << run_installed_program(diff).err;
}

TEST_F(Installed, ErrorListsTheFoldersSearchedForTheImageModule) {
    const std::string bin = program.parent_path().string();
    const Words places = {"catoptric-images.so is in none of " + bin + ", " + bin + "/catoptric, " +
                          modules.string() + "; "};
    expect_missing_image_module(diff, places);
    expect_missing_image_module(
        {"render", "--technique", "reuse", "--environment", "a.hdr", "-o", "b.exr"}, places);
    EXPECT_FALSE(fs::exists(folder / "b.exr"));
    EXPECT_EQ(run_installed_program({"--version"}).exit_code, 0);
}

TEST_F(Installed, ErrorSaysWhyTheImageModuleCannotBeLoaded) {
    write_input_file(fs::relative(module, folder).string(), "no library");
    expect_missing_image_module(diff, {module.string() + " cannot be loaded: "});
    fs::remove(module);
    fs::create_symlink(CATOPTRIC_LIBRARY, module);
    expect_exit_code(run_installed_program(diff), 70,
                     {module.string() + " is of another version: wanted catoptric_image_codecs_3"});
}

} // namespace
