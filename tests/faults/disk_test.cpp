// Tests of failure R5 of docs/extremes.md: every output file meets a full disk, a limit of file
// size, a folder that takes no files, or a folder of its own name. The program exits with 73 or 74,
// keeps the old file and leaves no temporary file.
#include "faults/faults.hpp"

#include <cstring>

#include <sys/mount.h>

namespace {

namespace fs = std::filesystem;

class DiskErrorTest : public CommandLineTest {
protected:
    /// The files that a comparison writes, in the order of writing.
    const Words files = {"images/reference.png",
                         "images/raytrace.exr",
                         "images/raytrace.png",
                         "images/raytrace-error.png",
                         "rows.csv",
                         "report.md",
                         "report.html",
                         "report.json"};

    static Words make_compare_arguments(const std::string& into) {
        return {"compare", "-o",       into, "--size",  "16x16",        "--frames",
                "1",       "--warmup", "0",  "--quiet", "--techniques", "raytrace"};
    }
    Words make_picture_words(const std::string& path) const {
        return {"render",   "--technique", "raytrace:depth=1", "--size", "64x64", "--frames", "1",
                "--warmup", "0",           "--quiet",          "-o",     path};
    }
    /// Returns the temporary files that interrupted writes left behind.
    Words list_leftover_temporaries() const {
        Words found;
        for (const auto& entry : fs::recursive_directory_iterator(folder))
            if (entry.path().filename().string().find(".partial-") != std::string::npos)
                found.push_back(entry.path());
        return found;
    }

