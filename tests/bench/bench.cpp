// Ratios that the documentation quotes: pairs of runs, interleaved in one process, since times here
// drift and only ratios inside one run are sound. Prints medians with spread; judges nothing.
#include "app/engine.hpp"
#include "measure/statistics.hpp"

#include <cstdio>
#include <cstdlib>
#include <exception>

namespace {

using namespace catoptric;

/// One side of a pair: an engine and a technique.
struct Side {
    const char* name;
    app::Engine engine;
    std::string technique;
};

double one_frame_ms(Side& side, const app::Request& base) {
    app::Request request = base;
    request.techniques = {side.technique};
    std::vector<double> samples;
    for (const app::Frame& frame : side.engine.run(request).frames) samples.push_back(frame.gpu_ms);
    return measure::summarise(samples).median;
}

void compare(const char* title, Side& a, Side& b, const app::Request& base, int rounds) {
    std::vector<double> a_ms, b_ms, ratios;
    for (int i = 0; i < rounds; ++i) {
        a_ms.push_back(one_frame_ms(a, base));
        b_ms.push_back(one_frame_ms(b, base));
        ratios.push_back(a_ms.back() / b_ms.back());
    }
    const measure::Summary ratio = measure::summarise(ratios);
    std::printf("%s\n  %-28s %8.2f ms\n  %-28s %8.2f ms\n  ratio %.3f [%.3f, %.3f] over %d pairs\n", title, a.name,
                measure::summarise(a_ms).median, b.name, measure::summarise(b_ms).median, ratio.median, ratio.p05, ratio.p95, rounds);
}

} // namespace

int main(int argc, char** argv) try {
    const int rounds = argc > 1 ? std::max(1, std::atoi(argv[1])) : 7;
    app::Request base;
    base.scene = scene::cornell_mirrors();
    base.camera = base.scene.cameras.front();
    base.frames = 5;
    base.warmup = 3;
    Side fast{"default", app::Engine({}), "raytrace:depth=4"};
    Side naive{"naive", app::Engine({.shader_variants = {{"raytrace.comp", "raytrace.comp#naive"}}}), "raytrace:depth=4"};
    std::printf("%s, %s\n", fast.engine.device().name.c_str(), fast.engine.device().driver.c_str());
    compare("raytrace:depth=4 512x512: texel buffers, shared stack, scattered groups against storage buffers, "
            "private stack, groups in order", fast, naive, base, rounds);
    Side layered{"six faces in one pass", app::Engine({}), "parallax"};
    Side faces{"six passes", app::Engine({.layered = false}), "parallax"};
    compare("parallax 512x512: captures in layered passes against one pass a face", layered, faces, base, rounds);
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "catoptric_bench: %s\n", error.what());
    return 1;
}
