#include "graph/barriers.hpp"

namespace catoptric::graph {

namespace {

/// What happened so far in this frame to one layer of an image or to a buffer.
struct State {
    Touch write;                // the last one; `nothing`: none in this frame
    std::vector<Touch> readers; // since that write or the last change of layout; distinct

    /// What the next write must wait for. For an image all are in the layout it has now.
    std::vector<Touch> latest() const {
        if (!readers.empty()) return readers;
        return write.nothing ? std::vector<Touch>{} : std::vector{write};
    }
};

bool contains(const std::vector<Touch>& touches, const Touch& touch) {
    return std::ranges::find(touches, touch) != touches.end();
}

/// What a read must wait for; empty when an earlier reader waited in its stead.
std::vector<Touch> awaited_by_read(const State& state, const Touch& touch, bool is_buffer) {
    if (contains(state.readers, touch)) return {};
    if (state.readers.empty() || is_buffer) return {state.write};
    // Same layout, another stage: `before` must tell the present layout, so chain to a reader,
    // which waited for the write, rather than to the write.
    if (state.readers.front().use == touch.use) return {state.readers.front()};
    return state.readers; // a change of layout is a write
}

void advance(State& state, const Touch& touch, bool is_buffer) {
    if (touch.write) {
        state = {.write = touch, .readers = {}};
        return;
    }
    const bool moved = !state.readers.empty() && state.readers.front().use != touch.use;
    if (moved && !is_buffer) state.readers.clear();
    if (!contains(state.readers, touch)) state.readers.push_back(touch);
}

bool memory_overlaps(const Placement& a, const Placement& b) {
    return a.used && b.used && a.heap == b.heap && a.offset < b.offset + b.bytes &&
           b.offset < a.offset + a.bytes;
}

/// Adds a barrier, as part of the last one when it only continues its layers.
void append(std::vector<Barrier>& barriers, const Barrier& barrier) {
    if (!barriers.empty() && !barrier.is_buffer) {
        Barrier& last = barriers.back();
        if (!last.is_buffer && last.id == barrier.id && last.previous == barrier.previous &&
            last.first_layer + last.layer_count == barrier.first_layer &&
            last.before == barrier.before && last.after == barrier.after &&
            last.shared == barrier.shared) {
            last.layer_count += barrier.layer_count;
            return;
        }
    }
    barriers.push_back(barrier);
}

/// Owns the states of everything while the frame is walked from top to bottom.
class Tracker {
public:
    Tracker(const Graph& graph, const Plan& plan)
        : plan_(plan), states_(graph), previous_(graph, arrived()) {}

    void touch(const Access& access, const Touch& touch, std::vector<Barrier>& barriers) {
        std::vector<State>& layers = (access.previous ? previous_ : states_).of(access);
        for (std::uint32_t l = access.first_layer; l < access.end_layer(); ++l) {
            State& state = layers[l];
            if (state.latest().empty()) {
                emit(access, l, {}, touch, last_users_of_memory(access), barriers);
            } else {
                std::vector<Touch> awaited = touch.write
                                                 ? state.latest()
                                                 : awaited_by_read(state, touch, access.is_buffer);
                wait(access, l, std::move(awaited), touch, barriers);
            }
            advance(state, touch, access.is_buffer);
        }
    }

    /// A barrier for each layer, needed or not: whoever comes after the frame relies on it.
    void leave(const Access& access, const Touch& touch, std::vector<Barrier>& barriers) {
        const std::vector<State>& layers = states_.of(access);
        for (std::uint32_t l = access.first_layer; l < access.end_layer(); ++l) {
            std::vector<Touch> latest = layers[l].latest();
            if (latest.empty()) latest.push_back({}); // never touched: from nothing
            wait(access, l, std::move(latest), touch, barriers);
        }
    }

private:
    /// Last frame's contents: the end of that frame made them ready for every stage.
    static State arrived() {
        const Touch compute{.nothing = false, .use = Use::sampled, .write = false, .raster = false};
        Touch raster = compute;
        raster.raster = true;
        return {.write = {}, .readers = {compute, raster}};
    }

    static void wait(const Access& access, std::uint32_t layer, std::vector<Touch> awaited,
                     const Touch& touch, std::vector<Barrier>& barriers) {
        if (awaited.empty()) return;
        const Touch before = awaited.front();
        awaited.erase(awaited.begin());
        emit(access, layer, before, touch, std::move(awaited), barriers);
    }

    static void emit(const Access& access, std::uint32_t layer, const Touch& before,
                     const Touch& after, std::vector<Touch> shared,
                     std::vector<Barrier>& barriers) {
        // A buffer has no layout: without anything to wait for there is nothing to do.
        if (access.is_buffer && before.nothing && shared.empty()) return;
        append(barriers, {.is_buffer = access.is_buffer,
                          .id = access.id,
                          .previous = access.previous,
                          .first_layer = layer,
                          .layer_count = 1,
                          .before = before,
                          .after = after,
                          .shared = std::move(shared)});
    }

    std::vector<Touch> last_users_of_memory(const Access& access) {
        const Placement& mine = access.is_buffer ? plan_.buffers[access.id]
                                                 : plan_.images[access.id];
        std::vector<Touch> touches;
        const auto collect = [&](bool is_buffer, const std::vector<Placement>& placements) {
            for (std::uint32_t id = 0; id < placements.size(); ++id) {
                const Placement& other = placements[id];
                if (other.last >= mine.first || !memory_overlaps(mine, other)) continue;
                for (const State& state : states_.of(is_buffer, id))
                    for (const Touch& touch : state.latest())
                        if (!contains(touches, touch)) touches.push_back(touch);
            }
        };
        collect(false, plan_.images);
        collect(true, plan_.buffers);
        return touches;
    }

    const Plan& plan_;
    PerLayer<State> states_, previous_;
};

void order_end(const Graph& graph, Tracker& tracker, Plan& plan) {
    Touch touch{.nothing = false, .use = Use::copy_from};
    std::vector<std::vector<char>> wanted;
    for (const ImageDesc& desc : graph.images()) wanted.emplace_back(desc.layers, false);
    for (const Image& image : graph.wanted_images())
        std::fill_n(wanted[image.id].begin() + image.first_layer, image.layer_count, true);
    for (std::uint32_t i = 0; i < wanted.size(); ++i) {
        const bool kept = plan.images[i].used && graph.is_kept(i);
        touch.use = kept ? Use::sampled : Use::copy_from;
        for (std::uint32_t l = 0; l < wanted[i].size(); ++l)
            if (kept || wanted[i][l]) tracker.leave({.id = i, .first_layer = l}, touch, plan.last);
    }
    touch.use = Use::copy_from;
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b)
        if (std::ranges::find(graph.wanted_buffers(), b, &Buffer::id) !=
            graph.wanted_buffers().end())
            tracker.leave({.is_buffer = true, .id = b}, touch, plan.last);
}

} // namespace

void order(const Graph& graph, Plan& plan) {
    Tracker tracker(graph, plan);
    for (PlannedPass& planned : plan.passes) {
        const Pass& pass = graph.passes()[planned.pass];
        for (const Access& a : accesses(pass))
            tracker.touch(a, touch_of(a, pass), planned.barriers);
    }
    order_end(graph, tracker, plan);
}

} // namespace catoptric::graph
