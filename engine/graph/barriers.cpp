#include "graph/barriers.hpp"

#include "graph/memory_users.hpp"

#include <bit>

namespace catoptric::graph {

namespace {

/// What happened so far in this frame to one layer of an image or to a buffer.
struct State {
    TouchCode write = kNothing; // the last one; `nothing`: none in this frame
    Touches readers;            // since that write or the last change of layout; distinct

    /// What the next write must wait for. For an image all are in the layout it has now.
    Touches latest() const {
        if (!readers.empty()) return readers;
        return write == kNothing ? Touches() : Touches(write);
    }
    friend bool operator==(const State&, const State&) = default;
};

/// What a read must wait for; empty when an earlier reader waited in its stead.
Touches awaited_by_read(const State& state, TouchCode touch, bool is_buffer) {
    if (state.readers.contains(touch)) return {};
    if (state.readers.empty() || is_buffer) return Touches(state.write);
    // Same layout, another stage: `before` must tell the present layout, so chain to a reader,
    // which waited for the write, rather than to the write.
    if (use_of(state.readers.front()) == use_of(touch)) return Touches(state.readers.front());
    return state.readers; // a change of layout is a write
}

void advance(State& state, TouchCode touch, bool is_buffer) {
    if (touch_of(touch).write) {
        state = {.write = touch, .readers = {}};
        return;
    }
    const bool moved = !state.readers.empty() && use_of(state.readers.front()) != use_of(touch);
    if (moved && !is_buffer) state.readers.clear();
    state.readers.add(touch);
}

std::vector<Touch> listed(TouchSet set) {
    std::vector<Touch> touches;
    for (; set; set &= set - 1)
        touches.push_back(touch_of(static_cast<TouchCode>(std::countr_zero(set))));
    return touches;
}

/// Adds a barrier, as part of the last one when it only continues its layers.
void append(std::vector<Barrier>& barriers, Barrier&& barrier) {
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
    barriers.push_back(std::move(barrier));
}

/// Owns the states of everything while the frame is walked from top to bottom.
class Tracker {
public:
    Tracker(const Graph& graph, const Plan& plan)
        : plan_(plan), states_(graph), previous_(graph, arrived()), users_(plan) {}

    void touch(const Access& access, const Touch& touch, std::vector<Barrier>& barriers) {
        const TouchCode code = code_of(touch);
        const auto visit = [&](std::uint32_t first, std::uint32_t end, State& state) {
            if (state.latest().empty())
                emit(access, first, end, {}, touch, listed(users_.left_in(placement(access))),
                     barriers);
            else
                wait(access, first, end,
                     touch.write ? state.latest() : awaited_by_read(state, code, access.is_buffer),
                     touch, barriers);
            advance(state, code, access.is_buffer);
        };
        (access.previous ? previous_ : states_).change(access, visit);
    }

    /// After the last pass that touches the resource of the access.
    void finish(const Access& access) {
        if (placement(access).alone) return; // nobody follows in its memory
        TouchSet touches = 0;
        states_.of(access).each([&](std::uint32_t, std::uint32_t, const State& state) {
            const Touches latest = state.latest();
            for (std::size_t i = 0; i < latest.size(); ++i) touches |= set_of(latest[i]);
        });
        users_.leave(placement(access), touches);
    }

    /// A barrier for each layer, needed or not: whoever comes after the frame relies on it.
    void leave(const Access& access, const Touch& touch, std::vector<Barrier>& barriers) {
        states_.each(access, [&](std::uint32_t first, std::uint32_t end, const State& state) {
            Touches latest = state.latest();
            if (latest.empty()) latest.add(kNothing); // never touched: from nothing
            wait(access, first, end, latest, touch, barriers);
        });
    }

    const Placement& placement(const Access& access) const {
        return access.is_buffer ? plan_.buffers[access.id] : plan_.images[access.id];
    }

private:
    /// Last frame's contents: the end of that frame made them ready for every stage.
    static State arrived() {
        const Touch compute{.nothing = false, .use = Use::sampled, .write = false, .raster = false};
        Touch raster = compute;
        raster.raster = true;
        State state{.write = kNothing, .readers = Touches(code_of(compute))};
        state.readers.add(code_of(raster));
        return state;
    }

    static void wait(const Access& access, std::uint32_t first, std::uint32_t end,
                     const Touches& awaited, const Touch& touch, std::vector<Barrier>& barriers) {
        if (awaited.empty()) return;
        std::vector<Touch> others;
        for (std::size_t i = 1; i < awaited.size(); ++i) others.push_back(touch_of(awaited[i]));
        emit(access, first, end, touch_of(awaited.front()), touch, std::move(others), barriers);
    }

    static void emit(const Access& access, std::uint32_t first, std::uint32_t end,
                     const Touch& before, const Touch& after, std::vector<Touch> shared,
                     std::vector<Barrier>& barriers) {
        // A buffer has no layout: without anything to wait for there is nothing to do.
        if (access.is_buffer && before.nothing && shared.empty()) return;
        append(barriers, {.is_buffer = access.is_buffer,
                          .id = access.id,
                          .previous = access.previous,
                          .first_layer = first,
                          .layer_count = end - first,
                          .before = before,
                          .after = after,
                          .shared = std::move(shared)});
    }

    const Plan& plan_;
    Ledger<State> states_, previous_;
    MemoryUsers users_;
};

void order_end(const Graph& graph, Tracker& tracker, Plan& plan) {
    const Ledger<char> wanted = wanted_parts(graph);
    Touch touch{.nothing = false, .use = Use::copy_from};
    const auto leave = [&](const Access& whole, bool all) {
        wanted.of(whole).each([&](std::uint32_t first, std::uint32_t end, bool is_wanted) {
            Access part = whole;
            part.first_layer = first, part.layer_count = end - first;
            if (all || is_wanted) tracker.leave(part, touch, plan.last);
        });
    };
    for (std::uint32_t i = 0; i < plan.images.size(); ++i) {
        const bool kept = plan.images[i].used && graph.is_kept(i);
        touch.use = kept ? Use::sampled : Use::copy_from;
        leave({.id = i}, kept);
    }
    touch.use = Use::copy_from;
    for (std::uint32_t b = 0; b < plan.buffers.size(); ++b)
        leave({.is_buffer = true, .id = b}, false);
}

} // namespace

void order(const Graph& graph, const Accesses& all, Plan& plan) {
    Tracker tracker(graph, plan);
    for (std::uint32_t position = 0; position < plan.passes.size(); ++position) {
        PlannedPass& planned = plan.passes[position];
        const Pass& pass = graph.passes()[planned.pass];
        const std::span<const Access> uses = all.of(planned.pass);
        planned.barriers.reserve(uses.size());
        for (const Access& a : uses) tracker.touch(a, touch_of(a, pass), planned.barriers);
        for (const Access& a : uses)
            if (tracker.placement(a).last == position) tracker.finish(a);
    }
    order_end(graph, tracker, plan);
}

} // namespace catoptric::graph
