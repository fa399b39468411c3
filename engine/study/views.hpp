#pragma once

#include "report/comparison.hpp"
#include "session/run.hpp"
#include "session/watcher.hpp"
#include "study/compare_to_target.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::study {

using namespace session;

/// Draws `count` views of the request's scene that see a mirror (session/seeded_camera.hpp), from
/// its seed. The same scene, time and seed give the same views. Each view has its own seed, from
/// which its camera can be drawn again. Its instant lies within one period of the scene's motion
/// from `request.time` on, rounded so that it can be typed. Returns no views for a count of 1.
/// Throws `usage` for other counts that give no confidence interval of the median
/// (measure::kMinIntervalSamples), and if no camera sees a mirror.
/// `cameras_per_instant`, at least 1: as many neighbouring views share an instant, the first one's.
/// Such views depend on each other: intervals and proofs that take them for independent are too
/// narrow.
std::vector<measure::View> draw_views(const Request& request, int count,
                                      int cameras_per_instant = 1);

struct ViewsRequest {
    const Request&
        base; ///< the compared scene, with the techniques in the order of the comparison's rows
    std::string reference = "raytrace:depth=16";
    /// Most time to reduce the noise of the reference, seconds for all views together. Views of
    /// less noise leave their time to later views.
    double reference_seconds = 0;
    /// Noise floor at which a reference needs no more frames; none: the errors of the rows decide.
    std::optional<NoiseFloorTarget> noise_target = {};
    Watcher watcher;
    /// Rows of files: name, and folder of pictures (study/picture_rows.hpp). They are the last rows
    /// of the comparison. A row of a single picture gets no errors in views.
    std::vector<std::pair<std::string, std::string>> pictures = {};
    /// Most neighbouring views of one instant that share captures, at least 1. All of them finish
    /// at once.
    int cameras_per_instant = 1;
    /// A session for each technique, which shows the scene of `base`. Empty: all techniques use the
    /// session of the reference.
    std::vector<Session*> row_sessions = {};
    /// Whether the sessions of techniques have drawn the first view's instant before, so that their
    /// captures need not settle again. Needs `row_sessions`.
    bool continues_instant = false;
    /// Called when every row has its errors in the views of one instant. The function may be empty.
    std::function<void()> on_finished_view;
    /// Called with warnings about the pictures of rows of files. The function may be empty.
    std::function<void(const std::string&)> on_warning;
};

/// Renders the reference and every row of the comparison from each view of the comparison, and
/// fills Row::views and Row::worst. Each picture is rendered until nothing changes any more, as
/// `render` does. The session must show the scene of `request.base`. After an exception (a signal,
/// a failure of the engine) the finished views stay in the rows. Costs a picture and its FLIP per
/// row and view.
void measure_views(Session& session, const ViewsRequest& request, report::Comparison& comparison);

} // namespace catoptric::study
