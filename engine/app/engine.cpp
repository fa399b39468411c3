#include "app/engine.hpp"

#include "app/version.hpp"
#include "core/error.hpp"
#include "core/half.hpp"
#include "graph/dump.hpp"
#include "graph/run.hpp"
#include "reflect/technique.hpp"
#include "render/captured.hpp"

#include <algorithm>
#include <cstring>
#include <numeric>
#include <optional>

namespace catoptric::app {

std::atomic<int> stop_signal{0};

std::string version() { return CATOPTRIC_VERSION; }
std::string commit() { return CATOPTRIC_COMMIT; }

namespace {

DeviceInfo to_info(const gpu::DeviceInfo& info) {
    return {info.name, info.driver, info.api, info.type, info.threads, info.missing};
}

/// One technique's share of a frame's graph.
struct Declared {
    reflect::Choice choice;
    std::string prefix;
    reflect::Outputs outputs;
    graph::Image display;
};

struct FrameGraph {
    graph::Graph graph;
    std::vector<Declared> parts;
};

/// Life of a frame, step 3: every technique's passes and its compose, and what is wanted of them.
FrameGraph declare(const Request& request, const std::vector<reflect::Choice>& choices,
                   const render::GpuScene& scene, graph::History history,
                   std::uint32_t mended = 0) {
    FrameGraph frame{graph::Graph(std::move(history)), {}};
    for (const reflect::Choice& choice : choices) {
        const std::string prefix = choices.size() > 1 ? choice.file_name() + "/" : "";
        const render::FrameInputs inputs{scene,        request.size, prefix,
                                         request.seed, mended,       request.with_lookup};
        reflect::Outputs outputs = choice.technique->add(frame.graph, inputs, choice.settings);
        const graph::Image display = render::add_compose(frame.graph, inputs, outputs.hdr,
                                                         request.exposure);
        frame.graph.want(outputs.hdr);
        frame.graph.want(display);
        if (outputs.hits) frame.graph.want(*outputs.hits);
        if (outputs.counters) frame.graph.want(*outputs.counters);
        if (outputs.lookup) frame.graph.want(*outputs.lookup);
        if (request.with_lookup && outputs.captures) frame.graph.want(*outputs.captures);
        frame.parts.push_back({choice, prefix, outputs, display});
    }
    return frame;
}

std::vector<reflect::Choice> parse_choices(const Request& request) {
    check(!request.techniques.empty(), Failure::usage, "no technique was asked for");
    std::vector<reflect::Choice> choices;
    for (const std::string& text : request.techniques) {
        choices.push_back(reflect::parse_choice(text));
        for (std::size_t i = 0; i + 1 < choices.size(); ++i)
            check(!choices[i].same_as(choices.back()), Failure::usage, "technique '", text,
                  "' is asked for twice");
    }
    return choices;
}

void check_request(const Request& request) {
    check(request.size.x > 0 && request.size.y > 0, Failure::usage,
          "the size must be at least 1x1, not ", request.size.x, "x", request.size.y);
    check(request.frames > 0 && request.warmup >= 0, Failure::usage,
          "frames must be at least 1 and warm-up at least 0, not ", request.frames, " and ",
          request.warmup);
}

/// Where frame k, from 1, stands in the scene's motion.
double instant_of(const Request& request, int k) {
    if (request.clock) return request.clock(k);
    return request.time + (request.animate ? (k - 1) / 60.0 : 0.0);
}

void check_stopped() {
    const int signal = stop_signal.load();
    if (signal == 0) return;
    const Failure failure = signal == 1    ? Failure::hangup
                            : signal == 15 ? Failure::terminated
                                           : Failure::interrupted;
    fail(failure, "stopped by signal ", signal);
}

Frame to_frame(const graph::FrameTimes& times) {
    Frame frame{{}, times.span_ms, times.record_ms, times.wall_ms};
    for (const graph::PassTime& pass : times.passes)
        frame.passes.push_back({pass.name, pass.begin_ms, pass.end_ms});
    return frame;
}

/// Scene passes and draws of the part whose passes begin with `prefix`.
void count_scene_passes(const graph::Graph& graph, const graph::Plan& plan, Part& part) {
    for (const graph::PlannedPass& planned : plan.passes) {
        const graph::Pass& pass = graph.passes()[planned.pass];
        if (pass.tag != graph::Tag::scene || !pass.name.starts_with(part.prefix)) continue;
        ++part.scene_passes;
        part.scene_draws += static_cast<int>(pass.layer_count);
    }
}

bool reads_previous(const graph::Graph& graph, const graph::Plan& plan, const std::string& prefix) {
    return std::ranges::any_of(plan.passes, [&](const graph::PlannedPass& planned) {
        const graph::Pass& pass = graph.passes()[planned.pass];
        return pass.name.starts_with(prefix) &&
               std::ranges::any_of(pass.images,
                                   [](const graph::ImageUse& use) { return use.image.previous; });
    });
}

measure::Picture to_picture(const std::vector<std::byte>& texels, uvec2 size, Format format) {
    measure::Picture picture(static_cast<int>(size.x), static_cast<int>(size.y));
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (format == Format::rgba32f) {
            std::memcpy(&picture.pixels[i], texels.data() + 16 * i, 12);
        } else {
            const auto byte = [&](std::size_t c) {
                return static_cast<float>(texels[4 * i + c]) / 255.0f;
            };
            picture.pixels[i] = {byte(0), byte(1), byte(2)};
        }
    }
    return picture;
}

template <typename Value>
std::vector<Value> values_of(const std::vector<std::byte>& bytes) {
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

void read_counters(const std::vector<std::byte>& bytes, Part& part) {
    shared::Counters counters;
    std::memcpy(&counters, bytes.data(), sizeof counters);
    check(counters.exhausted == 0, Failure::exhausted, "'", part.label, "': ", counters.exhausted,
          " pixels met more triangles and boxes than one invocation may (", counters.longest_walk,
          " steps); lower the depth");
    part.rays = RayCounts{counters.primary_rays, counters.mirror_rays, counters.shadow_rays,
                          counters.longest_walk};
    if (counters.mirror_pixels > 0)
        part.traced_fraction = static_cast<double>(counters.listed) / counters.mirror_pixels;
}

/// Texels of four halves with a colour at or above the largest half.
std::size_t saturated_texels(const std::vector<std::byte>& bytes) {
    const std::vector<std::uint16_t> halves = values_of<std::uint16_t>(bytes);
    std::size_t count = 0;
    for (std::size_t i = 0; i + 3 < halves.size(); i += 4)
        count += std::any_of(&halves[i], &halves[i] + 3, [](std::uint16_t half) {
            return (half & 0x7fff) >= kLargestHalfBits;
        });
    return count;
}

Part read_part(graph::Runner& runner, const FrameGraph& frame, const graph::Plan& plan,
               const Declared& declared, const render::GpuScene& scene, uvec2 size,
               bool with_lookup) {
    Part part;
    part.label = declared.choice.label;
    part.prefix = declared.prefix;
    part.memory_bytes = plan.bytes;
    part.remembers = reads_previous(frame.graph, plan, part.prefix);
    count_scene_passes(frame.graph, plan, part);
    const Settings& settings = declared.choice.settings;
    if (settings.has("face") && settings.is_special("face"))
        part.auto_face = AutoFace{scene.common_face(), scene.face_needs()};
    if (declared.outputs.counters) read_counters(runner.read(*declared.outputs.counters), part);
    part.hdr = to_picture(runner.read(declared.outputs.hdr), size, Format::rgba32f);
    part.display = to_picture(runner.read(declared.display), size, Format::rgba8_unorm);
    if (declared.outputs.hits)
        part.hits = values_of<std::uint32_t>(runner.read(*declared.outputs.hits));
    if (with_lookup && declared.outputs.captures)
        part.saturated = saturated_texels(runner.read(*declared.outputs.captures));
    if (declared.outputs.lookup)
        part.lookup = values_of<vec4>(runner.read(*declared.outputs.lookup));
    return part;
}

/// The frame rendered once more for each set of causes that is taken away: entry i belongs to part
/// i.
std::vector<std::vector<measure::Picture>>
render_mended(graph::Runner& runner, const Request& request,
              const std::vector<reflect::Choice>& choices, const render::GpuScene& scene) {
    std::vector<std::vector<measure::Picture>> pictures(choices.size());
    for (const std::uint32_t mended : request.mended) {
        const FrameGraph frame = declare(request, choices, scene, runner.history(), mended);
        runner.run(frame.graph, runner.plan(frame.graph), graph::Timing::pipelined, true);
        for (std::size_t i = 0; i < choices.size(); ++i)
            pictures[i].push_back(
                to_picture(runner.read(frame.parts[i].outputs.hdr), request.size, Format::rgba32f));
    }
    return pictures;
}

std::vector<Part> read_parts(graph::Runner& runner, const FrameGraph& frame,
                             const graph::Plan& plan, const render::GpuScene& scene,
                             const Request& request) {
    std::vector<Part> parts;
    for (const Declared& part : frame.parts)
        parts.push_back(
            read_part(runner, frame, plan, part, scene, request.size, request.with_lookup));
    return parts;
}

/// Sees frames of a still scene until one more would change nothing.
class Settling {
public:
    /// Whether this frame equals the one before byte for byte: linear pictures, and all that the
    /// next frame can see. True at once where nothing is remembered.
    bool is_settled(graph::Runner& runner, const FrameGraph& frame) {
        std::vector<std::byte> now = runner.read_history();
        if (now.empty()) return true;
        for (const Declared& part : frame.parts) {
            const std::vector<std::byte> picture = runner.read(part.outputs.hdr);
            now.insert(now.end(), picture.begin(), picture.end());
        }
        const bool same = now == last_;
        last_ = std::move(now);
        return same;
    }

private:
    std::vector<std::byte> last_;
};

} // namespace

double last_time(const Request& request) {
    return instant_of(request, request.warmup + request.frames);
}

struct Engine::Impl {
    explicit Impl(const EngineOptions& options)
        : device({options.device, options.validate, options.layered, false}),
          pipelines(device, options.shader_variants), info(to_info(device.info())) {}
    gpu::Device device;
    gpu::Pipelines pipelines;
    DeviceInfo info;
};

Engine::Engine(const EngineOptions& options) : impl_(std::make_unique<Impl>(options)) {}
Engine::~Engine() = default;

const DeviceInfo& Engine::device() const { return impl_->info; }
bool Engine::usable() const { return !impl_->device.abandoned(); }
void Engine::check_validation() const { impl_->device.check_validation(); }

Result Engine::run(const Request& request) {
    check_request(request);
    const std::vector<reflect::Choice> choices = parse_choices(request);
    render::GpuScene scene(impl_->device, request.scene);
    graph::Runner runner(impl_->device, impl_->pipelines);
    const auto timing = request.timing == Timing::isolated ? graph::Timing::isolated
                                                           : graph::Timing::pipelined;
    const int total = request.warmup + request.frames;
    Result result;
    Settling settling;
    std::optional<double> shown;
    for (int k = 1; k <= total; ++k) {
        check_stopped();
        if (request.changed) {
            scene.update(request.changed(k), request.camera, request.size, request.ambient);
        } else if (const double instant = instant_of(request, k); shown != instant) {
            scene.update(scene::at(request.scene, instant), request.camera, request.size,
                         request.ambient);
            shown = instant;
        }
        auto mended = k == total ? render_mended(runner, request, choices, scene)
                                 : std::vector<std::vector<measure::Picture>>();
        const FrameGraph frame = declare(request, choices, scene, runner.history());
        scene.prepare();
        const graph::Plan plan = runner.plan(frame.graph);
        const graph::FrameTimes times = runner.run(frame.graph, plan, timing);
        if (k > request.warmup) result.frames.push_back(to_frame(times));
        const ReadParts read = [&] { return read_parts(runner, frame, plan, scene, request); };
        const bool enough = request.watch && !request.watch(k, read);
        result.settled = request.until_settled && settling.is_settled(runner, frame);
        const bool last = enough || result.settled || k == total;
        if (last) result.parts = read();
        for (std::size_t i = 0; i < mended.size(); ++i)
            result.parts[i].mended = std::move(mended[i]);
        if (request.progress) request.progress(k, total);
        if (last) break;
    }
    check_stopped(); // a signal in the last frame
    return result;
}

std::string Engine::plan(const Request& request, PlanFormat format) {
    check_request(request);
    const std::vector<reflect::Choice> choices = parse_choices(request);
    render::GpuScene scene(impl_->device, request.scene);
    scene.update(scene::at(request.scene, request.time), request.camera, request.size,
                 request.ambient);
    const graph::Runner runner(impl_->device, impl_->pipelines);
    const FrameGraph frame = declare(request, choices, scene, {});
    const graph::Plan plan = runner.plan(frame.graph);
    switch (format) {
    case PlanFormat::dot: return graph::to_dot(frame.graph, plan);
    case PlanFormat::json: return graph::to_json(frame.graph, plan);
    case PlanFormat::text: break;
    }
    return graph::to_text(frame.graph, plan);
}

std::vector<double> Engine::clear_ms(const Request& request) {
    const auto mirrors = static_cast<std::uint32_t>(scene::mirrors(request.scene).size());
    if (mirrors == 0) return {};
    constexpr std::uint32_t kDefaultFace = 256;
    graph::Runner runner(impl_->device, impl_->pipelines);
    std::vector<double> samples;
    for (int k = 1; k <= request.warmup + request.frames; ++k) {
        check_stopped();
        graph::Graph graph;
        const graph::Image cubes = graph.image(
            {"cubes.colour", Format::rgba16f, kDefaultFace, kDefaultFace, 6 * mirrors, true});
        for (std::uint32_t mirror = 0; mirror < mirrors; ++mirror) {
            const std::string name = "clear/" + std::to_string(mirror + 1);
            const graph::Image depth = graph.image(
                {name + ".depth", Format::d32f, kDefaultFace, kDefaultFace, 6, true});
            graph.pass(name)
                .writes(cubes.layers(6 * mirror, 6), graph::Use::colour, graph::Clear{0, 0, 0, 1})
                .writes(depth, graph::Use::depth, graph::Clear{0, 0, 0, 0})
                .layers(6)
                .record([](graph::Commands&) {});
        }
        graph.want(cubes);
        const graph::FrameTimes times = runner.run(graph, runner.plan(graph),
                                                   graph::Timing::isolated);
        if (k > request.warmup)
            samples.push_back(std::accumulate(
                times.passes.begin(), times.passes.end(), 0.0,
                [](double sum, const graph::PassTime& pass) { return sum + pass.ms(); }));
    }
    return samples;
}

render::Captured Engine::capture(const scene::Scene& scene, std::uint32_t face, Format distance) {
    return render::capture(impl_->device, impl_->pipelines, scene, face, distance);
}

bool any_abandoned() { return gpu::any_abandoned(); }

std::vector<DeviceInfo> devices() {
    std::vector<DeviceInfo> list;
    for (const gpu::DeviceInfo& info : gpu::list_devices()) list.push_back(to_info(info));
    return list;
}

} // namespace catoptric::app
