// The engine as a library: the built-in scene, one technique, one picture.
#include <catoptric/app/run.hpp>
#include <catoptric/measure/difference.hpp>
#include <catoptric/measure/picture_file.hpp>
#include <catoptric/measure/statistics.hpp>
#include <catoptric/scene/load.hpp>

#include <cstdio>
#include <exception>

using namespace catoptric;

int main() try {
    app::Request request;
    request.scene = scene::load("cornell-mirrors");
    request.camera = request.scene.cameras.front();
    request.techniques = {"parallax"};
    request.size = {256, 256};

    app::Engine engine({});
    const app::Result result = app::run(engine, request);

    std::vector<double> gpu_ms;
    for (const app::FrameTimes& frame : result.frames) gpu_ms.push_back(frame.gpu_ms);
    const app::Part& part = result.parts.front();
    const measure::Mean mean = measure::mean_of(part.hdr, measure::Range::clamped);
    std::printf("%s on %s: mean %.4f, %.2f ms a frame\n", part.label.c_str(),
                engine.device().name.c_str(), mean.all, measure::summarise(gpu_ms).median);

    measure::write_png(part.display, "hello.png");
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "hello_mirror: %s\n", error.what());
    return 1;
}
