// The main function of every test program. `--from FILE` runs only the tests of that source file.
// They run in one process, so that they share devices, compiled shaders and rendered pictures.
// If CATOPTRIC_TEST_SECONDS names a folder, the processor time of each test is written to a file in
// this folder. `./dev test` prints the slowest tests.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <string>

#include <sys/resource.h>
#include <unistd.h>

namespace {

/// Returns the processor time of this process with its driver's threads, plus that of the child
/// processes that it has waited for.
double read_processor_seconds() {
    double seconds = 0;
    for (const int who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
        rusage usage{};
        getrusage(who, &usage);
        for (const timeval& time : {usage.ru_utime, usage.ru_stime})
            seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    }
    return seconds;
}

class TestTimeWriter : public testing::EmptyTestEventListener {
public:
    explicit TestTimeWriter(const std::filesystem::path& folder) {
        std::filesystem::create_directories(folder);
        file_.open(folder / (std::to_string(getpid()) + ".tsv"));
    }

private:
    void OnTestStart(const testing::TestInfo&) override { start_ = read_processor_seconds(); }
    void OnTestEnd(const testing::TestInfo& info) override {
        file_ << read_processor_seconds() - start_ << '\t' << info.test_suite_name() << '.'
              << info.name() << '\t' << std::filesystem::path(info.file()).filename().string()
              << std::endl;
    }

    std::ofstream file_;
    double start_ = 0;
};

/// Returns a GoogleTest filter with the names of all tests of a source file; empty if the file has
/// no tests.
std::string find_test_filter_in_arguments(const std::string& file) {
    std::string filter;
    const testing::UnitTest& all = *testing::UnitTest::GetInstance();
    for (int s = 0; s < all.total_test_suite_count(); ++s) {
        const testing::TestSuite& suite = *all.GetTestSuite(s);
        for (int t = 0; t < suite.total_test_count(); ++t) {
            const testing::TestInfo& test = *suite.GetTestInfo(t);
            if (std::filesystem::path(test.file()).filename() == file)
                filter += std::string(suite.name()) + "." + test.name() + ":";
        }
    }
    return filter;
}

} // namespace

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    if (argc > 2 && std::string(argv[1]) == "--from") {
        const std::string filter = find_test_filter_in_arguments(argv[2]);
        if (filter.empty()) {
            std::cerr << "wanted tests from " << argv[2] << ", found none\n";
            return 1;
        }
        GTEST_FLAG_SET(filter, filter);
    }
    if (const char* folder = std::getenv("CATOPTRIC_TEST_SECONDS"))
        testing::UnitTest::GetInstance()->listeners().Append(new TestTimeWriter(folder));
    return RUN_ALL_TESTS();
}
