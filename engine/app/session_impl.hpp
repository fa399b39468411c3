#pragma once

#include "app/capture_cost.hpp"
#include "app/engine_impl.hpp"
#include "app/frame_graph.hpp"
#include "app/plan_file.hpp"
#include "app/session.hpp"
#include "core/error.hpp"
#include "graph/run.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

// What a session is made of, for session.cpp and frame.cpp alone.
namespace catoptric::app {

/// What the device's copy of a scene was made for.
struct SceneKey {
    double time = 0;
    scene::Camera camera;
    uvec2 size{0, 0};
    double ambient = 0;
    bool operator==(const SceneKey&) const = default;
};

struct Session::Impl {
    Impl(Engine::Impl& shared, scene::Scene at_rest, std::uint32_t in_flight)
        : engine(shared), scene(std::move(at_rest)),
          resident(std::make_unique<render::GpuScene>(shared.device, scene, in_flight)),
          comparisons(shared.device,
                      [this](std::uint64_t frame) { return runner.has_ended({frame}); }),
          runner(shared.device, shared.pipelines, in_flight), read_by(in_flight, 0) {
        mirrors = mirror_names(scene);
    }

    /// Returns the scene at the instant of `standing`. A scene that is not animated is not copied.
    const scene::Scene& now() const { return moved ? *moved : scene; }
    /// Writes what is wanted and the device does not have yet; milliseconds of work.
    double update_scene(const SceneKey& wanted);
    /// Until no frame is in flight that reads this copy of what is written.
    void wait_for_readers(std::size_t of);
    /// The techniques' texts read, only once for as long as they stay: what is suggested (`auto`)
    /// is so for the frame that asks for them first, after a cut and after an edit.
    const std::vector<reflect::Plan>& plans_of(const FrameSpec& spec);
    /// Of the scene as it stands.
    const std::shared_ptr<const require::Model>& model_of(Modelling modelling, bool is_ablated);
    /// What the next frame of these techniques goes on from.
    std::vector<reflect::CaptureHistory> keeping(const FrameSpec& spec, const require::Model& model,
                                                 bool follows);
    /// Waits for what the frame needs to know of those before.
    void catch_up(const FrameSpec& spec);
    /// Mirrors whose captures the frame draws again at most; 0: all.
    std::uint32_t most_captures(const FrameSpec& spec, std::size_t part,
                                const require::Model& model) const;
    /// Learns from the frame under a budget that was submitted last how long captures take; waits.
    void measure();
    /// The frame was submitted: it tells that.
    void time(const FrameGraph& frame, graph::Ticket ticket);
    /// The frame was submitted: the next one goes on from it.
    void keep(const FrameGraph& frame, graph::Ticket ticket);

    Engine::Impl& engine;
    scene::Scene scene;
    std::unique_ptr<render::GpuScene> resident;
    render::Comparisons comparisons;
    graph::Runner runner;
    std::vector<std::string> mirrors; ///< their names
    std::optional<SceneKey> scene_key;
    std::optional<scene::Scene> moved; ///< `scene` as it stands there, where it is animated
    std::vector<std::string> texts;
    std::vector<reflect::Plan> plans;      ///< of `texts`
    std::vector<reflect::Plan> remembered; ///< whose history the runner has
    Modelling remembered_model = Modelling::everything;
    std::vector<std::shared_ptr<render::CaptureCache>> kept; ///< likewise, by technique
    std::vector<CaptureCost> paces;                          ///< by technique
    /// A frame under a budget that was not looked at yet, and of each technique how its passes'
    /// names begin and how many mirrors it drew.
    struct Timed {
        graph::Ticket ticket;
        std::vector<std::pair<std::string, std::uint32_t>> drawn;
    };
    std::optional<Timed> timed;
    std::optional<require::Requirements> requirements; ///< once somebody asks
    std::map<std::pair<Modelling, bool>, std::shared_ptr<const require::Model>>
        models;                         ///< of `standing` and `plans`
    std::optional<graph::Ticket> last;  ///< of the frame that was submitted last
    std::vector<std::uint64_t> read_by; ///< by copy of what is written: the last frame to read it
    std::size_t copy = 0;               ///< that frames read now
    std::uint64_t units = 0;            ///< times that the scene's units on the device changed
    std::uint64_t edits = 0;            ///< of the scene
    Counts counts;
};

struct Frame::Impl {
    std::shared_ptr<Session::Impl> session;
    graph::Ticket ticket;
    FrameSpec spec;
    FrameGraph frame;
    std::shared_ptr<const require::Model> model;
    double update_ms = 0, declare_ms = 0, hierarchy_ms = 0, waited_ms = 0;
    mutable std::optional<FrameTimes> times; ///< once it was waited for

    graph::Runner& runner() const { return session->runner; }
    const Declared& part(std::size_t index) const { return frame.parts.at(index); }
    const graph::Plan& plan() const { return runner().compiled(frame.graph); }
    /// What outlives a frame is another's after the next.
    void check_last() const {
        check(session->last && session->last->frame == ticket.frame, Failure::internal, "frame ",
              ticket.frame, " is read after frame ", session->last ? session->last->frame : 0,
              " was rendered over it");
    }
};

/// Refuses (`usage`) a limit of captures that means nothing.
void check_limit(const FrameSpec& spec);

/// The runner's times with the names that callers know.
FrameTimes to_times(const graph::FrameTimes& times);

} // namespace catoptric::app
