// Test that pictures have the same bytes whether or not the software driver optimises shaders
// (GALLIVM_PERF=nopt). Most tests of pictures rely on this (QUICK_SHADERS in tests/CMakeLists.txt).
#include "cli/program.hpp"

namespace {

class QuickShaders : public CommandLineTest, public testing::WithParamInterface<const char*> {
protected:
    /// Returns the bytes of a small picture with linear colours. The driver's shader cache is off.
    std::string render_with_driver_options(const std::string& scene, const std::string& options) {
        test::ProcessStartOptions asked = make_process_start(
            {"render", scene, "--technique", GetParam(), "--size", "48x32", "-o", "a.exr", "-q"});
        asked.environment = {{"MESA_SHADER_CACHE_DISABLE", "true"}, {"GALLIVM_PERF", options}};
        EXPECT_EQ(test::run_process(asked).exit_code, 0);
        return read_output_file("a.exr");
    }
};

TEST_P(QuickShaders, DrawTheBytesOfOptimisedShaders) {
    for (const std::string scene : {"cornell-mirrors", "cornell-rough"}) {
        const std::string optimised = render_with_driver_options(scene, "");
        ASSERT_FALSE(optimised.empty());
        EXPECT_EQ(render_with_driver_options(scene, "nopt"), optimised) << scene;
    }
}

INSTANTIATE_TEST_SUITE_P(Techniques, QuickShaders,
                         testing::Values("secant:face=32", "raytrace:depth=3"),
                         [](const auto& tested) {
                             const std::string name = tested.param;
                             return name.substr(0, name.find(':'));
                         });

} // namespace
