// The shipped files are the built-in scene.
#include "support/rendering.hpp"

#include <iostream>

namespace {

using namespace catoptric;

class Shipped : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Files, Shipped, testing::Values("glb", "obj"), [](const auto& instance) { return std::string(instance.param); });

TEST_P(Shipped, RendersAsTheBuiltInScene) {
    const scene::Scene built_in = scene::cornell_mirrors();
    const scene::Scene loaded = scene::load(std::string(CATOPTRIC_SOURCE_DIR "/samples/scenes/cornell-mirrors.") + GetParam());
    for (const char* technique : {"raytrace", "parallax"})
        for (const double time : {0.0, 0.7}) {
            app::Request request = test::request(built_in, {technique}, {256, 256});
            request.time = time, request.frames = 3;
            const measure::Picture wanted = test::engine().run(request).parts.front().hdr;
            request.scene = loaded, request.camera = loaded.cameras.at(0);
            const double error = test::rmse(test::engine().run(request).parts.front().hdr, wanted);
            std::cout << "[ MEASURED ] ." << GetParam() << ", " << technique << " at " << time << " s: rmse " << error << "\n";
            EXPECT_LE(error, 1e-3);
        }
}

} // namespace
