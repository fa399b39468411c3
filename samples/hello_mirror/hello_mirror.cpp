// The engine as a library: a built-in scene, one technique, one picture.
#include <catoptric/error.hpp>
#include <catoptric/picture.hpp>
#include <catoptric/scene.hpp>
#include <catoptric/session.hpp>

#include <cstdio>

using namespace catoptric;

int main() try {
    const scene::Scene scene = scene::load("cornell-mirrors");
    session::Engine engine({});
    session::Session session(engine, scene);

    const session::FrameSpec spec{
        .techniques = {"parallax"}, .camera = scene.cameras.front(), .size = {256, 256}};
    // Mirrors show each other's last captures: each frame adds a bounce.
    for (int bounce = 0; bounce < 7; ++bounce) session.frame(spec).times();
    const session::Frame frame = session.frame(spec);

    const measure::Picture hdr = frame.hdr();
    std::printf("%s: mean %.4f, %.2f ms\n", engine.device().name.c_str(),
                measure::mean_of(hdr, measure::ValueRange::clamped).all, frame.times().gpu_ms);
    measure::write_png(measure::to_display(hdr), "hello.png");
    return 0;
} catch (const NoDevice& error) {
    std::fprintf(stderr, "hello_mirror: no Vulkan device that will do: %s\n", error.what());
    return 69;
} catch (const std::exception& error) {
    std::fprintf(stderr, "hello_mirror: %s\n", error.what());
    return 1;
}
