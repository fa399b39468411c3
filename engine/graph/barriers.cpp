#include "graph/barriers.hpp"

#include "graph/memory_users.hpp"

#include <bit>

namespace catoptric::graph {

namespace {

/// The accesses so far in this frame to one layer of an image, or to a buffer.
struct AccessHistory {
    AccessCode write = kNoAccess; // the last write in this frame; kNoAccess: none
    AccessList readers;           // distinct readers since that write or the last layout change

    /// Returns the earlier accesses that the next write must wait for. For an image, all of them
    /// have its present layout.
    AccessList awaited_by_write() const {
        if (!readers.empty()) return readers;
        return write == kNoAccess ? AccessList() : AccessList(write);
    }
    friend bool operator==(const AccessHistory&, const AccessHistory&) = default;
};

/// The result is empty if an earlier read by the same kind of access already waited.
AccessList awaited_by_read(const AccessHistory& state, AccessCode touch, bool is_buffer) {
    if (state.readers.contains(touch)) return {};
    if (state.readers.empty() || is_buffer) return AccessList(state.write);
    // The layout stays the same, and only the shader stage differs. The barrier names the earlier
    // reader, because `before` must name the present layout. The earlier reader itself waited for
    // the write.
    if (decode_use(state.readers.first()) == decode_use(touch))
        return AccessList(state.readers.first());
    return state.readers; // a layout change counts as a write
}

void record_access(AccessHistory& state, AccessCode touch, bool is_buffer) {
    if (access_state(touch).write) {
        state = {.write = touch, .readers = {}};
        return;
    }
    const bool moved = !state.readers.empty() &&
                       decode_use(state.readers.first()) != decode_use(touch);
    if (moved && !is_buffer) state.readers.remove_all();
    state.readers.add(touch);
}

std::vector<AccessState> to_states(AccessSet set) {
    std::vector<AccessState> touches;
    for (; set; set &= set - 1)
        touches.push_back(access_state(static_cast<AccessCode>(std::countr_zero(set))));
    return touches;
}

/// Returns whether barrier `next` covers only the layers, or only the mips, that follow those of
/// barrier `last`, so that both can be merged.
bool can_merge(const PlannedBarrier& last, const PlannedBarrier& next) {
    if (last.is_buffer || next.is_buffer || last.id != next.id || last.previous != next.previous)
        return false;
    if (last.before != next.before || last.after != next.after || last.shared != next.shared)
        return false;
    const bool same_layers = last.first_layer == next.first_layer &&
                             last.layer_count == next.layer_count;
    const bool same_mips = last.first_mip == next.first_mip && last.mip_count == next.mip_count;
    return (same_mips && last.first_layer + last.layer_count == next.first_layer) ||
           (same_layers && last.first_mip + last.mip_count == next.first_mip);
}

/// Merges the barrier with the last one if it continues that one.
void append_barrier(std::vector<PlannedBarrier>& barriers, PlannedBarrier&& barrier) {
    if (barriers.empty() || !can_merge(barriers.back(), barrier)) {
        barriers.push_back(std::move(barrier));
        return;
    }
    PlannedBarrier& last = barriers.back();
    if (last.first_mip == barrier.first_mip)
        last.layer_count += barrier.layer_count;
    else
        last.mip_count += barrier.mip_count;
}

/// Calls visit(first mip, mips, first layer, layers) for rectangles that cover the numbers [first,
/// end) of an image with `layers` layers.
template <typename Visit>
void for_each_rectangle(std::uint32_t first, std::uint32_t end, std::uint32_t layers,
                        const Visit& visit) {
    while (first < end) {
        const std::uint32_t mip = first / layers, layer = first % layers;
        const std::uint32_t mips = layer == 0 ? (end - first) / layers : 0;
        const std::uint32_t count = mips > 0 ? layers : std::min(layers - layer, end - first);
        visit(mip, std::max(mips, 1u), layer, count);
        first += std::max(mips, 1u) * count;
    }
}

/// Returns the access history, at the beginning of a frame, of an image whose contents are ready
/// for every shader stage that accesses it by this use.
AccessHistory reader_history(ResourceUse use) {
    const AccessState compute{.nothing = false, .use = use, .write = false, .raster = false};
    AccessState raster = compute;
    raster.raster = true;
    AccessHistory state{.write = kNoAccess, .readers = AccessList(encode_access(compute))};
    state.readers.add(encode_access(raster));
    return state;
}

AccessHistory start_history(const Graph& graph, std::uint32_t image) {
    if (graph.image_lifetime(image) == Lifetime::persistent)
        return reader_history(ResourceUse::sampled);
    if (graph.image_lifetime(image) == Lifetime::imported && graph.use_on_import(image))
        return reader_history(*graph.use_on_import(image));
    return {};
}

/// Tracks the access state of every image and buffer from the first pass of a frame to the last.
class BarrierPlanner {
public:
    BarrierPlanner(const Graph& graph, const GraphPlan& plan)
        : graph_(graph), plan_(plan), states_(graph),
          previous_(graph, reader_history(ResourceUse::sampled)), users_(plan) {
        for (std::uint32_t i = 0; i < plan.images.size(); ++i)
            if (const AccessHistory state = start_history(graph, i);
                !state.awaited_by_write().empty())
                states_.set(whole_image(graph, i), state);
    }

