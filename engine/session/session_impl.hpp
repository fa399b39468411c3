#pragma once

#include "core/error.hpp"
#include "graph/graph_runner.hpp"
#include "require/model.hpp"
#include "session/access.hpp"
#include "session/engine_impl.hpp"
#include "session/frame_graph.hpp"
#include "session/history.hpp"
#include "session/plan_file.hpp"
#include "session/session.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// Implementation of Session and Frame, only for session.cpp, session_cache.cpp, frame.cpp,
// first_surface.cpp and screen.cpp. What a later frame reads of earlier ones is in History.
namespace catoptric::session {

struct Session::Impl {
    Impl(Access::EngineImpl& shared, scene::Scene at_rest, std::uint32_t in_flight)
        : engine_impl(shared), scene((scene::check_scene(at_rest), std::move(at_rest))),
          resident(std::make_unique<render::GpuScene>(shared.device, scene, in_flight)),
          comparisons(shared.device,
                      [this](std::uint64_t frame) { return runner.has_ended({frame}); }),
          runner(shared.device, shared.pipelines, in_flight, &history.retained),
          read_by(in_flight, 0) {
        mirrors = mirror_names(scene);
    }

    /// `finish` adds passes that belong to no technique; empty: none.
    std::shared_ptr<Access::FrameImpl>
    submit(const std::shared_ptr<Impl>& self, const FrameSpec& spec, const FrameHooks& hooks,
           const std::function<graph::ExternalSemaphores(FrameGraph&)>& finish);
    /// Replaces the history. The next frame follows the last frame of `next`. Waits for the frames
    /// in flight. Returns the old history.
    History exchange_history(History next);
    /// Makes a cut: the next frame follows no other. What is known of costs stays.
    void cut();
    /// Returns the scene at the instant of `shown`. A scene that is not animated is not copied.
    const scene::Scene& shown_scene() const { return moved ? *moved : scene; }
    /// Writes the scene data that `wanted` needs and the device lacks. Returns the milliseconds of
    /// work.
    double update_scene(const render::ShownInstant& wanted);
    double write_scene(const render::ShownInstant& wanted);
    /// Waits until no frame in flight reads this copy of the scene data.
    void wait_for_copy(std::size_t copy_index);
    /// Returns the plans of the frame's techniques: those of the last frame if the texts are equal.
    /// Otherwise reads the texts, and `auto` chooses.
    std::vector<reflect::TechniquePlan> find_plans(const FrameSpec& spec) const;
    /// Returns the facts of the next frame, and writes what it shows of the scene to the device.
    /// Adds the milliseconds of that to `update_ms`.
    render::FrameFacts prepare_facts(const FrameSpec& spec, double& update_ms);
    /// Submits the graph of a frame. A frame that is stopped leaves the session without history.
    graph::FrameTicket run_graph(const graph::Graph& graph, const FrameSpec& spec,
                                 const graph::ExternalSemaphores& outside, bool counts_work);
    /// Returns the model of the scene at its present instant, for these techniques.
    const std::shared_ptr<const require::WorkModel>&
    find_model(const std::vector<reflect::TechniquePlan>& plans, RenderedWork work,
               bool is_ablated);
    /// Returns the capture history from which the next frame of these techniques continues.
    std::vector<reflect::CaptureHistory>
    find_capture_histories(const FrameSpec& spec, const FrameHooks& hooks, std::size_t plan_count,
                           const require::WorkModel& model, bool follows);
    /// Waits for results of earlier frames that this frame needs.
    void wait_for_results(const FrameSpec& spec);
    /// Returns how many mirrors' captures the frame draws again at most; 0: all.
    std::uint32_t most_captures(const FrameSpec& spec, std::size_t part,
                                const require::WorkModel& model) const;
    /// Reads how long captures took in the last submitted frame under a budget. Waits for that
    /// frame.
    void read_capture_times();
    /// Stores what a submitted frame leaves for the next one.
    void store_history(const FrameSpec& spec, const render::FrameFacts& facts,
                       const FrameGraph& frame, graph::FrameTicket ticket);

    Access::EngineImpl& engine_impl;
    scene::Scene scene;
    std::unique_ptr<render::GpuScene> resident;
    render::ComparisonBuffers comparisons;
    History history;
    graph::GraphRunner runner;
    std::vector<std::string> mirrors; ///< names of the mirrors
    /// What the scene on the device shows; none: it must be written.
    std::optional<render::ShownInstant> shown;
    /// `scene` at the instant of `shown`, if it is animated.
    std::optional<scene::Scene> moved;
    /// Transforms of the objects at the instant of `shown`; null: they must be listed.
    std::shared_ptr<const std::vector<dmat4>> transforms;
    std::optional<require::WorkModelBuilder> requirements; ///< computed at first use
    /// Models of `shown`, and the plans for which they were made.
    std::vector<reflect::TechniquePlan> modelled_plans;
    std::map<std::pair<RenderedWork, bool>, std::shared_ptr<const require::WorkModel>> models;
    std::optional<graph::FrameTicket> last; ///< ticket of the frame submitted last
    /// For each copy of the scene data, the last frame that reads the copy.
    std::vector<std::uint64_t> read_by;
    std::size_t copy = 0;    ///< copy that frames read now
    std::uint64_t units = 0; ///< number of changes of the scene's units on the device
    std::uint64_t edits = 0; ///< number of edits of the scene
    SessionCounters counts;
};

struct Frame::Impl {
    std::shared_ptr<Access::SessionImpl> session;
    graph::FrameTicket ticket;
    FrameSpec spec;
    FrameHooks hooks;
    FrameGraph frame;
    std::shared_ptr<const require::WorkModel> model;
    double update_ms = 0, declare_ms = 0, hierarchy_ms = 0, waited_ms = 0;
    mutable std::optional<FrameTimes> times; ///< set once the frame was waited for

    graph::GraphRunner& graph_runner() const { return session->runner; }
    const FramePart& part(std::size_t index) const { return frame.parts.at(index); }
    const graph::GraphPlan& graph_plan() const { return graph_runner().plan(frame.graph); }
    /// Checks that no later frame was submitted, because it overwrites images that outlive a frame.
    void check_is_last() const {
        check(session->last && session->last->frame == ticket.frame, Failure::internal, "frame ",
              ticket.frame, " is read after frame ", session->last ? session->last->frame : 0,
              " was rendered over it");
    }
};

/// Throws `usage` for an invalid limit of captures.
void check_capture_limit(const FrameSpec& spec);

/// Returns the runner's times under the names that callers know.
FrameTimes to_frame_times(const graph::GraphFrameTimes& times);

} // namespace catoptric::session
