#include "graph/barriers.hpp"

#include "graph/memory_users.hpp"

#include <bit>

namespace catoptric::graph {

namespace {

/// The touches of one layer of an image, or of a buffer, so far in this frame.
struct TouchState {
    TouchCode write = kNoTouch; // the last write in this frame; kNoTouch: none
    TouchList readers;          // distinct readers since that write or the last layout change

    /// Returns the touches that the next write must wait for. For an image, all have its present
    /// layout.
    TouchList latest() const {
        if (!readers.empty()) return readers;
        return write == kNoTouch ? TouchList() : TouchList(write);
    }
    friend bool operator==(const TouchState&, const TouchState&) = default;
};

/// Returns the touches that a read must wait for; empty if an earlier reader with this touch
/// already waited.
TouchList touches_before_read(const TouchState& state, TouchCode touch, bool is_buffer) {
    if (state.readers.contains(touch)) return {};
    if (state.readers.empty() || is_buffer) return TouchList(state.write);
    // The layout stays and only the stage differs. `before` must name the present layout. So the
    // barrier waits for a reader, which itself waited for the write.
    if (decode_touch_use(state.readers.front()) == decode_touch_use(touch))
        return TouchList(state.readers.front());
    return state.readers; // a layout change counts as a write
}

void record_touch(TouchState& state, TouchCode touch, bool is_buffer) {
    if (make_touch(touch).write) {
        state = {.write = touch, .readers = {}};
        return;
    }
    const bool moved = !state.readers.empty() &&
                       decode_touch_use(state.readers.front()) != decode_touch_use(touch);
    if (moved && !is_buffer) state.readers.clear();
    state.readers.add(touch);
}

std::vector<ResourceTouch> list_touches(TouchSet set) {
    std::vector<ResourceTouch> touches;
    for (; set; set &= set - 1)
        touches.push_back(make_touch(static_cast<TouchCode>(std::countr_zero(set))));
    return touches;
}

/// Returns whether `next` only continues the layers, or the mips, of `last`.
bool continues_range(const PlannedBarrier& last, const PlannedBarrier& next) {
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

/// Adds a barrier. If it continues the last barrier, both are merged.
void append_barrier(std::vector<PlannedBarrier>& barriers, PlannedBarrier&& barrier) {
    if (barriers.empty() || !continues_range(barriers.back(), barrier)) {
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
void for_each_subresource_rectangle(std::uint32_t first, std::uint32_t end, std::uint32_t layers,
                                    const Visit& visit) {
    while (first < end) {
        const std::uint32_t mip = first / layers, layer = first % layers;
        const std::uint32_t mips = layer == 0 ? (end - first) / layers : 0;
        const std::uint32_t count = mips > 0 ? layers : std::min(layers - layer, end - first);
        visit(mip, std::max(mips, 1u), layer, count);
        first += std::max(mips, 1u) * count;
    }
}

/// Returns the state of contents that every shader stage may use in this way when the frame begins.
TouchState state_on_arrival(ResourceUse use) {
    const ResourceTouch compute{.nothing = false, .use = use, .write = false, .raster = false};
    ResourceTouch raster = compute;
    raster.raster = true;
    TouchState state{.write = kNoTouch, .readers = TouchList(encode_touch(compute))};
    state.readers.add(encode_touch(raster));
    return state;
}

/// Returns the state of an image at the start of a frame.
TouchState state_at_frame_start(const Graph& graph, std::uint32_t image) {
    if (graph.lifetime(image) == ImageLifetime::persistent)
        return state_on_arrival(ResourceUse::sampled);
    if (graph.lifetime(image) == ImageLifetime::imported && graph.state_on_import(image))
        return state_on_arrival(*graph.state_on_import(image));
    return {};
}

/// Holds the state of every image and buffer while the frame is walked from first to last pass.
class ResourceStateTracker {
public:
    ResourceStateTracker(const Graph& graph, const GraphPlan& plan)
        : graph_(graph), plan_(plan), states_(graph),
          previous_(graph, state_on_arrival(ResourceUse::sampled)), users_(plan) {
        for (std::uint32_t i = 0; i < plan.images.size(); ++i)
            if (const TouchState state = state_at_frame_start(graph, i); !state.latest().empty())
                states_.set_value(access_to_whole_image(graph, i), state);
    }

    void touch(const ResourceAccess& access, const ResourceTouch& touch,
               std::vector<PlannedBarrier>& barriers) {
        const TouchCode code = encode_touch(touch);
        const auto visit = [&](std::uint32_t first, std::uint32_t end, TouchState& state) {
            if (state.latest().empty())
                emit_barriers(access, first, end, {}, touch,
                              list_touches(users_.touches_left_in(placement(access))), barriers);
            else
                wait(access, first, end,
                     touch.write ? state.latest()
                                 : touches_before_read(state, code, access.is_buffer),
                     touch, barriers);
            record_touch(state, code, access.is_buffer);
        };
        (access.previous ? previous_ : states_).modify_values(access, visit);
    }

    /// Called after the last pass that touches the resource of the access.
    void finish_resource(const ResourceAccess& access) {
        if (placement(access).alone) return; // no later resource uses its memory
        TouchSet touches = 0;
        states_.of(access).for_each_run([&](std::uint32_t, std::uint32_t, const TouchState& state) {
            const TouchList latest = state.latest();
            for (std::size_t i = 0; i < latest.size(); ++i) touches |= touch_set_of(latest[i]);
        });
        users_.record_last_touches(placement(access), touches);
    }

    /// Adds a barrier for each layer, even if it is not needed within the frame: the work after the
    /// frame relies on it. `untouched`: also for layers that no pass touched.
    void transition_to_use(const ResourceAccess& access, ResourceUse use, bool untouched,
                           std::vector<PlannedBarrier>& barriers) {
        const TouchState start = access.is_buffer ? TouchState()
                                                  : state_at_frame_start(graph_, access.id);
        const ResourceTouch touch{.nothing = false, .use = use};
        states_.for_each_value(
            access, [&](std::uint32_t first, std::uint32_t end, const TouchState& state) {
                if (!untouched && state == start) return;
                TouchList latest = state.latest();
                // Never touched: the barrier discards the contents.
                if (latest.empty()) latest.add(kNoTouch);
                wait(access, first, end, latest, touch, barriers);
            });
    }

    const MemoryPlacement& placement(const ResourceAccess& access) const {
        return access.is_buffer ? plan_.buffers[access.id] : plan_.images[access.id];
    }

private:
    void wait(const ResourceAccess& access, std::uint32_t first, std::uint32_t end,
              const TouchList& awaited, const ResourceTouch& touch,
              std::vector<PlannedBarrier>& barriers) const {
        if (awaited.empty()) return;
        std::vector<ResourceTouch> others;
        for (std::size_t i = 1; i < awaited.size(); ++i) others.push_back(make_touch(awaited[i]));
        emit_barriers(access, first, end, make_touch(awaited.front()), touch, others, barriers);
    }

    void emit_barriers(const ResourceAccess& access, std::uint32_t first, std::uint32_t end,
                       const ResourceTouch& before, const ResourceTouch& after,
                       const std::vector<ResourceTouch>& shared,
                       std::vector<PlannedBarrier>& barriers) const {
        // A buffer has no layout, so it needs no barrier if there is nothing to wait for.
        if (access.is_buffer && before.nothing && shared.empty()) return;
        for_each_subresource_rectangle(first, end, states_.layer_count_of(access),
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
    SubresourceMap<TouchState> states_, previous_;
    SharedMemoryUsers users_;
};

void add_output_barriers(const ResourceAccess& whole, const SubresourceMap<char>& wanted,
                         ResourceStateTracker& tracker, std::vector<PlannedBarrier>& barriers) {
    const auto leave = [&](std::uint32_t first, std::uint32_t end, bool is_wanted) {
        if (!is_wanted) return;
        for_each_subresource_rectangle(
            first, end, wanted.layer_count_of(whole),
            [&](std::uint32_t first_mip, std::uint32_t mips, std::uint32_t first_layer,
                std::uint32_t layers) {
                ResourceAccess part = whole;
                part.first_mip = first_mip, part.mip_count = mips;
                part.first_layer = first_layer, part.layer_count = layers;
                tracker.transition_to_use(part, ResourceUse::copy_from, true, barriers);
            });
    };
    wanted.of(whole).for_each_run(leave);
}

void add_frame_end_barriers(const Graph& graph, ResourceStateTracker& tracker, GraphPlan& plan) {
    const SubresourceMap<char> wanted = mark_output_parts(graph);
    for (std::uint32_t i = 0; i < plan.images.size(); ++i) {
        const ResourceAccess whole = access_to_whole_image(graph, i);
        const bool stays = graph.lifetime(i) ==
                           ImageLifetime::persistent; // also if no pass touches it
        switch (plan.images[i].used || stays ? graph.lifetime(i) : ImageLifetime::frame) {
        case ImageLifetime::frame: add_output_barriers(whole, wanted, tracker, plan.last); break;
        case ImageLifetime::previous:
            tracker.transition_to_use(whole, ResourceUse::sampled, true, plan.last);
            break;
        case ImageLifetime::persistent:
            tracker.transition_to_use(whole, ResourceUse::sampled, false, plan.last);
            break;
        case ImageLifetime::imported:
            tracker.transition_to_use(whole, graph.state_on_release(i),
                                      graph.state_on_import(i) != graph.state_on_release(i),
                                      plan.last);
            break;
        }
    }
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b) {
        const ResourceAccess whole{.is_buffer = true, .id = b};
        if (plan.buffers[b].used && graph.is_imported({b}))
            tracker.transition_to_use(whole, ResourceUse::copy_from, false, plan.last);
        else
            add_output_barriers(whole, wanted, tracker, plan.last);
    }
}

} // namespace

void plan_barriers(const Graph& graph, const GraphAccesses& all, GraphPlan& plan) {
    ResourceStateTracker tracker(graph, plan);
    for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
        PlannedPass& planned = plan.passes[position];
        const Pass& pass = graph.passes()[planned.pass];
        const std::span<const ResourceAccess> uses = all.accesses_of_pass(planned.pass);
        planned.barriers.reserve(uses.size());
        for (const ResourceAccess& a : uses)
            tracker.touch(a, make_touch(a, pass), planned.barriers);
        for (const ResourceAccess& a : uses)
            if (tracker.placement(a).last == position) tracker.finish_resource(a);
    }
    add_frame_end_barriers(graph, tracker, plan);
}

} // namespace catoptric::graph
