#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"
#include "report/comparison.hpp"

namespace catoptric::app {

measure::CameraFacts facts_of(const scene::Camera& camera);

/// `count` views of the request's scene that see a mirror (app/seeded_camera.hpp), drawn from its
/// seed: same scene, time and seed, same views. Each has a seed of its own, from which its camera
/// can be drawn again, and an instant within one period of the scene's motion from `request.time`
/// on, rounded so that it can be typed. None for a count of 1. Throws `usage` for other counts that
/// bound no median (measure::kFewest), and where no camera sees a mirror.
std::vector<measure::View> drawn_views(const Request& request, int count);

struct ViewsRequest {
    const Request& base; ///< its techniques, in the order of the comparison's rows
    std::string reference = "raytrace:depth=16";
    Watcher watcher;
    /// Called after each view, when every row has its errors there; may be empty.
    std::function<void()> on_finished_view;
};

/// Renders the reference and every row of the comparison from each of its views, one picture as
/// `render` takes it (until nothing changes any more), and judges them: Row::views and Row::worst.
/// The session shows the base's scene. What is thrown in between (a signal, whatever the engine
/// throws) leaves the views so far. Costs a picture and its FLIP a row and view.
void measure_views(Session& session, const ViewsRequest& request, report::Comparison& comparison);

} // namespace catoptric::app
