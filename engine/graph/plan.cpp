#include "graph/plan.hpp"

#include "core/error.hpp"
#include "graph/barriers.hpp"
#include "graph/cull.hpp"
#include "graph/memory_placement.hpp"
#include "graph/validate.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

void cull_passes(const Graph& graph, const GraphAccesses& all, GraphPlan& plan) {
    const std::vector<CullDecision> fates = graph::cull_decisions(graph, all);
    plan.passes.reserve(fates.size());
    for (std::uint32_t p = 0; p < fates.size(); ++p) {
        if (!fates[p].survives) {
            plan.culled.push_back({p, cull_reason(graph, all.of_pass(p))});
            continue;
        }
        plan.passes.push_back({p, {}, fates[p].unread});
        plan.scene_passes += graph.passes()[p].tag == PassPurpose::scene ? 1 : 0;
    }
}

bool outlives_frame(Lifetime lifetime) {
    return lifetime == Lifetime::previous || lifetime == Lifetime::persistent;
}

/// Returns the bytes of the largest allocation. Each resource that outlives the frame has its own
/// allocation. A heap has one for all other outputs, and one for the rest.
std::uint64_t largest_allocation(const Graph& graph, const GraphPlan& plan) {
    std::uint64_t largest = 0;
    std::vector<std::uint64_t> begin(plan.heap_bytes), end(plan.heap_bytes.size()); // of outputs
    std::vector<std::uint64_t> alignment(plan.heap_bytes.size(), 1);
    const auto add = [&](const MemoryPlacement& placement) {
        if (!placement.used) return;
        if (!placement.alone)
            largest = std::max(largest, placement.offset + placement.bytes);
        else if (placement.bytes > 0) {
            begin[placement.heap] = std::min(begin[placement.heap], placement.offset);
            end[placement.heap] = std::max(end[placement.heap], placement.offset + placement.bytes);
            alignment[placement.heap] = std::max(alignment[placement.heap], placement.alignment);
        }
    };
    const auto add_by_lifetime = [&](const MemoryPlacement& placement, Lifetime lifetime) {
        if (outlives_frame(lifetime))
            largest = std::max(largest, placement.used ? placement.bytes : 0);
        else
            add(placement);
    };
    for (std::uint32_t i = 0; i < plan.images.size(); ++i)
        add_by_lifetime(plan.images[i], graph.image_lifetime(i));
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b)
        add_by_lifetime(plan.buffers[b], graph.buffer_lifetime(b));
    for (std::size_t heap = 0; heap < begin.size(); ++heap)
        if (end[heap] > 0)
            largest = std::max(largest,
                               end[heap] - begin[heap] / alignment[heap] * alignment[heap]);
    return largest;
}

void check_memory_limits(const Graph& graph, const GraphPlan& plan, const GraphLimits& limits) {
    const std::uint64_t piece = largest_allocation(graph, plan);
    const bool too_much = plan.bytes > limits.max_memory;
    if (!too_much && piece <= limits.max_allocation) return;
    std::uint64_t bytes = 0;
    std::string name;
    const auto look = [&](const MemoryPlacement& placement, const std::string& candidate) {
        if (placement.bytes <= bytes) return;
        bytes = placement.bytes;
        name = candidate;
    };
    for (std::size_t i = 0; i < plan.images.size(); ++i)
        look(plan.images[i], graph.images()[i].name);
    for (std::size_t b = 0; b < plan.buffers.size(); ++b)
        look(plan.buffers[b], graph.buffers()[b].name);
    fail(Failure::exhausted, "the frame wants ", too_much ? plan.bytes : piece, " bytes of memory",
         too_much ? "" : " in one piece", ", device allows ",
         too_much ? "max_memory = " : "max_allocation = ",
         too_much ? limits.max_memory : limits.max_allocation, "; the largest is '", name,
         "' with ", bytes);
}

} // namespace

MemorySizer default_sizer() {
    constexpr std::uint64_t kDefaultMemoryAlignment = 256;
    const auto padded = [](std::uint64_t bytes) {
        return MemoryRequirements{.bytes = (bytes + kDefaultMemoryAlignment - 1) /
                                           kDefaultMemoryAlignment * kDefaultMemoryAlignment,
                                  .alignment = kDefaultMemoryAlignment,
                                  .heap = 0};
    };
    return {.image =
                [=](const ImageDesc& desc) {
                    std::uint64_t texels = 0;
                    for (std::uint32_t m = 0; m < desc.mips; ++m)
                        texels += std::uint64_t{mip_size(desc.width, m)} * mip_size(desc.height, m);
                    return padded(texels * desc.layers * bytes_per_texel(desc.format));
                },
            .buffer = [=](const BufferDesc& desc) { return padded(desc.bytes); }};
}

GraphPlan plan_graph(const Graph& graph, const GraphLimits& limits, const MemorySizer& sizer) {
    const GraphAccesses all(graph);
    validate_graph(graph, all, limits);
    GraphPlan plan;
    cull_passes(graph, all, plan);
    find_lifetimes(graph, all, plan);
    place_resources(graph, sizer, plan);
    check_memory_limits(graph, plan, limits);
    plan_barriers(graph, all, plan);
    return plan;
}

} // namespace catoptric::graph