    void plan_access(const ResourceAccess& access, const AccessState& touch,
                     std::vector<PlannedBarrier>& barriers) {
        const AccessCode code = encode_access(touch);
        const auto visit = [&](std::uint32_t first, std::uint32_t end, AccessHistory& state) {
            if (state.awaited_by_write().empty())
                emit_barriers(access, first, end, {}, touch,
                              to_states(users_.unfinished_accesses(memory_placement(access))),
                              barriers);
            else
                add_barriers(access, first, end,
                             touch.write ? state.awaited_by_write()
                                         : awaited_by_read(state, code, access.is_buffer),
                             touch, barriers);
            record_access(state, code, access.is_buffer);
        };
        (access.previous ? previous_ : states_).modify(access, visit);
    }

    /// Called after the last pass that accesses the resource.
    void record_last_users(const ResourceAccess& access) {
        if (memory_placement(access).alone) return; // no later resource uses its memory
        AccessSet touches = 0;
        states_.runs(access).for_each_run(
            [&](std::uint32_t, std::uint32_t, const AccessHistory& state) {
                const AccessList latest = state.awaited_by_write();
                for (std::size_t i = 0; i < latest.size(); ++i) touches |= to_access_set(latest[i]);
            });
        users_.record(memory_placement(access), touches);
    }

    /// Adds a barrier to this use for each layer of the access, even if the frame itself does not
    /// need the barrier, because work after the frame relies on the layout. `untouched`: also for
    /// layers that no pass accessed.
    void plan_transition(const ResourceAccess& access, ResourceUse use, bool untouched,
                         std::vector<PlannedBarrier>& barriers) {
        const AccessHistory start = access.is_buffer ? AccessHistory()
                                                     : start_history(graph_, access.id);
        const AccessState touch{.nothing = false, .use = use};
        states_.for_each(access,
                         [&](std::uint32_t first, std::uint32_t end, const AccessHistory& state) {
                             if (!untouched && state == start) return;
                             AccessList latest = state.awaited_by_write();
                             // No pass accessed these layers, so the barrier may discard their
                             // contents.
                             if (latest.empty()) latest.add(kNoAccess);
                             add_barriers(access, first, end, latest, touch, barriers);
                         });
    }

    const MemoryPlacement& memory_placement(const ResourceAccess& access) const {
        return access.is_buffer ? plan_.buffers[access.id] : plan_.images[access.id];
    }

private:
    void add_barriers(const ResourceAccess& access, std::uint32_t first, std::uint32_t end,
                      const AccessList& awaited, const AccessState& touch,
                      std::vector<PlannedBarrier>& barriers) const {
        if (awaited.empty()) return;
        std::vector<AccessState> others;
        for (std::size_t i = 1; i < awaited.size(); ++i) others.push_back(access_state(awaited[i]));
        emit_barriers(access, first, end, access_state(awaited.first()), touch, others, barriers);
    }

