// Tests of the vector width of the software driver: how many lanes run, and what
// LP_NATIVE_VECTOR_WIDTH sets.
#include "cli/program.hpp"

namespace {

class VectorWidthCliTest : public CommandLineTest {
protected:
    /// Runs `run_info_with_vector_width` with LP_NATIVE_VECTOR_WIDTH set to `width`, unless empty.
    /// The driver keeps compiled shaders in the folder `cache`.
    test::ProcessResult run_info_with_vector_width(const std::string& width,
                                                   const std::string& cache) const {
        test::ProcessStartOptions asked = make_process_start({"info", "--json"});
        asked.environment = {{"MESA_SHADER_CACHE_DIR", (folder / cache).string()}};
        if (!width.empty()) asked.environment["LP_NATIVE_VECTOR_WIDTH"] = width;
        return test::run_process(asked);
    }
    void SetUp() override {
        const nlohmann::json found = nlohmann::json::parse(
            run_info_with_vector_width("", "probe").out)["device"];
        const std::string driver = found.is_null() ? "" : found["driver"].get<std::string>();
        if (driver.find("llvmpipe Mesa 22.") == std::string::npos)
            GTEST_SKIP() << "another driver: " << driver;
    }
    static int read_lane_count(const test::ProcessResult& ended) {
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return nlohmann::json::parse(ended.out)["device"]["lanes"].get<int>();
    }
};

TEST_F(VectorWidthCliTest, VectorWidthIsCountedByADispatch) {
    const test::ProcessResult wide = run_info_with_vector_width("256", "wide"),
                              narrow = run_info_with_vector_width("128", "narrow");
    EXPECT_EQ(read_lane_count(wide), 8);
    EXPECT_EQ(read_lane_count(narrow), 4);
    EXPECT_EQ(wide.err + narrow.err, "");
}

/// The driver's shader cache may hold code of another vector width than the user asks for. The
/// program must report the width that runs.
TEST_F(VectorWidthCliTest, VectorWidthOtherThanAskedForGivesAWarning) {
    EXPECT_EQ(read_lane_count(run_info_with_vector_width("256", "shared")), 8);
    const test::ProcessResult stale = run_info_with_vector_width("128", "shared");
    EXPECT_EQ(read_lane_count(stale), 8);
    EXPECT_THAT(stale.err, testing::HasSubstr("warning: LP_NATIVE_VECTOR_WIDTH asks for vectors of "
                                              "128 bits, the driver runs code of 256 bits"));
}

/// A vector width for which the driver's code crashes is refused before the device is opened.
TEST_F(VectorWidthCliTest, UnsupportedVectorWidthIsRefused) {
    for (const std::string width : {"512", "64", "1024", "0", "0x200", "-1"}) {
        test::ProcessStartOptions asked = make_process_start(
            {"render", "--technique", "hybrid:face=16", "--size", "16x16", "-o", "x.png"});
        asked.environment = {{"MESA_SHADER_CACHE_DIR", (folder / "cold").string()},
                             {"LP_NATIVE_VECTOR_WIDTH", width}};
        expect_exit_code(test::run_process(asked), 69,
                         {"LP_NATIVE_VECTOR_WIDTH: wanted 128, 256 or none, found " + width});
        EXPECT_EQ(run_info_with_vector_width(width, "cold").exit_code, 0)
            << "info says why there is no device";
    }
}

} // namespace
