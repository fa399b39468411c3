#include "core/file.hpp"

#include "core/error.hpp"
#include "support/folder.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <future>

#include <sys/wait.h>
#include <unistd.h>

namespace {

namespace fs = std::filesystem;
using catoptric::Error;
using catoptric::Failure;
using testing::HasSubstr;

class File : public test::InFolder {
protected:
    std::ptrdiff_t count_folder_entries() const {
        return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
    }
};

template <typename Body>
Error catch_error_of(Body&& body) {
    try {
        body();
    } catch (const Error& error) {
        return error;
    }
    return Error(Failure::internal, "nothing was thrown");
}

TEST_F(File, WrittenFileIsReadBackByteForByte) {
    const std::string first("a\0b\r\n\xff", 6);
    catoptric::write_file(folder / "x", first);
    EXPECT_EQ(catoptric::read_file(folder / "x"), first);
    catoptric::write_file(folder / "x", std::string_view());
    EXPECT_EQ(catoptric::read_file(folder / "x"), "");
    EXPECT_EQ(count_folder_entries(), 1);
}

/// Another program writes the partial file.
TEST_F(File, PartialFileTakesThePlaceOfTheOldFileOrIsRemoved) {
    catoptric::write_file(folder / "x", "old");
    fs::permissions(folder / "x", fs::perms::owner_read | fs::perms::owner_write);
    {
        const catoptric::PartialFile partial(folder / "x");
        std::ofstream(partial.temporary()) << "half";
        EXPECT_EQ(partial.temporary().parent_path(), folder);
    }
    EXPECT_EQ(catoptric::read_file(folder / "x"), "old");
    EXPECT_EQ(count_folder_entries(), 1);
    {
        catoptric::PartialFile partial(folder / "x");
        std::ofstream(partial.temporary()) << "new";
        partial.copy_mode();
        partial.commit();
    }
    EXPECT_EQ(catoptric::read_file(folder / "x"), "new");
    EXPECT_EQ(fs::status(folder / "x").permissions(),
              fs::perms::owner_read | fs::perms::owner_write);
    EXPECT_EQ(count_folder_entries(), 1);
    catoptric::PartialFile unwritten(folder / "y");
    EXPECT_THAT(catch_error_of([&] { unwritten.commit(); }).what(),
                HasSubstr("y: cannot be replaced"));
    for (const auto& [path, found] : {std::pair<fs::path, const char*>{folder, "found a folder"},
                                      {"/dev/null", "found a device or pipe"}})
        EXPECT_THAT(catch_error_of([&] { const catoptric::PartialFile refused(path); }).what(),
                    HasSubstr(found));
}

/// write_file removes the partial file of a process that ended while writing. Partial files of
/// running processes stay.
TEST_F(File, PartialFilesOfEndedProcessesAreRemoved) {
    const pid_t dead = ::fork();
    if (dead == 0) ::_exit(0);
    ::waitpid(dead, nullptr, 0);
    const std::string stale = "x.partial-" + std::to_string(dead); // of a process that ended
    for (const std::string& name :
         {stale, stale + "-1", stale + "-keep", "x.partial-" + std::to_string(::getppid()) + "-1",
          std::string("x.partial-1k"), std::string("y.partial-") + std::to_string(dead)})
        std::ofstream(folder / name) << "part";
    catoptric::write_file(folder / "x", "whole");
    EXPECT_FALSE(fs::exists(folder / stale));
    EXPECT_FALSE(fs::exists(folder / (stale + "-1")));
    EXPECT_EQ(count_folder_entries(), 5)
        << "x, a living process's, two that are no temporaries, and another file's";
}

/// Several engines of one process may write the same file, such as a cache, each in its thread.
TEST_F(File, ThreadsThatWriteTheSameFileReplaceItWhole) {
    const std::string one(1 << 20, 'a'), other(1 << 20, 'b');
    const auto write_often = [&](const std::string& content) {
        for (int i = 0; i < 40; ++i) catoptric::write_file(folder / "x", content);
    };
    std::future<void> beside = std::async(std::launch::async, write_often, other);
    EXPECT_NO_THROW(write_often(one));
    EXPECT_NO_THROW(beside.get());
    const std::string found = catoptric::read_file(folder / "x");
    EXPECT_TRUE(found == one || found == other) << found.size() << " bytes of both writers";
    EXPECT_EQ(count_folder_entries(), 1);
}

/// Replacing a file neither adds nor removes permissions. The permissions are set before the bytes
/// are written.
TEST_F(File, ReplacedFileKeepsItsPermissions) {
    for (const fs::perms mode : {fs::perms(0600), fs::perms(0444), fs::perms(0775)}) {
        catoptric::write_file(folder / "x", "old");
        fs::permissions(folder / "x", mode);
        catoptric::write_file(folder / "x", "new");
        EXPECT_EQ(fs::status(folder / "x").permissions(), mode);
        EXPECT_EQ(catoptric::read_file(folder / "x"), "new");
    }
    fs::create_symlink("x", folder / "link");
    catoptric::write_file(folder / "link", "through a link");
    EXPECT_EQ(fs::status(folder / "x").permissions(), fs::perms(0775));
}

TEST_F(File, RealPathResolvesAllLinks) {
    using catoptric::real_path;
    const fs::path real = fs::canonical(folder);
    fs::create_directories(folder / "a/b");
    fs::create_directory_symlink("a/b", folder / "short");
    fs::create_symlink("a/missing.txt", folder / "dangling");
    fs::create_symlink("../dangling", folder / "a/twice");
    EXPECT_EQ(real_path(folder / "short/../b/./x"), real / "a/b/x");
    EXPECT_EQ(real_path(folder / "dangling"), real / "a/missing.txt");
    EXPECT_EQ(real_path(folder / "a/twice"), real / "a/missing.txt");
    EXPECT_EQ(real_path(folder / "no/../such/folder/x"), real / "such/folder/x");
    EXPECT_EQ(real_path("x"), fs::canonical(".") / "x");
    // On a loop of links, real_path must end nevertheless.
    fs::create_symlink("loop", folder / "loop");
    EXPECT_EQ(real_path(folder / "loop"), folder / "loop");
}

TEST_F(File, WritingToALinkWritesTheTarget) {
    fs::create_symlink("real", folder / "link");
    catoptric::write_file(folder / "link", "text");
    EXPECT_TRUE(fs::is_symlink(folder / "link"));
    EXPECT_EQ(catoptric::read_file(folder / "real"), "text");
}

TEST_F(File, WritingIntoAMissingFolderIsAnError) {
    const Error error = catch_error_of([&] { catoptric::write_file(folder / "no" / "x", "text"); });
    EXPECT_EQ(error.failure, Failure::cannot_create);
    EXPECT_THAT(error.what(), HasSubstr((folder / "no" / "x").string()));
}

TEST_F(File, ReadingOrWritingAFolderIsAnError) {
    EXPECT_EQ(catch_error_of([&] { catoptric::write_file(folder, "text"); }).failure,
              Failure::cannot_create);
    EXPECT_EQ(catch_error_of([&] { catoptric::read_file(folder); }).failure,
              Failure::missing_input);
}

TEST_F(File, WritingToAFullDeviceIsAnIoError) {
    if (!fs::is_character_file("/dev/full")) GTEST_SKIP() << "no /dev/full";
    const Error error = catch_error_of([] { catoptric::write_file("/dev/full", "text"); });
    EXPECT_EQ(error.failure, Failure::io);
    EXPECT_THAT(error.what(), HasSubstr("/dev/full"));
    EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

TEST_F(File, TooLongNameLeavesNoPartialFile) {
    const Error error = catch_error_of(
        [&] { catoptric::write_file(folder / std::string(300, 'x'), "t"); });
    EXPECT_EQ(error.failure, Failure::cannot_create);
    EXPECT_EQ(count_folder_entries(), 0);
}

TEST_F(File, ReadingAMissingFileIsAMissingInputError) {
    const Error error = catch_error_of([&] { catoptric::read_file(folder / "gone"); });
    EXPECT_EQ(error.failure, Failure::missing_input);
    EXPECT_THAT(error.what(), HasSubstr("gone"));
}

} // namespace
