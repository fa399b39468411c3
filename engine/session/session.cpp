#include "session/session_impl.hpp"

#include "core/content_hash.hpp"
#include "core/error.hpp"
#include "core/stopwatch.hpp"
#include "graph/dump.hpp"
#include "require/model.hpp"
#include "scene/check.hpp"
#include "scene/pose.hpp"
#include "session/access.hpp"
#include "session/plan_file.hpp"
#include "session/resolve_auto.hpp"

#include <chrono>
#include <cmath>
#include <utility>

namespace catoptric::app {

namespace {

double compute_milliseconds_since(SteadyClock::time_point start) {
    return std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
}

DeviceSceneKey make_scene_key(const FrameSpec& spec) {
    return {spec.time, scene::camera_at_time(spec.camera, spec.time), spec.size, spec.ambient};
}

bool have_equal_plans(const std::vector<reflect::TechniquePlan>& a,
                      const std::vector<reflect::TechniquePlan>& b) {
    return std::ranges::equal(a, b,
                              [](const auto& x, const auto& y) { return x.is_same_plan_as(y); });
}

void check_frame_spec(const FrameSpec& spec) {
    check_capture_limit(spec);
    check(spec.size.x > 0 && spec.size.y > 0, Failure::usage, "the size must be at least 1x1, not ",
          spec.size.x, "x", spec.size.y);
    // The comparison is written so that NaN fails.
    check(spec.ambient >= 0 && std::isfinite(spec.ambient), Failure::usage,
          "ambient: wanted a finite number of at least 0, found ", spec.ambient);
    check(std::isfinite(spec.exposure), Failure::usage,
          "exposure: wanted a finite number of stops, found ", spec.exposure);
    scene::check_camera(spec.camera, "frame", Failure::usage);
}

} // namespace

/// Adds the ambient light to the content hashes. It is no part of a scene, but captures depend on
/// it.
void hash_ambient_light(require::RequiredWorkModel& model, double ambient) {
    for (require::MirrorRequirements& mirror : model.mirrors)
        for (auto* const content_hashes : {&mirror.content_hashes, &mirror.settings})
            for (std::uint64_t& content_hash : *content_hashes)
                content_hash =
                    ContentHash().add_value(content_hash).add_value(ambient).current_hash();
}

std::string rendered_work_name(RenderedWork work) {
    return work == RenderedWork::everything ? "everything" : "required";
}

struct FrameSequence::Impl {
    graph::SuspendedPersistentImages leavings;
    std::vector<reflect::TechniquePlan> remembered;
    RenderedWork remembered_model = RenderedWork::everything;
    std::vector<std::shared_ptr<render::CaptureCache>> kept;
    std::vector<CaptureCostEstimate> paces;
    std::vector<double> face_needs;
    std::optional<DeviceSceneKey> scene_key; ///< key of the scene data from which the next frame
                                             ///< continues
    std::uint64_t units = 0;                 ///< units in which distances were captured
    std::uint64_t edits = 0;                 ///< number of the scene's edits so far
    std::vector<std::string> texts;
    /// Parsed from `texts`, with the suggestions made for its first frame.
    std::vector<reflect::TechniquePlan> plans;
};

FrameSequence::FrameSequence(std::unique_ptr<Impl> impl) : sequence_impl_(std::move(impl)) {}
FrameSequence::FrameSequence(FrameSequence&&) noexcept = default;
FrameSequence& FrameSequence::operator=(FrameSequence&&) noexcept = default;
FrameSequence::~FrameSequence() = default;

void Session::Impl::wait_until_scene_copy_is_free(std::size_t of) {
    if (last && read_by[of] + read_by.size() > last->frame && read_by[of] > 0)
        runner.wait_for_frame(graph::SubmittedFrameTicket{read_by[of]});
}

double Session::Impl::update_device_scene(const DeviceSceneKey& wanted) {
    if (scene_key == wanted && resident->has_needed_face_edges()) return 0;
    // Writes to another copy than the one that frames in flight read.
    const std::size_t next = (copy + 1) % read_by.size();
    wait_until_scene_copy_is_free(next);
    copy = next;
    const SteadyClock::time_point start = SteadyClock::now();
    if (scene_key && scene_key->size != wanted.size) resident->discard_needed_face_edges();
    scene_key.reset(); // stays unset if the update throws half-way
    models.clear();
    if (scene::is_animated(scene)) {
        if (!moved) moved = scene;
        scene::move_scene_to_time(*moved, scene, wanted.time);
    } else {
        scene::check_scene_time(wanted.time);
    }
    resident->update(scene_at_current_instant(), wanted.camera, wanted.size, wanted.ambient,
                     static_cast<std::uint32_t>(copy));
    scene_key = wanted;
    ++counts.updates;
    return compute_milliseconds_since(start);
}

const std::vector<reflect::TechniquePlan>&
Session::Impl::parse_and_cache_technique_plans(const FrameSpec& spec) {
    if (plans.empty() || texts != spec.techniques) {
        plans = parse_technique_plans(spec.techniques);
        for (reflect::TechniquePlan& plan : plans)
            plan = resolve_auto_plan(std::move(plan), scene, spec, engine_impl.info);
        texts = spec.techniques;
        models.clear();
    }
    return plans;
}

graph::SubmittedFrameTicket Session::Impl::run_graph(const graph::Graph& graph,
                                                     const FrameSpec& spec,
                                                     const graph::ExternalSemaphores& outside,
                                                     bool counts_work) {
    try {
        return runner.submit_frame(graph,
                                   spec.timing == PassTimingMode::isolated
                                       ? graph::PassTiming::isolated
                                       : graph::PassTiming::pipelined,
                                   spec.keeps_history, outside, counts_work);
    } catch (...) {
        if (runner.has_dropped_contents()) {
            kept.clear(), paces.clear(), timed.reset();
            remembered.clear();
        }
        throw;
    }
}

const std::shared_ptr<const require::RequiredWorkModel>&
Session::Impl::find_required_work_model(RenderedWork work, bool is_ablated) {
    std::shared_ptr<const require::RequiredWorkModel>& model = models[{work, is_ablated}];
    if (model) return model;
    require::RequiredWorkModelInput question{scene_at_current_instant(), scene_key->camera,
                                             scene_key->size};
    reflect::add_capture_needs_of_plan(question, plans);
    question.whole_cubes = question.whole_cubes ||
                           is_ablated; // look-ups with removed causes read faces that a search
                                       // would never read
    if (work == RenderedWork::required && !requirements) requirements.emplace(scene);
    require::RequiredWorkModel made = work == RenderedWork::everything
                                          ? require::make_everything_model(question)
                                          : requirements->make_work_model_for_request(question);
    hash_ambient_light(made, scene_key->ambient);
    model = std::make_shared<const require::RequiredWorkModel>(std::move(made));
    return model;
}

Session::Session(Engine& engine, scene::Scene scene, std::uint32_t in_flight)
    : impl_(std::make_shared<Impl>(Access::engine_impl_of(engine), std::move(scene), in_flight)) {}
Session::~Session() = default;

const scene::Scene& Session::scene() const { return impl_->scene; }

SessionCounters Access::session_counters(const Session& session) {
    const Session::Impl& self = *session.impl_;
    SessionCounters counts = self.counts;
    counts.plans = self.runner.compiled_graph_plan_count();
    counts.memory_bytes = self.runner.allocated_device_bytes();
    counts.uploads = self.resident->device_buffer_write_count();
    counts.hierarchies_built = self.resident->built_bvh_count();
    counts.hierarchies_refitted = self.resident->refitted_bvh_count();
    return counts;
}

SetupTimes Access::setup_times(const Session& session) {
    const render::GpuScene& resident = *session.impl_->resident;
    return {resident.first_scene_upload_ms(), resident.first_bvh_build_ms()};
}

Frame Session::frame(const FrameSpec& spec) { return Access::render_frame(*this, spec, {}); }

Frame Access::render_frame(Session& session, const FrameSpec& spec, const FrameHooks& hooks) {
    return submit_frame(session, spec, hooks,
                        [](FrameGraph&) { return graph::ExternalSemaphores{}; });
}

Frame Access::submit_frame(Session& session, const FrameSpec& spec, const FrameHooks& hooks,
                           const std::function<graph::ExternalSemaphores(FrameGraph&)>& finish) {
    Session::Impl& self = *session.impl_;
    check_frame_spec(spec);
    const std::vector<reflect::TechniquePlan>& plans = self.parse_and_cache_technique_plans(spec);
    const bool follows = have_equal_plans(self.remembered, plans) &&
                         self.remembered_model == spec.model;
    if (!spec.keeps_history && !follows) {
        self.runner.discard_persistent_image_contents();
        self.kept.clear();
        self.paces.clear(), self.timed.reset();
        self.remembered = plans, self.remembered_model = spec.model;
    }
    double waited_ms = 0;
    {
        const Stopwatch watch(waited_ms);
        self.wait_for_needed_results(spec);
    }
    const double update_ms = self.update_device_scene(make_scene_key(spec));
    const SteadyClock::time_point start = SteadyClock::now();
    const std::shared_ptr<const require::RequiredWorkModel> model = self.find_required_work_model(
        spec.model, hooks.ablated != 0);
    FrameGraph frame = declare_frame_graph(spec, hooks, plans, self.mirrors, *self.resident,
                                           self.runner.make_history(),
                                           self.find_capture_histories(spec, *model, follows));
    const double declare_ms = compute_milliseconds_since(start);
    if (self.resident->has_new_views()) self.wait_until_scene_copy_is_free(self.copy);
    const SteadyClock::time_point trees = SteadyClock::now();
    self.resident->write_views_and_update_trees();
    const double hierarchy_ms = compute_milliseconds_since(trees);
    const graph::ExternalSemaphores outside = finish(frame);
    const graph::SubmittedFrameTicket ticket = self.run_graph(frame.graph, spec, outside,
                                                              hooks.counts_work);
    self.last = ticket;
    self.read_by[self.copy] = ticket.frame;
    if (!spec.keeps_history) self.store_captures_of_frame(frame, ticket);
    if (!spec.keeps_history && spec.budget_ms > 0)
        self.mark_frame_for_capture_timing(frame, ticket);
    ++self.counts.frames;
    return Frame(std::make_shared<Frame::Impl>(Frame::Impl{session.impl_,
                                                           ticket,
                                                           spec,
                                                           hooks,
                                                           std::move(frame),
                                                           model,
                                                           update_ms,
                                                           declare_ms,
                                                           hierarchy_ms,
                                                           waited_ms,
                                                           {}}));
}

void Session::change(const scene::Edit& edit) {
    Impl& self = *impl_;
    scene::Scene edited = self.scene;
    scene::apply_edit(edited, edit);
    // If objects and units of the edited scene are unchanged, resident data and history stay.
    const bool removes = edited.objects.size() != self.scene.objects.size();
    if (removes || render::make_scene_units(edited) != render::make_scene_units(self.scene)) {
        auto made = std::make_unique<render::GpuScene>(self.engine_impl.device, edited,
                                                       self.read_by.size());
        self.runner.discard_persistent_image_contents(); // waits for frames in flight; captured
                                                         // distances were in other units
        self.kept.clear();
        self.resident = std::move(made);
        ++self.units;
    }
    if (removes) self.requirements.reset();
    self.scene = std::move(edited);
    self.moved.reset();
    self.mirrors = list_mirror_names(self.scene);
    self.scene_key.reset();
    ++self.edits;
    self.texts.clear(); // another plan may be suggested
}

void Session::forget() {
    impl_->runner.discard_persistent_image_contents();
    impl_->kept.clear();
    impl_->texts.clear(); // another plan may be suggested
    impl_->resident->discard_needed_face_edges();
    impl_->scene_key.reset();
}

FrameSequence Access::suspend_sequence(Session& session) {
    Session::Impl& self = *session.impl_;
    self.read_capture_times();
    auto sequence = std::make_unique<FrameSequence::Impl>(FrameSequence::Impl{
        self.runner.suspend(), std::exchange(self.remembered, {}), self.remembered_model,
        std::exchange(self.kept, {}), std::exchange(self.paces, {}),
        self.resident->needed_face_edges(), self.scene_key, self.units, self.edits,
        std::exchange(self.texts, {}), std::exchange(self.plans, {})});
    self.models.clear();
    self.resident->discard_needed_face_edges();
    return FrameSequence(std::move(sequence));
}

void Access::resume_frame_sequence(Session& session, FrameSequence sequence) {
    Session::Impl& self = *session.impl_;
    if (sequence.sequence_impl_->units != self.units) {
        session.forget();
        return;
    }
    self.runner.resume(std::move(sequence.sequence_impl_->leavings));
    self.remembered = std::move(sequence.sequence_impl_->remembered);
    self.remembered_model = sequence.sequence_impl_->remembered_model;
    self.kept = std::move(sequence.sequence_impl_->kept);
    self.paces = std::move(sequence.sequence_impl_->paces);
    self.resident->set_needed_face_edges(std::move(sequence.sequence_impl_->face_needs));
    if (sequence.sequence_impl_->edits == self.edits) {
        self.texts = std::move(sequence.sequence_impl_->texts);
        self.plans = std::move(sequence.sequence_impl_->plans);
        self.models.clear();
    }
    const std::optional<DeviceSceneKey>& scene_key = sequence.sequence_impl_->scene_key;
    // Updating the scene for another picture size would discard the capture edges that were just
    // set.
    if (!scene_key || (self.scene_key && self.scene_key->size != scene_key->size))
        self.scene_key.reset();
    if (scene_key) self.update_device_scene(*scene_key);
}

std::string Access::format_frame_plan(Session& session, const FrameSpec& spec,
                                      GraphPlanFormat format) {
    Session::Impl& self = *session.impl_;
    check_frame_spec(spec);
    const std::vector<reflect::TechniquePlan>& plans = self.parse_and_cache_technique_plans(spec);
    self.update_device_scene(make_scene_key(spec));
    const std::shared_ptr<const require::RequiredWorkModel> model = self.find_required_work_model(
        spec.model, false);
    std::vector<reflect::PreviousCaptureHistory> keeping(plans.size(),
                                                         {*model, nullptr, &self.comparisons});
    FrameGraph frame = declare_frame_graph(spec, {}, plans, self.mirrors, *self.resident, {},
                                           keeping);
    // If captures are kept, the second frame compares them with those of the first. The returned
    // plan is that of the next frame, in which nothing has changed.
    for (int k = 0; k < (model->is_everything ? 1 : 2); ++k) {
        for (std::size_t i = 0; i < plans.size(); ++i) {
            keeping[i].before = frame.parts[i].outputs.kept;
            if (k > 0 && keeping[i].before) render::mark_captures_unchanged(*keeping[i].before);
        }
        frame = declare_frame_graph(spec, {}, plans, self.mirrors, *self.resident,
                                    frame.graph.graph_history_for_next_frame(), keeping);
    }
    const graph::GraphPlan& plan = self.runner.find_or_make_plan(frame.graph);
    switch (format) {
    case GraphPlanFormat::dot: return graph::graph_plan_to_graphviz_dot(frame.graph, plan);
    case GraphPlanFormat::json: return graph::plan_to_json(frame.graph, plan);
    case GraphPlanFormat::text: break;
    }
    return graph::graph_plan_to_text(frame.graph, plan);
}

FrameTimes Access::measure_cube_clear_time(Session& session) {
    Session::Impl& self = *session.impl_;
    constexpr std::uint32_t kClearCostCubeEdge = 256;
    const std::uint32_t mirrors = self.resident->mirror_count(),
                        most = self.resident->max_cube_count();
    graph::Graph graph;
    for (std::uint32_t first = 0; first < mirrors; first += most) {
        const std::uint32_t count = std::min(most, mirrors - first);
        const graph::ImageHandle cubes = graph.add_image(
            {"cubes" + std::to_string(first / most + 1), TexelFormat::rgba16f, kClearCostCubeEdge,
             kClearCostCubeEdge, 6 * count, true});
        for (std::uint32_t cube = 0; cube < count; ++cube) {
            const std::string name = "clear/" + std::to_string(first + cube + 1);
            const graph::ImageHandle depth = graph.add_image({name + ".depth", TexelFormat::d32f,
                                                              kClearCostCubeEdge,
                                                              kClearCostCubeEdge, 6, true});
            graph.add_pass(name)
                .writes(cubes.select_image_layers(6 * cube, 6), graph::ResourceUse::colour,
                        graph::ClearValue{0, 0, 0, 1})
                .writes(depth, graph::ResourceUse::depth, graph::ClearValue{0, 0, 0, 0})
                .set_pass_layer_count(6)
                .record([](graph::PassCommands&) {});
        }
        graph.mark_as_graph_output(cubes);
    }
    ++self.counts.frames;
    self.last = self.runner.submit_frame(graph, graph::PassTiming::isolated);
    return to_public_frame_times(self.runner.wait_for_frame(*self.last));
}

} // namespace catoptric::app
