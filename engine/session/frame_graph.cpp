// Declares the graph of a frame, and reads its results.
#include "session/frame_graph.hpp"

#include "bvh/words.hpp"
#include "core/error.hpp"
#include "core/half.hpp"
#include "core/text.hpp"
#include "session/access.hpp"
#include "session/plan_file.hpp"
#include "session/table.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <utility>

namespace catoptric::session {

namespace {

/// Counts the scene passes and draws of the technique whose passes' names begin with `prefix`.
void count_scene_passes(const graph::Graph& graph, const graph::GraphPlan& plan,
                        TechniqueResult& part) {
    for (const graph::PlannedPass& planned : plan.passes) {
        const graph::Pass& pass = graph.passes()[planned.pass];
        if (pass.tag != graph::PassPurpose::scene || !pass.name.starts_with(part.prefix)) continue;
        ++part.scene_passes;
        part.scene_draws += static_cast<int>(pass.layer_count);
    }
}

measure::Picture to_picture(const std::vector<std::byte>& texels, uvec2 size, TexelFormat format) {
    measure::Picture picture(static_cast<int>(size.x), static_cast<int>(size.y));
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        if (format == TexelFormat::rgba32f) {
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
std::vector<Value> read_values(const std::vector<std::byte>& bytes) {
    std::vector<Value> values(bytes.size() / sizeof(Value));
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

/// Returns the mirrors that rays hit (TechniqueResult::hits), from the alpha channel of a traced
/// picture.
std::vector<std::uint32_t> decode_hits(const std::vector<std::byte>& texels) {
    std::vector<std::uint32_t> hits;
    hits.reserve(texels.size() / sizeof(vec4));
    for (const vec4& texel : read_values<vec4>(texels)) {
        const std::uint32_t met = bvh::float_to_bits(texel.w) & ~f32::kBvhNormalFloatBit;
        hits.push_back((met & shared::kMaxMirrors) | met >> shared::kBitsPerMirrorHit << 16);
    }
    return hits;
}

void add_ray_counters(const std::vector<std::byte>& bytes, TechniqueResult& part) {
    shared::Counters counters;
    std::memcpy(&counters, bytes.data(), sizeof counters);
    check(counters.exhausted == 0, Failure::exhausted, "'", part.label, "': ", counters.exhausted,
          " pixels met more triangles and boxes than one invocation may (", counters.longest_walk,
          " steps); lower the depth");
    if (!part.rays) part.rays.emplace();
    part.rays->primary += counters.primary_rays;
    part.rays->mirror += counters.mirror_rays;
    part.rays->shadow += counters.shadow_rays;
    part.rays->longest_walk = std::max(part.rays->longest_walk, counters.longest_walk);
    if (counters.mirror_pixels > 0)
        part.traced_fraction = part.traced_fraction.value_or(0) +
                               static_cast<double>(counters.listed) / counters.mirror_pixels;
}

/// Returns the outcome of captures that are kept under a limit.
std::optional<CaptureBudget> make_capture_budget(const reflect::TechniqueOutputs& outputs,
                                                 const reflect::CaptureHistory& keeping) {
    if (!outputs.kept || (keeping.most == 0 && !render::take_turns(outputs.kept->options)))
        return std::nullopt;
    const render::CaptureCache& kept = *outputs.kept;
    const require::WorkModel& model = keeping.model;
    CaptureBudget capture_budget;
    for (std::size_t i = 0; i < kept.options.size(); ++i) {
        capture_budget.mirrors += kept.options[i].face > 0 &&
                                  (model.is_everything || model.mirrors[i].is_captured);
        capture_budget.every = std::max(capture_budget.every, kept.options[i].every);
        capture_budget.drawn += kept.changes[i] != render::CaptureChange::none;
        // If all captures are drawn in turns, one that waits need not have changed.
        capture_budget.waiting += !model.is_everything && kept.waited[i] > 0;
        capture_budget.longest = std::max(capture_budget.longest, kept.waited[i]);
    }
    capture_budget.most = keeping.most > 0 ? std::min(keeping.most, capture_budget.mirrors)
                                           : capture_budget.mirrors;
    return capture_budget;
}

/// Returns the bytes of persistent images that the frame does not use.
std::uint64_t unused_image_bytes(const graph::GraphRunner& runner, const graph::Graph& graph) {
    std::uint64_t bytes = 0;
    for (const auto& [name, kept] : runner.make_history().persistent) {
        const bool is_used = std::ranges::find(graph.images(), name, &graph::ImageDesc::name) !=
                             graph.images().end();
        if (!is_used) bytes += graph::default_sizer().image(kept.desc).bytes;
    }
    return bytes;
}

/// Counts texels of four halves with a colour at or above the largest half.
std::size_t count_saturated(const std::vector<std::byte>& bytes) {
    const std::vector<std::uint16_t> halves = read_values<std::uint16_t>(bytes);
    std::size_t count = 0;
    for (std::size_t i = 0; i + 3 < halves.size(); i += 4)
        count += std::any_of(&halves[i], &halves[i] + 3,
                             [](std::uint16_t half) { return (half & 0x7fff) >= kMaxHalfBits; });
    return count;
}

} // namespace

std::vector<reflect::TechniquePlan> parse_plans(const std::vector<std::string>& techniques) {
    check(!techniques.empty(), Failure::usage, "no technique was asked for");
    std::vector<reflect::TechniquePlan> plans;
    for (const std::string& text : techniques) {
        plans.push_back(read_plan(text));
        for (std::size_t i = 0; i + 1 < plans.size(); ++i)
            check(!plans[i].is_same(plans.back()), Failure::usage, "technique '", text,
                  "' is asked for twice");
    }
    return plans;
}

FrameGraph declare_frame(const FrameSpec& spec, const FrameHooks& hooks,
                         const render::FrameFacts& facts,
                         const std::vector<reflect::TechniquePlan>& plans,
                         const std::vector<std::string>& mirrors, const render::GpuScene& scene,
                         graph::GraphHistory history,
                         const std::vector<reflect::CaptureHistory>& keeping) {
    FrameGraph frame{
        graph::Graph(std::move(history)), render::FrameRequests(scene.next_view()), {}};
    for (const reflect::TechniquePlan& plan : plans) {
        const reflect::CaptureHistory& kept = keeping[frame.parts.size()];
        const std::string prefix = plans.size() > 1 ? plan.file_name() + "/" : "";
        const render::FrameInputs inputs{.scene = scene,
                                         .requests = frame.requests,
                                         .size = spec.size,
                                         .prefix = prefix,
                                         .ablated = hooks.ablated,
                                         .with_lookup = spec.with_lookup,
                                         .facts = facts,
                                         .exposure = spec.exposure};
        const reflect::Assignment assignment = reflect::replace_unfit(
            reflect::assign_techniques(plan, mirrors), scene.flat_faces(), scene.flat_tolerance());
        reflect::TechniqueOutputs outputs = reflect::add_frame_passes(frame.graph, inputs,
                                                                      assignment, kept);
        frame.graph.output(outputs.hdr);
        frame.graph.output(outputs.display);
        for (const graph::BufferHandle counters : outputs.counters) frame.graph.output(counters);
        if (outputs.lookup) frame.graph.output(*outputs.lookup);
        if (outputs.tracer_marks) frame.graph.output(*outputs.tracer_marks);
        if (outputs.captures && (spec.with_lookup || hooks.with_captures)) {
            for (const render::CubeCaptureArray& cubes : outputs.captures->arrays) {
                frame.graph.output(cubes.colour);
                if (hooks.with_captures && cubes.distance) frame.graph.output(*cubes.distance);
            }
        }
        const std::optional<CaptureBudget> capture_budget = make_capture_budget(outputs, kept);
        frame.parts.push_back({plan, assignment, prefix, std::move(outputs), capture_budget});
    }
    return frame;
}

bool remembers(const FrameGraph& frame, const graph::GraphPlan& plan, const FramePart& part) {
    return part.outputs.kept ||
           std::ranges::any_of(plan.passes, [&](const graph::PlannedPass& planned) {
               const graph::Pass& pass = frame.graph.passes()[planned.pass];
               return pass.name.starts_with(part.prefix) &&
                      (std::ranges::any_of(pass.images,
                                           [](const auto& use) { return use.image.previous; }) ||
                       std::ranges::any_of(pass.buffers,
                                           [](const auto& use) { return use.buffer.previous; }));
           });
}

measure::Picture read_hdr(graph::GraphRunner& runner, graph::FrameTicket ticket,
                          const FramePart& declared, uvec2 size) {
    return to_picture(runner.read_back(ticket, declared.outputs.hdr), size, TexelFormat::rgba32f);
}

/// Returns for each mirror the technique that drew it, and the rule of the plan that chose the
/// technique.
std::vector<PlanEntry> plan_entries(const FramePart& declared,
                                    const std::vector<std::string>& mirrors) {
    const auto& [choices, of_mirror, patterns, reasons, lacks] = declared.assignment;
    std::vector<PlanEntry> entries;
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const reflect::TechniqueChoice& choice = choices[of_mirror[i]];
        std::string why = patterns[i].empty() ? "one technique was asked for"
                                              : "rule '" + patterns[i] + "'";
        if (!reasons[i].empty()) why = reasons[i];
        const bool is_left_out = choices.size() > 1 && choice.shared.others.is_black;
        if (is_left_out) why += "; black in the captures of others, capture=none";
        entries.push_back({static_cast<std::uint32_t>(i + 1), mirrors[i],
                           std::string(choice.technique->name), knob_settings(choice),
                           std::move(why)});
    }
    return entries;
}

/// Returns sentences about mirrors that their technique cannot draw as asked. Mirrors that lack the
/// same share a sentence, which names the first of them.
std::vector<std::string> describe_unmet_requests(const FramePart& declared,
                                                 const std::vector<std::string>& mirrors) {
    constexpr std::size_t kMaxNamedMirrors = 3;
    std::vector<std::pair<std::string, std::vector<std::size_t>>> groups;
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const std::string& lack = declared.assignment.lacks[i];
        if (lack.empty()) continue;
        auto group = std::ranges::find(groups, lack, [](const auto& known) { return known.first; });
        if (group == groups.end()) group = groups.insert(group, {lack, {}});
        group->second.push_back(i);
    }
    std::vector<std::string> said;
    for (const auto& [lack, lacking] : groups) {
        std::string names;
        for (std::size_t k = 0; k < std::min(kMaxNamedMirrors, lacking.size()); ++k)
            names += (k ? ", " : "") + std::to_string(lacking[k] + 1) + " " +
                     quote(mirrors[lacking[k]]);
        if (lacking.size() > kMaxNamedMirrors)
            names += " and " + std::to_string(lacking.size() - kMaxNamedMirrors) + " more";
        said.push_back((lacking.size() > 1 ? "mirrors " : "mirror ") + names + ": " + lack);
    }
    return said;
}

TechniqueResult read_result(graph::GraphRunner& runner, graph::FrameTicket ticket,
                            const FrameGraph& frame, std::size_t index,
                            const std::vector<std::string>& mirrors, const render::GpuScene& scene,
                            const FrameSpec& spec) {
    const FramePart& declared = frame.parts[index];
    const reflect::TechniqueOutputs& outputs = declared.outputs;
    const graph::GraphPlan& plan = runner.plan(frame.graph);
    TechniqueResult part;
    part.label = declared.plan.label;
    part.prefix = declared.prefix;
    part.plan = plan_entries(declared, mirrors);
    part.memory_bytes = plan.bytes + unused_image_bytes(runner, frame.graph);
    part.remembers = session::remembers(frame, plan, declared);
    count_scene_passes(frame.graph, plan, part);
    part.notes = outputs.notes;
    std::ranges::move(describe_unmet_requests(declared, mirrors), std::back_inserter(part.notes));
    for (const reflect::TechniqueChoice& choice : declared.assignment.choices)
        if (choice.shared.capture.chooses_face)
            part.auto_face = AutoFace{scene.common_face_edge(), scene.used_face_edges()};
    for (const graph::BufferHandle counters : outputs.counters)
        add_ray_counters(runner.read_back(ticket, counters), part);
    const std::vector<std::byte> texels = runner.read_back(ticket, outputs.hdr);
    part.hdr = to_picture(texels, spec.size, TexelFormat::rgba32f);
    if (outputs.has_hits) part.hits = decode_hits(texels);
    part.display = to_picture(runner.read_back(ticket, outputs.display), spec.size,
                              TexelFormat::rgba8_unorm);
    if (spec.with_lookup && outputs.captures)
        for (const render::CubeCaptureArray& cubes : outputs.captures->arrays)
            if (frame.graph.images()[cubes.colour.id].format == TexelFormat::rgba16f)
                part.saturated = part.saturated.value_or(0) +
                                 count_saturated(runner.read_back(ticket, cubes.colour));
    if (outputs.lookup) part.lookup = read_values<vec4>(runner.read_back(ticket, *outputs.lookup));
    return part;
}

} // namespace catoptric::session
