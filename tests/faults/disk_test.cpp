// R5: every kind of file that is written meets a full disk, a limit of file size, a folder that takes no files and
// a folder of its own name: 73 or 74, the old file intact, no temporary left.
#include "cli/program.hpp"

#include <cstring>

#include <sys/mount.h>

namespace {

namespace fs = std::filesystem;

class Disk : public Cli {
protected:
    /// The files of a comparison, in the order in which they are written.
    const Words files = {"images/reference.png", "images/parallax.exr", "images/parallax.png", "images/parallax-error.png",
                         "rows.csv", "report.md", "report.html", "report.json"};

    /// A small comparison into out/, whose row is called "parallax".
    static Words comparison() {
        return {"compare", "-o", "out", "--size", "16x16", "--frames", "1", "--warmup", "0", "--no-causes", "--quiet", "--techniques", "parallax"};
    }
    Words picture(const std::string& path) const {
        return {"render", "--technique", "raytrace:depth=1", "--size", "64x64", "--frames", "1", "--warmup", "0", "--quiet", "-o", path};
    }
    /// Everything below a folder that is no file or link of the names above.
    Words strays(const fs::path& below) const {
        Words found;
        for (const auto& entry : fs::recursive_directory_iterator(below))
            if (entry.path().filename().string().find(".partial-") != std::string::npos) found.push_back(entry.path());
        return found;
    }

    /// A comparison whose file `name` lies, by a link, in `place` (below the test's folder): exit code and message.
    void compare_with_link(const std::string& name, const fs::path& place, int exit_code, const Words& parts) const {
        fs::remove_all(folder / "out");
        fs::create_directories((folder / "out" / name).parent_path());
        fs::create_symlink(place, folder / "out" / name);
        expect_ended(cli(comparison()), exit_code, parts);
        EXPECT_EQ(strays(folder), Words{}) << name;
    }
};

/// A folder in memory with no room left, gone at the end.
struct FullDisk {
    explicit FullDisk(fs::path folder) : path(std::move(folder)) {
        fs::create_directories(path);
        mounted = ::mount("tmpfs", path.c_str(), "tmpfs", 0, "size=64k") == 0;
        why = std::strerror(errno);
    }
    ~FullDisk() {
        if (mounted) ::umount(path.c_str());
    }
    /// After this nothing more can be written.
    void fill() const {
        std::ofstream filler(path / "filler", std::ios::binary);
        for (char page[4096] = {}; filler.write(page, sizeof page).flush();) {}
    }
    fs::path path;
    bool mounted = false;
    std::string why;
};

TEST_F(Disk, FullForEveryFileOfAComparison) {
    const FullDisk disk(folder / "disk");
    if (!disk.mounted) GTEST_SKIP() << "cannot mount a small tmpfs: " << disk.why;
    for (const std::string& name : files) write("disk/" + fs::path(name).filename().string(), "old");
    disk.fill();
    for (const std::string& name : files) {
        const fs::path target = disk.path / fs::path(name).filename();
        compare_with_link(name, target, 74, {"out/" + name, "No space left on device"});
        EXPECT_EQ(read_path(target), "old");
    }
}

TEST_F(Disk, FullForAPictureAndItsTrace) {
    const FullDisk disk(folder / "disk");
    if (!disk.mounted) GTEST_SKIP() << "cannot mount a small tmpfs: " << disk.why;
    for (const char* name : {"x.exr", "x.png", "t.json"}) write(std::string("disk/") + name, "old");
    disk.fill();
    for (const std::string name : {"disk/x.exr", "disk/x.png"}) {
        expect_ended(cli(picture(name)), 74, {name, "No space left on device"});
        EXPECT_EQ(read(name), "old");
    }
    Words words = picture("y.png");
    words.insert(words.end(), {"--trace", "disk/t.json"});
    expect_ended(cli(words), 74, {"disk/t.json", "No space left on device"});
    EXPECT_EQ(read("disk/t.json"), "old");
    EXPECT_EQ(strays(folder), Words{});
}

/// Needs no privilege, and breaks off in the middle of the file: `ulimit -f`.
TEST_F(Disk, LimitOfFileSizeEndsAsAnErrorAndNotAsASignal) {
    for (const std::string name : {"x.exr", "x.png"}) {
        write(name, "old");
        test::Start process = start(picture(name));
        process.file_limit = 512;
        expect_ended(test::run_process(process), 74, {name, "File too large"});
        EXPECT_EQ(read(name), "old");
    }
    fs::create_directory(folder / "out");
    write("out/report.json", "old");
    test::Start process = start(comparison());
    process.file_limit = 2048; // the pictures are smaller, the page is larger
    expect_ended(test::run_process(process), 74, {"out/report.", "File too large"});
    EXPECT_EQ(read("out/report.json"), "old");
    EXPECT_EQ(strays(folder), Words{});
}

/// Nobody may make files in /proc, not even root, whom permissions do not stop.
TEST_F(Disk, FolderThatTakesNoFiles) {
    if (!fs::is_directory("/proc/self")) GTEST_SKIP() << "no /proc, a folder in which not even root can make a file";
    for (const std::string& name : files)
        compare_with_link(name, "/proc/" + fs::path(name).filename().string(), 73, {"out/" + name, "cannot be created"});
    for (const std::string name : {"/proc/x.exr", "/proc/x.png"}) expect_ended(cli(picture(name)), 73, {name, "cannot be created"});
    Words words = picture("y.png");
    words.insert(words.end(), {"--trace", "/proc/t.json"});
    expect_ended(cli(words), 73, {"/proc/t.json", "cannot be created"});
    expect_ended(cli({"compare", "-o", "/proc/out", "--size", "16x16", "--frames", "1", "--warmup", "0", "--techniques", "raytrace"}), 73, {"/proc/out"});
}

TEST_F(Disk, ReadOnlyFolder) {
    const FullDisk disk(folder / "disk");
    if (!disk.mounted) GTEST_SKIP() << "cannot mount a small tmpfs: " << disk.why;
    write("disk/x.exr", "old");
    fs::create_directory(folder / "disk/out");
    if (::mount("tmpfs", disk.path.c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "size=64k") != 0)
        GTEST_SKIP() << "cannot make a tmpfs read-only: " << std::strerror(errno);
    expect_ended(cli(picture("disk/x.exr")), 73, {"disk/x.exr", "Read-only file system"});
    EXPECT_EQ(read("disk/x.exr"), "old");
    const test::Ended ended = cli({"compare", "-o", "disk/out", "--techniques", "raytrace"});
    expect_ended(ended, 73, {"disk/out", "Read-only file system"});
    EXPECT_LT(ended.seconds, 2) << "found out only after the work";
}

TEST_F(Disk, FolderInThePlaceOfEachFile) {
    for (const std::string& name : files) {
        fs::remove_all(folder / "out");
        fs::create_directories(folder / "out" / name);
        expect_ended(cli(comparison()), 73, {"out/" + name, "found a folder"});
        EXPECT_TRUE(fs::is_empty(folder / "out" / name));
        EXPECT_EQ(strays(folder), Words{});
    }
}

} // namespace
