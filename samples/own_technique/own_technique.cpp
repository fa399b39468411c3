// A technique of our own, with its shader (blend.frag), compared with two built-in ones.
#include <catoptric/compare.hpp>
#include <catoptric/report.hpp>
#include <catoptric/scene.hpp>
#include <catoptric/technique.hpp>

#include <cstdio>

using namespace catoptric;

namespace {

const session::RegisteredSearch kBlendSearch{
    {.name = "blend",
     .summary = "Blends between reuse (amount=0) and parallax (amount=1).",
     .shader = "blend.frag",
     .knobs = {{.name = "amount", .help = "correction strength", .value = .5, .is_real = true}}}};

} // namespace

int main() try {
    study::CompareRequest request;
    request.base.scene = scene::load("cornell-mirrors");
    request.base.camera = request.base.scene.cameras.front();
    request.base.size = {64, 64};
    request.base.frames = 6;
    request.base.techniques = {"reuse:face=64", "blend:amount=0,face=64", "blend:face=64",
                               "blend:amount=1,face=64,lookup=bilinear", "parallax:face=64"};

    report::create_folder("blend-report"); // before the measuring
    session::Engine engine({});
    const measure::Comparison found = study::compare(engine, request);
    for (const measure::Row& row : found.rows)
        std::printf("%-52s %7.2f ms  FLIP %.4f over the mirrors\n", row.label.c_str(),
                    row.gpu_ms.median, row.error.flip);
    report::write(found, "blend-report"); // report.html and its pictures
    return found.complete ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "own_technique: %s\n", error.what());
    return 1;
}
