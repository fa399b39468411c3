#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include <unistd.h>

namespace test {

/// Base class of tests that need files. Creates a folder for each test and removes it afterwards.
class InFolder : public testing::Test {
protected:
    InFolder() { std::filesystem::create_directories(folder); }
    ~InFolder() override {
        std::error_code ignored;
        std::filesystem::remove_all(folder, ignored);
    }

    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() /
        ("catoptric-" + std::to_string(::getpid()) + "-" +
         testing::UnitTest::GetInstance()->current_test_info()->name());
};

} // namespace test
