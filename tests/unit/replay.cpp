#include "replay.hpp"

#include "replay_contents.hpp"

#include <algorithm>
#include <tuple>

namespace catoptric::graph {

namespace {

/// A past access to a cell (an image layer or a buffer), with the later accesses that barriers have
/// ordered after it.
struct Event {
    Cell cell;
    ResourceTouch touch;
    bool is_write = false; // true for a write or a layout change
    bool is_layout = false;
    std::vector<std::pair<Cell, ResourceTouch>> ordered; // later accesses, by the barrier's cell

    /// Returns whether a barrier orders the access `t` to cell `by` after this access. A barrier on
    /// this access's own cell counts for every cell.
    bool is_before(const Cell& by, const ResourceTouch& t) const {
        return std::ranges::count(ordered, std::pair(by, t)) > 0 ||
               std::ranges::count(ordered, std::pair(cell, t)) > 0;
    }
    bool is_in(const Cell& by, const std::vector<ResourceTouch>& scope) const {
        return (!is_layout && std::ranges::count(scope, touch) > 0) ||
               std::ranges::any_of(scope, [&](const ResourceTouch& t) { return is_before(by, t); });
    }
};

class Replay {
public:
    Replay(const Graph& graph, const GraphPlan& plan, const MemorySizer& sizer)
        : graph_(graph), plan_(plan), sizer_(sizer) {
        const ResourceTouch raster{
            .nothing = false, .use = ResourceUse::sampled, .write = false, .raster = true};
        ResourceTouch compute = raster;
        compute.raster = false;
        for (std::uint32_t i = 0; i < graph.images().size(); ++i)
            for (std::uint32_t l = 0; l < graph.images()[i].layers; ++l) {
                const Cell cell{Kind::previous, i, l};
                layouts_[cell] = ResourceUse::sampled;
                events_[cell] = {{cell, {}, true, true, {{cell, raster}, {cell, compute}}}};
            }
    }

    std::vector<std::string> run() {
        check_passes();
        check_memory();
        for (const PlannedPass& planned : plan_.passes) {
            where_ = "'" + graph_.passes()[planned.pass].name + "'";
            pass_barriers(planned.barriers);
            execute(planned);
        }
        where_ = "the end";
        pass_barriers(plan_.last);
        check_end();
        return std::move(faults_);
    }

private:
    template <typename... Parts>
    void expect(bool ok, const Cell& cell, const Parts&... parts) {
        if (ok) return;
        const std::string name = cell.kind == Kind::buffer ? graph_.buffers()[cell.id].name
                                                           : graph_.images()[cell.id].name;
        faults_.push_back(where_ + ": " + name + " layer " + std::to_string(cell.layer) +
                          (cell.kind == Kind::previous ? " of last frame" : "") + ": " +
                          (std::string(parts) + ...));
    }

    const MemoryPlacement& placement(const Cell& cell) const {
        return cell.kind == Kind::buffer ? plan_.buffers[cell.id] : plan_.images[cell.id];
    }

    bool share_memory(const Cell& a, const Cell& b) const {
        if (a.kind == Kind::previous || b.kind == Kind::previous) return false;
        if (a.kind == b.kind && a.id == b.id) return false;
        const MemoryPlacement& x = placement(a);
        const MemoryPlacement& y = placement(b);
        return x.used && y.used && x.heap == y.heap && x.offset < y.offset + y.bytes &&
               y.offset < x.offset + x.bytes;
    }

    void check_passes() {
        std::vector<std::uint32_t> kept, all;
        int scene = 0;
        for (const PlannedPass& planned : plan_.passes) {
            kept.push_back(planned.pass);
            scene += graph_.passes()[planned.pass].tag == PassTag::scene ? 1 : 0;
        }
        if (!std::ranges::is_sorted(kept)) faults_.push_back("passes are reordered");
        if (scene != plan_.scene_passes) faults_.push_back("scene passes are miscounted");
        all = kept;
        for (const CulledPass& culled : plan_.culled) all.push_back(culled.pass);
        std::ranges::sort(all);
        for (std::uint32_t p = 0; p < graph_.passes().size(); ++p)
            if (p >= all.size() || all[p] != p) faults_.push_back("a pass is lost or doubled");
        const std::vector<Cell> cells = outcome_cells(graph_, plan_);
        const std::vector<Value> outcome = ideal_outcome(graph_, kept, cells);
        for (const std::uint32_t p : kept) {
            std::vector<std::uint32_t> fewer = kept;
            std::erase(fewer, p);
            if (ideal_outcome(graph_, fewer, cells) == outcome)
                faults_.push_back("nobody needs pass '" + graph_.passes()[p].name + "'");
        }
    }

