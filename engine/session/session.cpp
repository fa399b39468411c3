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

namespace catoptric::session {

namespace {

double milliseconds_since(SteadyClock::time_point start) {
    return std::chrono::duration<double, std::milli>(SteadyClock::now() - start).count();
}

render::ShownInstant make_shown_instant(const FrameSpec& spec) {
    return {spec.time, scene::camera_at(spec.camera, spec.time), spec.size, spec.ambient};
}

bool have_equal_plans(const std::vector<reflect::TechniquePlan>& a,
                      const std::vector<reflect::TechniquePlan>& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return x.is_same(y); });
}

std::shared_ptr<const std::vector<dmat4>> object_transforms(const scene::Scene& scene) {
    std::vector<dmat4> transforms;
    transforms.reserve(scene.objects.size());
    for (const scene::Object& object : scene.objects)
        transforms.push_back(object.world_from_object);
    return std::make_shared<const std::vector<dmat4>>(std::move(transforms));
}

void check_spec(const FrameSpec& spec) {
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
void hash_ambient(require::WorkModel& model, double ambient) {
    for (require::MirrorRequirements& mirror : model.mirrors)
        for (auto* const content_hashes : {&mirror.content_hashes, &mirror.still_hashes})
            for (std::uint64_t& content_hash : *content_hashes)
                content_hash = ContentHash().add(content_hash).add(ambient).sum();
}

std::string work_name(RenderedWork work) {
    return work == RenderedWork::everything ? "everything" : "required";
}

struct FrameSequence::Impl {
    History history;
};

FrameSequence::FrameSequence(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameSequence::FrameSequence(FrameSequence&&) noexcept = default;
FrameSequence& FrameSequence::operator=(FrameSequence&&) noexcept = default;
FrameSequence::~FrameSequence() = default;

void Session::Impl::wait_for_copy(std::size_t copy_index) {
    if (last && read_by[copy_index] + read_by.size() > last->frame && read_by[copy_index] > 0)
        runner.wait_for(graph::FrameTicket{read_by[copy_index]});
}

double Session::Impl::update_scene(const render::ShownInstant& wanted) {
    double update_ms = 0;
    if (shown != wanted) update_ms = write_scene(wanted);
    if (history.face_edges && (history.face_edges->size != wanted.size ||
                               history.face_edges->needs.size() != resident->mirror_count()))
        history.face_edges.reset(); // an edit may have made or unmade a mirror
    if (!history.face_edges)
        history.face_edges = FaceEdges{wanted.size, resident->needed_face_edges()};
    resident->use_face_edges(history.face_edges->needs);
    return update_ms;
}

double Session::Impl::write_scene(const render::ShownInstant& wanted) {
    // Writes to another copy than the one that frames in flight read.
    const std::size_t next = (copy + 1) % read_by.size();
    wait_for_copy(next);
    copy = next;
    const SteadyClock::time_point start = SteadyClock::now();
    shown.reset(); // stays unset if the update throws half-way
    models.clear();
    if (scene::is_animated(scene)) {
        if (!moved) moved = scene;
        scene::move_to_time(*moved, scene, wanted.time);
        transforms = nullptr;
    } else {
        scene::check_time(wanted.time);
    }
    if (!transforms) transforms = object_transforms(shown_scene());
    resident->update(shown_scene(), wanted.camera, wanted.size, wanted.ambient,
                     static_cast<std::uint32_t>(copy));
    shown = wanted;
    ++counts.updates;
    return milliseconds_since(start);
}

std::vector<reflect::TechniquePlan> Session::Impl::find_plans(const FrameSpec& spec) const {
    if (!history.plans.empty() && history.texts == spec.techniques) return history.plans;
    std::vector<reflect::TechniquePlan> plans = parse_plans(spec.techniques);
    for (reflect::TechniquePlan& plan : plans)
        plan = resolve_auto_plan(std::move(plan), scene, spec, engine_impl.unit_costs.costs);
    return plans;
}

graph::FrameTicket Session::Impl::run_graph(const graph::Graph& graph, const FrameSpec& spec,
                                            const graph::ExternalSemaphores& outside,
                                            bool counts_work) {
    try {
        return runner.submit_frame(graph,
                                   spec.timing == PassTimingMode::isolated
                                       ? graph::PassTiming::isolated
                                       : graph::PassTiming::pipelined,
                                   spec.keeps_history, outside, counts_work);
    } catch (...) {
        if (runner.has_dropped_contents()) exchange_history({});
        throw;
    }
}

const std::shared_ptr<const require::WorkModel>&
Session::Impl::find_model(const std::vector<reflect::TechniquePlan>& plans, RenderedWork work,
                          bool is_ablated) {
    if (!have_equal_plans(modelled_plans, plans)) models.clear(), modelled_plans = plans;
    std::shared_ptr<const require::WorkModel>& model = models[{work, is_ablated}];
    if (model) return model;
    require::WorkModelInput input{shown_scene(), shown->camera, shown->size};
    reflect::add_capture_needs(input, plans);
    input.whole_cubes = input.whole_cubes || is_ablated; // look-ups with removed causes read faces
                                                         // that a search would never read
    if (work == RenderedWork::required && !requirements) requirements.emplace(scene);
    require::WorkModel made = work == RenderedWork::everything
                                  ? require::make_everything_model(input)
                                  : requirements->model(input);
    hash_ambient(made, shown->ambient);
    model = std::make_shared<const require::WorkModel>(std::move(made));
    return model;
}

Session::Session(Engine& engine, scene::Scene scene, std::uint32_t in_flight)
    : impl_(std::make_shared<Impl>(Access::impl(engine), std::move(scene), in_flight)) {}
Session::~Session() = default;

const scene::Scene& Session::scene() const { return impl_->scene; }

SessionCounters Access::session_counters(const Session& session) {
    const Session::Impl& self = *session.impl_;
    SessionCounters counts = self.counts;
    counts.plans = self.runner.plan_count();
    counts.memory_bytes = self.runner.allocated_bytes();
    counts.uploads = self.resident->write_count();
    counts.hierarchies_built = self.resident->built_bvhs();
    counts.hierarchies_refitted = self.resident->refitted_bvhs();
    return counts;
}

SetupTimes Access::setup_times(const Session& session) {
    const render::GpuScene& resident = *session.impl_->resident;
    return {resident.first_upload_ms(), resident.first_bvh_build_ms()};
}

Frame Session::frame(const FrameSpec& spec) { return Frame(impl_->submit(impl_, spec, {}, {})); }

Frame Access::render_frame(Session& session, const FrameSpec& spec, const FrameHooks& hooks,
                           const std::function<graph::ExternalSemaphores(FrameGraph&)>& finish) {
    return Frame(session.impl_->submit(session.impl_, spec, hooks, finish));
}

render::FrameFacts Session::Impl::prepare_facts(const FrameSpec& spec, double& update_ms) {
    render::FrameFacts facts{.seed = spec.seed, .now = make_shown_instant(spec)};
    update_ms += update_scene(facts.now);
    facts.transforms = transforms;
    if (!history.last) return facts;
    facts.number = history.last->number + 1;
    facts.before = history.last->now, facts.transforms_before = history.last->transforms;
    return facts;
}

std::shared_ptr<Access::FrameImpl>
Session::Impl::submit(const std::shared_ptr<Impl>& self, const FrameSpec& spec,
                      const FrameHooks& hooks,
                      const std::function<graph::ExternalSemaphores(FrameGraph&)>& finish) {
    check_spec(spec);
    const std::vector<reflect::TechniquePlan> plans = find_plans(spec);
    const bool follows = have_equal_plans(history.plans, plans) && history.work == spec.model;
    if (!spec.keeps_history && !follows) exchange_history({.plans = plans, .work = spec.model});
    if (!spec.keeps_history) history.texts = spec.techniques;
    auto frame = std::make_shared<Access::FrameImpl>();
    frame->session = self, frame->spec = spec, frame->hooks = hooks;
    {
        const Stopwatch watch(frame->waited_ms);
        wait_for_results(spec);
    }
    const render::FrameFacts facts = prepare_facts(spec, frame->update_ms);
    const SteadyClock::time_point start = SteadyClock::now();
    frame->model = find_model(plans, spec.model, hooks.ablated != 0);
    frame->frame = declare_frame(
        spec, hooks, facts, plans, mirrors, *resident, runner.make_history(),
        find_capture_histories(spec, hooks, plans.size(), *frame->model, follows));
    frame->declare_ms = milliseconds_since(start);
    const SteadyClock::time_point trees = SteadyClock::now();
    resident->fulfil(frame->frame.requests, [&] { wait_for_copy(copy); });
    frame->hierarchy_ms = milliseconds_since(trees);
    const graph::ExternalSemaphores outside = finish ? finish(frame->frame)
                                                     : graph::ExternalSemaphores{};
    frame->ticket = run_graph(frame->frame.graph, spec, outside, hooks.counts_work);
    last = frame->ticket;
    read_by[copy] = frame->ticket.frame;
    if (!spec.keeps_history) store_history(spec, facts, frame->frame, frame->ticket);
    ++counts.frames;
    return frame;
}

History Session::Impl::exchange_history(History next) {
    runner.release_retained();
    return std::exchange(history, std::move(next));
}

void Session::Impl::cut() {
    exchange_history({.plans = history.plans,
                      .work = history.work,
                      .costs = history.costs,
                      .timed = history.timed});
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
        self.cut(); // captured distances were in other units
        self.resident = std::move(made);
        ++self.units;
    }
    if (removes) self.requirements.reset();
    self.scene = std::move(edited);
    self.moved.reset(), self.transforms.reset();
    self.mirrors = mirror_names(self.scene);
    self.shown.reset();
    ++self.edits;
    self.history.texts.clear(); // another plan may be suggested
}

void Session::forget() {
    impl_->cut();
    impl_->shown.reset();
}

FrameSequence Access::suspend(Session& session) {
    Session::Impl& self = *session.impl_;
    self.read_capture_times();
    self.history.units = self.units, self.history.edits = self.edits;
    return FrameSequence(std::make_unique<FrameSequence::Impl>(self.exchange_history({})));
}

void Access::resume(Session& session, FrameSequence sequence) {
    Session::Impl& self = *session.impl_;
    History& next = sequence.impl_->history;
    if (next.units != self.units) return session.forget();
    if (next.edits != self.edits) next.texts.clear(); // another plan may be suggested
    const std::optional<render::FrameFacts> last = next.last;
    self.exchange_history(std::move(next));
    if (last) self.update_scene(last->now);
}

std::string Access::format_plan(Session& session, const FrameSpec& spec, PlanFormat format) {
    Session::Impl& self = *session.impl_;
    check_spec(spec);
    const std::vector<reflect::TechniquePlan> plans = self.find_plans(spec);
    render::FrameFacts facts{.seed = spec.seed, .now = make_shown_instant(spec)};
    self.update_scene(facts.now);
    facts.transforms = self.transforms;
    const std::shared_ptr<const require::WorkModel> model = self.find_model(plans, spec.model,
                                                                            false);
    std::vector<reflect::CaptureHistory> keeping(
        plans.size(), {.model = *model, .comparisons = &self.comparisons, .ignores_turns = true});
    FrameGraph frame = declare_frame(spec, {}, facts, plans, self.mirrors, *self.resident, {},
                                     keeping);
    // If captures are kept, the second frame compares them with those of the first. The returned
    // plan is that of the next frame, in which nothing has changed.
    for (int k = 0; k < (model->is_everything ? 1 : 2); ++k) {
        for (std::size_t i = 0; i < plans.size(); ++i) {
            keeping[i].before = frame.parts[i].outputs.kept;
            if (k > 0 && keeping[i].before) render::mark_unchanged(*keeping[i].before);
        }
        frame = declare_frame(spec, {}, facts, plans, self.mirrors, *self.resident,
                              frame.graph.next_history(), keeping);
    }
    const graph::GraphPlan& plan = self.runner.plan(frame.graph);
    switch (format) {
    case PlanFormat::dot: return graph::plan_to_dot(frame.graph, plan);
    case PlanFormat::json: return graph::plan_to_json(frame.graph, plan);
    case PlanFormat::text: break;
    }
    return graph::plan_to_text(frame.graph, plan);
}

FrameTimes Access::measure_clear_time(Session& session) {
    Session::Impl& self = *session.impl_;
    constexpr std::uint32_t kClearCostCubeEdge = 256;
    const std::uint32_t mirrors = self.resident->mirror_count(), most = self.resident->max_cubes();
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
                .writes(cubes.layers(6 * cube, 6), graph::ResourceUse::colour,
                        graph::ClearValue{0, 0, 0, 1})
                .writes(depth, graph::ResourceUse::depth, graph::ClearValue{0, 0, 0, 0})
                .layers(6)
                .record([](graph::PassCommands&) {});
        }
        graph.output(cubes);
    }
    ++self.counts.frames;
    self.last = self.runner.submit_frame(graph, graph::PassTiming::isolated);
    return to_frame_times(self.runner.wait_for(*self.last));
}

} // namespace catoptric::session