    void emit_barriers(const ResourceAccess& access, std::uint32_t first, std::uint32_t end,
                       const AccessState& before, const AccessState& after,
                       const std::vector<AccessState>& shared,
                       std::vector<PlannedBarrier>& barriers) const {
        // A buffer has no layout, so it needs no barrier if there is nothing to wait for.
        if (access.is_buffer && before.nothing && shared.empty()) return;
        for_each_rectangle(first, end, states_.layer_count(access),
                           [&](std::uint32_t first_mip, std::uint32_t mips,
                               std::uint32_t first_layer, std::uint32_t layers) {
                               append_barrier(barriers, {.is_buffer = access.is_buffer,
                                                         .id = access.id,
                                                         .previous = access.previous,
                                                         .first_layer = first_layer,
                                                         .layer_count = layers,
                                                         .first_mip = first_mip,
                                                         .mip_count = mips,
                                                         .before = before,
                                                         .after = after,
                                                         .shared = shared});
                           });
    }

    const Graph& graph_;
    const GraphPlan& plan_;
    SubresourceValues<AccessHistory> states_, previous_;
    MemoryUsers users_;
};

void add_output_barriers(const ResourceAccess& whole, const SubresourceValues<char>& wanted,
                         BarrierPlanner& tracker, std::vector<PlannedBarrier>& barriers) {
    const auto leave = [&](std::uint32_t first, std::uint32_t end, bool is_wanted) {
        if (!is_wanted) return;
        for_each_rectangle(first, end, wanted.layer_count(whole),
                           [&](std::uint32_t first_mip, std::uint32_t mips,
                               std::uint32_t first_layer, std::uint32_t layers) {
                               ResourceAccess part = whole;
                               part.first_mip = first_mip, part.mip_count = mips;
                               part.first_layer = first_layer, part.layer_count = layers;
                               tracker.plan_transition(part, ResourceUse::copy_from, true,
                                                       barriers);
                           });
    };
    wanted.runs(whole).for_each_run(leave);
}

void add_end_barriers(const Graph& graph, BarrierPlanner& tracker, GraphPlan& plan) {
    const SubresourceValues<char> wanted = output_parts(graph);
    for (std::uint32_t i = 0; i < plan.images.size(); ++i) {
        const ResourceAccess whole = whole_image(graph, i);
        const bool stays = graph.image_lifetime(i) ==
                           Lifetime::persistent; // also if no pass touches it
        switch (plan.images[i].used || stays ? graph.image_lifetime(i) : Lifetime::frame) {
        case Lifetime::frame: add_output_barriers(whole, wanted, tracker, plan.last); break;
        case Lifetime::previous:
            tracker.plan_transition(whole, ResourceUse::sampled, true, plan.last);
            break;
        case Lifetime::persistent:
            tracker.plan_transition(whole, ResourceUse::sampled, false, plan.last);
            break;
        case Lifetime::imported:
            tracker.plan_transition(whole, graph.use_on_release(i),
                                    graph.use_on_import(i) != graph.use_on_release(i), plan.last);
            break;
        }
    }
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b) {
        const ResourceAccess whole{.is_buffer = true, .id = b};
        const Lifetime lifetime = plan.buffers[b].used ? graph.buffer_lifetime(b) : Lifetime::frame;
        if (lifetime == Lifetime::frame)
            add_output_barriers(whole, wanted, tracker, plan.last);
        else
            tracker.plan_transition(whole, ResourceUse::copy_from, false, plan.last);
    }
}

} // namespace

void plan_barriers(const Graph& graph, const GraphAccesses& all, GraphPlan& plan) {
    BarrierPlanner tracker(graph, plan);
    for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
        PlannedPass& planned = plan.passes[position];
        const Pass& pass = graph.passes()[planned.pass];
        const std::span<const ResourceAccess> uses = all.of_pass(planned.pass);
        planned.barriers.reserve(uses.size());
        for (const ResourceAccess& a : uses)
            tracker.plan_access(a, access_state(a, pass), planned.barriers);
        for (const ResourceAccess& a : uses)
            if (tracker.memory_placement(a).last == position) tracker.record_last_users(a);
    }
    add_end_barriers(graph, tracker, plan);
}

} // namespace catoptric::graph