    void check_memory() {
        std::map<Cell, std::pair<std::uint32_t, std::uint32_t>> lives;
        for (std::uint32_t at = 0; at < plan_.passes.size(); ++at)
            for (CellUse u : uses_of(graph_.passes()[plan_.passes[at].pass])) {
                u.cell.layer = 0;
                if (u.cell.kind == Kind::previous) u.cell.kind = Kind::image;
                lives.try_emplace(u.cell, at, at).first->second.second = at;
            }
        std::vector<std::uint64_t> ends(plan_.heap_bytes.size(), 0);
        for (const auto& [cell, life] : lives) {
            const MemoryPlacement& p = placement(cell);
            expect(p.used && std::pair(p.first, p.last) == life, cell, "wrong lifetime");
            check_size(cell);
            expect(p.heap < ends.size(), cell, "no such heap");
            ends.at(p.heap) = std::max(ends.at(p.heap), p.offset + p.bytes);
            for (const auto& [other, life2] : lives) {
                if (!(cell < other) || !share_memory(cell, other)) continue;
                expect(life.second < life2.first || life2.second < life.first, cell,
                       "shares memory while alive");
                expect(!must_be_alone(cell) && !must_be_alone(other), cell, "should be alone");
            }
        }
        std::uint64_t sum = 0;
        for (const std::uint64_t end : ends) sum += end;
        if (ends != plan_.heap_bytes || sum != plan_.bytes || sum > plan_.bytes_unshared)
            faults_.push_back("heap sizes are wrong");
    }

    bool must_be_alone(const Cell& cell) const {
        if (cell.kind == Kind::buffer)
            return std::ranges::count(graph_.output_buffers(), cell.id, &BufferHandle::id) > 0;
        return (graph_.lifetime(cell.id) == ImageLifetime::previous) ||
               std::ranges::count(graph_.output_images(), cell.id, &ImageHandle::id) > 0;
    }

    void check_size(const Cell& cell) {
        const MemoryPlacement& p = placement(cell);
        const bool is_buffer = cell.kind == Kind::buffer;
        const MemoryRequirements wanted = is_buffer ? sizer_.buffer(graph_.buffers()[cell.id])
                                                    : sizer_.image(graph_.images()[cell.id]);
        std::uint64_t bytes = wanted.bytes;
        if (!is_buffer && (graph_.lifetime(cell.id) == ImageLifetime::previous)) {
            const std::uint64_t padding = wanted.alignment - 1;
            bytes = 2 * ((bytes + padding) / wanted.alignment * wanted.alignment);
        }
        expect(p.bytes == bytes && p.heap == wanted.heap && p.offset % wanted.alignment == 0, cell,
               "wrong size, heap or alignment");
        expect(p.alone == must_be_alone(cell), cell, "wrong `alone`");
    }

    /// Applies all barriers of one pass at once, because barriers of the same command do not order
    /// each other.
    void pass_barriers(const std::vector<PlannedBarrier>& barriers) {
        std::vector<std::tuple<Event*, Cell, ResourceTouch>> ordered;
        std::map<Cell, ResourceTouch> transitions;
        for (const PlannedBarrier& b : barriers) {
            std::vector<ResourceTouch> scope = b.shared;
            if (!b.before.nothing) scope.push_back(b.before);
            const Kind kind = b.is_buffer  ? Kind::buffer
                              : b.previous ? Kind::previous
                                           : Kind::image;
            for (std::uint32_t l = 0; l < b.layer_count; ++l) {
                const Cell cell{kind, b.id, b.first_layer + l};
                const bool same = !b.before.nothing && b.before.use == b.after.use;
                const bool moves = !b.is_buffer && !same;
                if (!b.is_buffer && !b.before.nothing)
                    expect(layouts_.contains(cell) && layouts_[cell] == b.before.use, cell,
                           "barrier from a layout that it has not");
                if (b.before.nothing) contents_.set(cell, kGarbage);
                if (moves) transitions[cell] = b.after;
                for (auto& [other, events] : events_) {
                    if (other != cell && !share_memory(cell, other)) continue;
                    for (Event& e : events) {
                        if (e.is_in(cell, scope))
                            ordered.emplace_back(&e, cell, b.after);
                        else if (moves)
                            expect(false, cell, "change of layout races");
                    }
                }
            }
        }
        for (auto& [event, cell, after] : ordered) event->ordered.emplace_back(cell, after);
        for (const auto& [cell, after] : transitions) {
            layouts_[cell] = after.use;
            events_[cell] = {{cell, after, true, true, {{cell, after}}}};
        }
    }