    /// Runs a comparison for each output file, after `prepare(path)` made that file impossible to
    /// write. Expects the exit code and a message with the path and `why`.
    void
    compare_while_each_file_is_unwritable(const std::function<void(const fs::path& file)>& prepare,
                                          int exit_code, const std::string& why) const {
        run_on_two_threads(files.size(), [&](std::size_t i) {
            const std::string out = "out-" + std::to_string(i);
            const fs::path file = folder / out / files[i];
            fs::create_directories(file.parent_path());
            prepare(file);
            expect_exit_code(run_cli(make_compare_arguments(out)), exit_code,
                             {out + "/" + files[i], why});
        });
        EXPECT_EQ(list_leftover_temporaries(), Words{});
    }
};

/// A small file system in memory (tmpfs) mounted at a folder. The destructor unmounts it.
struct FullFileSystem {
    explicit FullFileSystem(fs::path folder) : mount_path(std::move(folder)) {
        fs::create_directories(mount_path);
        mounted = ::mount("tmpfs", mount_path.c_str(), "tmpfs", 0, "size=64k") == 0;
        why = std::strerror(errno);
    }
    ~FullFileSystem() {
        if (mounted) ::umount(mount_path.c_str());
    }
    /// Fills the file system, so that all further writes fail.
    void fill_file_system() const {
        std::ofstream filler(mount_path / "filler", std::ios::binary);
        for (char page[4096] = {}; filler.write(page, sizeof page).flush();) {
        }
    }
    fs::path mount_path;
    bool mounted = false;
    std::string why;
};

TEST_F(DiskErrorTest, FullDiskKeepsTheOldFilesOfAComparison) {
    const FullFileSystem disk(folder / "disk");
    if (!disk.mounted) GTEST_SKIP() << "cannot mount a small tmpfs: " << disk.why;
    for (const std::string& name : files)
        write_input_file("disk/" + fs::path(name).filename().string(), "old");
    disk.fill_file_system();
    compare_while_each_file_is_unwritable(
        [&](const fs::path& file) { fs::create_symlink(disk.mount_path / file.filename(), file); },
        74, "No space left on device");
    for (const std::string& name : files)
        EXPECT_EQ(read_file_at_path(disk.mount_path / fs::path(name).filename()), "old");
}

TEST_F(DiskErrorTest, FullDiskKeepsTheOldPictureAndTrace) {
    const FullFileSystem disk(folder / "disk");
    if (!disk.mounted) GTEST_SKIP() << "cannot mount a small tmpfs: " << disk.why;
    for (const char* name : {"x.exr", "x.png", "t.json"})
        write_input_file(std::string("disk/") + name, "old");
    disk.fill_file_system();
    for (const std::string name : {"disk/x.exr", "disk/x.png"}) {
        expect_exit_code(run_cli(make_picture_words(name)), 74, {name, "No space left on device"});
        EXPECT_EQ(read_output_file(name), "old");
    }
    Words words = make_picture_words("y.png");
    words.insert(words.end(), {"--trace", "disk/t.json"});
    expect_exit_code(run_cli(words), 74, {"disk/t.json", "No space left on device"});
    EXPECT_EQ(read_output_file("disk/t.json"), "old");
    EXPECT_EQ(list_leftover_temporaries(), Words{});
}

/// The limit of file size (`ulimit -f`) breaks off a write in the middle of a file. Unlike a
/// mounted full disk, this test needs no privilege.
TEST_F(DiskErrorTest, FileSizeLimitEndsInAnErrorAndNotASignal) {
    for (const std::string name : {"x.exr", "x.png"}) {
        write_input_file(name, "old");
        test::ProcessStartOptions process = make_process_start(make_picture_words(name));
        process.file_limit = 512;
        expect_exit_code(test::run_process(process), 74, {name, "File too large"});
        EXPECT_EQ(read_output_file(name), "old");
    }
    fs::create_directory(folder / "out");
    write_input_file("out/report.json", "old");
    Words words = make_compare_arguments("out");
    words.insert(words.end(), {"--csv", "all"});
    test::ProcessStartOptions process = make_process_start(words);
    process.file_limit = 4096; // bytes: pictures are smaller, rows.csv is larger
    expect_exit_code(test::run_process(process), 74, {"out/rows.csv: ", "File too large"});
    EXPECT_EQ(read_output_file("out/report.json"), "old");
    EXPECT_EQ(list_leftover_temporaries(), Words{});
}

/// Not even root can make files in /proc. Permissions would not stop root in another folder.
TEST_F(DiskErrorTest, FolderThatTakesNoFilesExitsWith73) {
    if (!fs::is_directory("/proc/self"))
        GTEST_SKIP() << "no /proc, a folder in which not even root can make a file";
    compare_while_each_file_is_unwritable(
        [](const fs::path& file) { fs::create_symlink("/proc" / file.filename(), file); }, 73,
        "cannot be created");
    for (const std::string name : {"/proc/x.exr", "/proc/x.png"})
        expect_exit_code(run_cli(make_picture_words(name)), 73, {name, "cannot be created"});
    Words words = make_picture_words("y.png");
    words.insert(words.end(), {"--trace", "/proc/t.json"});
    expect_exit_code(run_cli(words), 73, {"/proc/t.json", "cannot be created"});
    expect_exit_code(run_cli(make_compare_arguments("/proc/out")), 73, {"/proc/out"});
}

TEST_F(DiskErrorTest, ReadOnlyFolderExitsWith73) {
    const FullFileSystem disk(folder / "disk");
    if (!disk.mounted) GTEST_SKIP() << "cannot mount a small tmpfs: " << disk.why;
    write_input_file("disk/x.exr", "old");
    fs::create_directory(folder / "disk/out");
    if (::mount("tmpfs", disk.mount_path.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "size=64k") != 0)
        GTEST_SKIP() << "cannot make a tmpfs read-only: " << std::strerror(errno);
    expect_exit_code(run_cli(make_picture_words("disk/x.exr")), 73,
                     {"disk/x.exr", "Read-only file system"});
    EXPECT_EQ(read_output_file("disk/x.exr"), "old");
    expect_exit_code(run_cli(make_compare_arguments("disk/out")), 73,
                     {"disk/out", "Read-only file system"});
}

TEST_F(DiskErrorTest, FolderInPlaceOfAnOutputFileExitsWith73) {
    compare_while_each_file_is_unwritable([](const fs::path& file) { fs::create_directory(file); },
                                          73, "found a folder");
}

} // namespace
