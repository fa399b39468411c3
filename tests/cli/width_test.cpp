// Vectors of the software driver: which width runs, and what the environment asks for.
#include "cli/program.hpp"

namespace {

class Width : public Cli {
protected:
    /// With a cache of compiled shaders in this folder.
    test::Ended info(const std::string& width, const std::string& cache) const {
        test::Start asked = start({"info", "--json"});
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
    static int lanes(const test::Ended& ended) {
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return nlohmann::json::parse(ended.out)["device"]["lanes"].get<int>();
    }
};

TEST_F(Width, IsCountedByADispatch) {
    const test::Ended wide = info("256", "wide"), narrow = info("128", "narrow");
    EXPECT_EQ(lanes(wide), 8);
    EXPECT_EQ(lanes(narrow), 4);
    EXPECT_EQ(wide.err + narrow.err, "");
}

/// The driver's cache holds code of one width under the other's name: what runs is said.
TEST_F(Width, OtherThanAskedForIsWarnedOf) {
    EXPECT_EQ(lanes(info("256", "shared")), 8);
    const test::Ended stale = info("128", "shared");
    EXPECT_EQ(lanes(stale), 8);
    EXPECT_THAT(stale.err, testing::HasSubstr("warning: LP_NATIVE_VECTOR_WIDTH asks for vectors of "
                                              "128 bits, the driver runs code of 256 bits"));
}

/// A width whose code crashes is refused before the device is opened.
TEST_F(Width, ThatTheDriverCannotRunIsRefused) {
    for (const std::string width : {"512", "64", "1024", "0", "0x200", "-1"}) {
        test::Start asked = start(
            {"render", "--technique", "hybrid:face=16", "--size", "16x16", "-o", "x.png"});
        asked.environment = {{"MESA_SHADER_CACHE_DIR", (folder / "cold").string()},
                             {"LP_NATIVE_VECTOR_WIDTH", width}};
        expect_ended(test::run_process(asked), 69,
                     {"LP_NATIVE_VECTOR_WIDTH: wanted 128, 256 or none, found " + width});
        EXPECT_EQ(info(width, "cold").exit_code, 0) << "info says why there is no device";
    }
}

} // namespace
