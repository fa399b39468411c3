#include "benchmark/calibration.hpp"

#include "benchmark/costs.hpp"
#include "session/resolved_scene.hpp"

#include <utility>

namespace catoptric::benchmark {

namespace {

constexpr int kFrames = 6, kRounds = 3;
/// Factor on the edges of pictures on a card, which small pictures do not fill.
constexpr std::uint32_t kCardEdgeFactor = 4;
/// Frames after which a row of the model `required` draws no capture any more.
constexpr int kFramesToRest = 16;

struct CalibrationRow {
    const char* technique;
    std::uint32_t edge; ///< of the picture on a processor
    RenderedWork model;
};
struct CalibrationScene {
    const char* name;
    std::vector<CalibrationRow> rows;
};

const std::vector<CalibrationScene>& calibration_scenes() {
    constexpr RenderedWork kAll = RenderedWork::everything, kRest = RenderedWork::required;
    static const std::vector<CalibrationScene> kScenes{
        {"cornell-mirrors",
         {{"reuse", 32, kRest}, // commands
          {"reuse", 128, kRest},
          {"reuse", 320, kRest},       // shading of the view, one look-up a pixel
          {"reuse:face=64", 64, kAll}, // small captures: passes and draws
          {"reuse:face=64", 192, kAll},
          {"reuse:face=256", 64, kAll}, // large ones: fragments
          {"layered", 64, kAll},
          {"hybrid", 96, kRest},
          {"hybrid", 192, kRest},
          {"raytrace:depth=1", 32, kAll},
          {"raytrace:depth=1", 192, kAll},
          {"raytrace:depth=8", 64, kAll},
          {"raytrace:depth=8", 192, kAll},
          {"raytrace:depth=4,first=raster", 64, kAll},
          {"raytrace:depth=4,first=raster", 192, kAll}}},
        {"room", // textures, many triangles
         {{"reuse", 32, kRest},
          {"reuse", 160, kRest},
          {"reuse:face=128", 96, kAll},
          {"planar", 64, kRest},
          {"planar", 192, kRest},
          {"march", 64, kRest},
          {"march", 160, kRest},
          {"pyramid", 128, kRest},
          {"raytrace:depth=4", 48, kAll},
          {"raytrace:depth=4", 160, kAll}}},
        {"courtyard", // an environment, a mesh
         {{"parallax", 64, kRest},
          {"parallax", 160, kRest},
          {"parallax:face=128", 64, kAll},
          {"raytrace:depth=4", 48, kAll},
          {"raytrace:depth=4", 128, kAll}}}};
    return kScenes;
}

/// Returns a request for the scene as `compare` shows it.
Request make_scene_request(const char* name) {
    ResolvedScene wanted = resolve_scene(name, {});
    Request request;
    request.camera = choose_camera(wanted, 1);
    request.ambient = choose_ambient(wanted);
    request.scene = std::move(wanted.scene);
    request.frames = kFrames;
    return request;
}

} // namespace

std::vector<measure::TimedWork> measure_calibration_rows(Engine& engine, const Watcher& watcher) {
    std::size_t all = 0;
    for (const CalibrationScene& scene : calibration_scenes()) all += kRounds * scene.rows.size();
    std::vector<measure::TimedWork> samples;
    for (const CalibrationScene& scene : calibration_scenes()) {
        const Request request = make_scene_request(scene.name);
        Session session(engine, request.scene);
        std::vector<Request> rows;
        for (const CalibrationRow& row : scene.rows) {
            Request& one = rows.emplace_back(request);
            one.techniques = {row.technique};
            one.size = uvec2(row.edge * (engine.device().type == "cpu" ? 1 : kCardEdgeFactor));
            one.model = row.model;
            one.warmup = row.model == RenderedWork::required ? kFramesToRest : 2;
        }
        Watcher part = watcher; // counts the rows of all scenes
        if (watcher.on_row)
            part.on_row = [&](const std::string& label, std::size_t row, std::size_t) {
                watcher.on_row(label, kRounds * samples.size() + row, all);
            };
        measure_cost_rows(session, rows, engine.device(),
                          {.iterations = kFrames, .rounds = kRounds, .watcher = part}, samples);
    }
    return samples;
}

} // namespace catoptric::benchmark
