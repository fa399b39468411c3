// Tests of the vector width of the software driver: how many lanes run, and what
// LP_NATIVE_VECTOR_WIDTH sets.
#include "cli/program.hpp"

namespace {

class Width : public Cli {
protected:
    /// Runs `info` with LP_NATIVE_VECTOR_WIDTH set to `width`, unless empty. The driver keeps
    /// compiled shaders in the folder `cache`.
    test::ProcessResult info(const std::string& width, const std::string& cache) const {
        test::ProcessStart asked = start({"info", "--json"});
        asked.environment = {{"MESA_SHADER_CACHE_DIR", (folder / cache).string()}};
        if (!width.empty()) asked.environment["LP_NATIVE_VECTOR_WIDTH"] = width;
        return test::run_process(asked);
    }
    void SetUp() override {
        const nlohmann::json found = nlohmann::json::parse(info("", "probe").out)["device"];
        const std::string driver = found.is_null() ? "" : found["driver"].get<std::string>();
        if (driver.find("llvmpipe Mesa 22.") == std::string::npos)
            GTEST_SKIP() << "another driver: " << driver;
    }
    static int lanes(const test::ProcessResult& ended) {
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return nlohmann::json::parse(ended.out)["device"]["lanes"].get<int>();
    }
};

TEST_F(Width, VectorWidthIsCountedByADispatch) {
    const test::ProcessResult wide = info("256", "wide"), narrow = info("128", "narrow");
    EXPECT_EQ(lanes(wide), 8);
    EXPECT_EQ(lanes(narrow), 4);
    EXPECT_EQ(wide.err + narrow.err, "");
}

/// The driver's shader cache may hold code of another vector width than the user asks for. The
/// program must report the width that runs.
TEST_F(Width, VectorWidthOtherThanAskedForGivesAWarning) {
    EXPECT_EQ(lanes(info("256", "shared")), 8);
    const test::ProcessResult stale = info("128", "shared");
    EXPECT_EQ(lanes(stale), 8);
    EXPECT_THAT(stale.err, testing::HasSubstr("warning: LP_NATIVE_VECTOR_WIDTH asks for vectors of "
                                              "128 bits, the driver runs code of 256 bits"));
}

/// A vector width for which the driver's code crashes is refused before the device is opened.
TEST_F(Width, UnsupportedVectorWidthIsRefused) {
    for (const std::string width : {"512", "64", "1024", "0", "0x200", "-1"}) {
        test::ProcessStart asked = start(
            {"render", "--technique", "hybrid:face=16", "--size", "16x16", "-o", "x.png"});
        asked.environment = {{"MESA_SHADER_CACHE_DIR", (folder / "cold").string()},
                             {"LP_NATIVE_VECTOR_WIDTH", width}};
        expect_ended(test::run_process(asked), 69,
                     {"LP_NATIVE_VECTOR_WIDTH: wanted 128, 256 or none, found " + width});
        EXPECT_EQ(info(width, "cold").exit_code, 0) << "info says why there is no device";
    }
}

} // namespace
