#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include <unistd.h>

namespace test {

/// A test in a folder of its own that is gone after it.
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