    void execute(const PlannedPass& planned) {
        const std::uint32_t index = planned.pass;
        const Pass& pass = graph_.passes()[index];
        const std::vector<CellUse> uses = uses_of(pass);
        for (const CellUse& u : uses) check_touch(u, touch(pass, u));
        for (const CellUse& u : uses)
            for (const auto& [other, events] : events_)
                if (u.write && share_memory(u.cell, other)) contents_.lose(other.kind, other.id);
        contents_.execute(pass, index);
        for (std::size_t i = 0; i < pass.images.size(); ++i)
            if (planned.unread >> i & 1) lose(pass.images[i]);
        for (const CellUse& u : uses) {
            std::vector<Event>& events = events_[u.cell];
            if (u.write) events.clear();
            events.push_back({u.cell, touch(pass, u), u.write, false, {}});
        }
    }

    /// Marks the contents of an attachment that a pass does not store as lost.
    void lose(const ImageUse& use) {
        for (std::uint32_t l = 0; l < use.image.layer_count; ++l) {
            const Cell cell{Kind::image, use.image.id, use.image.first_layer + l};
            expect(use.write && (use.use == ResourceUse::colour || use.use == ResourceUse::depth),
                   cell, "not stored, but no attachment");
            contents_.set(cell, kGarbage);
        }
    }

    static ResourceTouch touch(const Pass& pass, const CellUse& u) {
        return {.nothing = false, .use = u.use, .write = u.write, .raster = pass.is_raster()};
    }

    void check_touch(const CellUse& u, const ResourceTouch& t) {
        if (u.cell.kind != Kind::buffer)
            expect(layouts_.contains(u.cell) && layouts_[u.cell] == u.use, u.cell,
                   "wrong layout for ", std::string(name_of(u.use)));
        for (const auto& [other, events] : events_) {
            if (other != u.cell && !share_memory(u.cell, other)) continue;
            for (const Event& e : events)
                if (u.write || e.is_write)
                    expect(e.is_before(u.cell, t), u.cell, std::string(name_of(u.use)),
                           " races with ", std::string(name_of(e.touch.use)), " of image ",
                           std::to_string(other.id));
        }
    }

    void check_end() {
        std::vector<std::uint32_t> all(graph_.passes().size());
        for (std::uint32_t p = 0; p < all.size(); ++p) all[p] = p;
        const std::vector<Cell> cells = outcome_cells(graph_, plan_);
        const std::vector<Value> ideal = ideal_outcome(graph_, all, cells);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const Cell& cell = cells[i];
            expect(contents_.at(cell) == ideal[i], cell, "wrong contents");
            if (cell.kind == Kind::image)
                check_left(cell);
            else
                expect_ordered(cell, ResourceUse::copy_from);
        }
        for (std::uint32_t i = 0; i < plan_.images.size(); ++i)
            for (std::uint32_t l = 0; l < graph_.images()[i].layers; ++l)
                if (plan_.images[i].used && (graph_.lifetime(i) == ImageLifetime::previous))
                    check_left({Kind::image, i, l});
    }

    void check_left(const Cell& cell) {
        const ResourceUse use = (graph_.lifetime(cell.id) == ImageLifetime::previous)
                                    ? ResourceUse::sampled
                                    : ResourceUse::copy_from;
        expect(layouts_.contains(cell) && layouts_[cell] == use, cell, "left in a wrong layout");
        expect_ordered(cell, use);
    }

    void expect_ordered(const Cell& cell, ResourceUse use) {
        for (const Event& e : events_[cell])
            expect(e.is_before(cell, {.nothing = false, .use = use}), cell,
                   "races with its reader");
    }

    const Graph& graph_;
    const GraphPlan& plan_;
    const MemorySizer& sizer_;
    std::string where_ = "memory";
    std::vector<std::string> faults_;
    Contents contents_;
    std::map<Cell, ResourceUse> layouts_;
    std::map<Cell, std::vector<Event>> events_;
};

} // namespace

std::vector<std::string> replay(const Graph& graph, const GraphPlan& plan,
                                const MemorySizer& sizer) {
    return Replay(graph, plan, sizer).run();
}

} // namespace catoptric::graph
