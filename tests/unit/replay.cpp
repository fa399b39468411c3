#include "replay.hpp"

#include "replay_contents.hpp"

#include <algorithm>
#include <tuple>

namespace catoptric::graph {

namespace {

/// An earlier access to a cell, which is an image layer or a buffer. Barriers order some later
/// accesses after it.
struct PastCellAccess {
    GraphSubresource cell;
    AccessState touch;
    bool is_write = false; // true for a write or a layout change
    bool is_layout = false;
    std::vector<std::pair<GraphSubresource, AccessState>>
        ordered; // later accesses, by the barrier's cell

    /// Returns whether a barrier orders the access `t` to cell `by` after this access. A barrier on
    /// this access's own cell counts for every cell.
    bool is_ordered_before(const GraphSubresource& by, const AccessState& t) const {
        return std::ranges::count(ordered, std::pair(by, t)) > 0 ||
               std::ranges::count(ordered, std::pair(cell, t)) > 0;
    }
    bool is_in_barrier_scope(const GraphSubresource& by,
                             const std::vector<AccessState>& scope) const {
        return (!is_layout && std::ranges::count(scope, touch) > 0) ||
               std::ranges::any_of(scope,
                                   [&](const AccessState& t) { return is_ordered_before(by, t); });
    }
};

class GraphPlanReplay {
public:
    GraphPlanReplay(const Graph& graph, const GraphPlan& plan,
                    const MemoryRequirementQueries& sizer)
        : replayed_graph_(graph), plan_(plan), sizer_(sizer) {
        const AccessState raster{
            .nothing = false, .use = ResourceUse::sampled, .write = false, .raster = true};
        AccessState compute = raster;
        compute.raster = false;
        for (std::uint32_t i = 0; i < graph.list_images().size(); ++i)
            for (std::uint32_t l = 0; l < graph.list_images()[i].layers; ++l) {
                const GraphSubresource cell{GraphSubresourceKind::previous, i, l};
                layouts_[cell] = ResourceUse::sampled;
                events_[cell] = {{cell, {}, true, true, {{cell, raster}, {cell, compute}}}};
            }
    }

    std::vector<std::string> run_replay() {
        check_order_of_passes();
        check_memory_placements();
        for (const PlannedPass& planned : plan_.passes) {
            where_ = "'" + replayed_graph_.list_passes()[planned.pass].name + "'";
            apply_barriers_of_pass(planned.barriers);
            execute_planned_pass(planned);
        }
        where_ = "the end";
        apply_barriers_of_pass(plan_.last);
        check_contents_at_frame_end();
        return std::move(faults_);
    }

private:
    template <typename... Parts>
    void record_fault_of_cell_unless(bool ok, const GraphSubresource& cell, const Parts&... parts) {
        if (ok) return;
        const std::string name = cell.kind == GraphSubresourceKind::buffer
                                     ? replayed_graph_.list_buffers()[cell.id].name
                                     : replayed_graph_.list_images()[cell.id].name;
        faults_.push_back(where_ + ": " + name + " layer " + std::to_string(cell.layer) +
                          (cell.kind == GraphSubresourceKind::previous ? " of last frame" : "") +
                          ": " + (std::string(parts) + ...));
    }

    const MemoryPlacement& placement_of_cell(const GraphSubresource& cell) const {
        return cell.kind == GraphSubresourceKind::buffer ? plan_.buffers[cell.id]
                                                         : plan_.images[cell.id];
    }

    bool do_cells_share_memory(const GraphSubresource& a, const GraphSubresource& b) const {
        if (a.kind == GraphSubresourceKind::previous || b.kind == GraphSubresourceKind::previous)
            return false;
        if (a.kind == b.kind && a.id == b.id) return false;
        const MemoryPlacement& x = placement_of_cell(a);
        const MemoryPlacement& y = placement_of_cell(b);
        return x.used && y.used && x.heap == y.heap && x.offset < y.offset + y.bytes &&
               y.offset < x.offset + x.bytes;
    }

    void check_order_of_passes() {
        std::vector<std::uint32_t> kept, all;
        int scene = 0;
        for (const PlannedPass& planned : plan_.passes) {
            kept.push_back(planned.pass);
            scene += replayed_graph_.list_passes()[planned.pass].tag == PassPurpose::scene ? 1 : 0;
        }
        if (!std::ranges::is_sorted(kept)) faults_.push_back("passes are reordered");
        if (scene != plan_.scene_passes) faults_.push_back("scene passes are miscounted");
        all = kept;
        for (const CulledPass& culled : plan_.culled) all.push_back(culled.pass);
        std::ranges::sort(all);
        for (std::uint32_t p = 0; p < replayed_graph_.list_passes().size(); ++p)
            if (p >= all.size() || all[p] != p) faults_.push_back("a pass is lost or doubled");
        const std::vector<GraphSubresource> cells = list_outcome_cells(replayed_graph_, plan_);
        const std::vector<Value> outcome = simulate_with_separate_memory(replayed_graph_, kept,
                                                                         cells);
        for (const std::uint32_t p : kept) {
            std::vector<std::uint32_t> fewer = kept;
            std::erase(fewer, p);
            if (simulate_with_separate_memory(replayed_graph_, fewer, cells) == outcome)
                faults_.push_back("nobody needs pass '" + replayed_graph_.list_passes()[p].name +
                                  "'");
        }
    }

    void check_memory_placements() {
        std::map<GraphSubresource, std::pair<std::uint32_t, std::uint32_t>> lives;
        for (std::uint32_t at = 0; at < plan_.passes.size(); ++at)
            for (GraphSubresourceUse u :
                 list_cell_uses_of_pass(replayed_graph_.list_passes()[plan_.passes[at].pass])) {
                u.cell.layer = 0;
                if (u.cell.kind == GraphSubresourceKind::previous)
                    u.cell.kind = GraphSubresourceKind::image;
                lives.try_emplace(u.cell, at, at).first->second.second = at;
            }
        std::vector<std::uint64_t> ends(plan_.heap_bytes.size(), 0);
        for (const auto& [cell, life] : lives) {
            const MemoryPlacement& p = placement_of_cell(cell);
            record_fault_of_cell_unless(p.used && std::pair(p.first, p.last) == life, cell,
                                        "wrong lifetime");
            check_placement_size(cell);
            record_fault_of_cell_unless(p.heap < ends.size(), cell, "no such heap");
            ends.at(p.heap) = std::max(ends.at(p.heap), p.offset + p.bytes);
            for (const auto& [other, life2] : lives) {
                if (!(cell < other) || !do_cells_share_memory(cell, other)) continue;
                record_fault_of_cell_unless(life.second < life2.first || life2.second < life.first,
                                            cell, "shares memory while alive");
                record_fault_of_cell_unless(!must_cell_have_own_memory(cell) &&
                                                !must_cell_have_own_memory(other),
                                            cell, "should be alone");
            }
        }
        std::uint64_t sum = 0;
        for (const std::uint64_t end : ends) sum += end;
        if (ends != plan_.heap_bytes || sum != plan_.bytes || sum > plan_.bytes_unshared)
            faults_.push_back("heap sizes are wrong");
    }

    bool must_cell_have_own_memory(const GraphSubresource& cell) const {
        if (cell.kind == GraphSubresourceKind::buffer)
            return std::ranges::count(replayed_graph_.list_output_buffers(), cell.id,
                                      &BufferHandle::id) > 0;
        return (replayed_graph_.image_lifetime(cell.id) == ImageLifetime::previous) ||
               std::ranges::count(replayed_graph_.list_output_images(), cell.id, &ImageHandle::id) >
                   0;
    }

    void check_placement_size(const GraphSubresource& cell) {
        const MemoryPlacement& p = placement_of_cell(cell);
        const bool is_buffer = cell.kind == GraphSubresourceKind::buffer;
        const MemoryRequirements wanted =
            is_buffer ? sizer_.buffer(replayed_graph_.list_buffers()[cell.id])
                      : sizer_.image(replayed_graph_.list_images()[cell.id]);
        std::uint64_t bytes = wanted.bytes;
        if (!is_buffer && (replayed_graph_.image_lifetime(cell.id) == ImageLifetime::previous)) {
            const std::uint64_t padding = wanted.alignment - 1;
            bytes = 2 * ((bytes + padding) / wanted.alignment * wanted.alignment);
        }
        record_fault_of_cell_unless(p.bytes == bytes && p.heap == wanted.heap &&
                                        p.offset % wanted.alignment == 0,
                                    cell, "wrong size, heap or alignment");
        record_fault_of_cell_unless(p.alone == must_cell_have_own_memory(cell), cell,
                                    "wrong `alone`");
    }

    /// Applies all barriers of one pass at once, because barriers of the same command do not order
    /// each other.
    void apply_barriers_of_pass(const std::vector<PlannedBarrier>& barriers) {
        std::vector<std::tuple<PastCellAccess*, GraphSubresource, AccessState>> ordered;
        std::map<GraphSubresource, AccessState> transitions;
        for (const PlannedBarrier& b : barriers) {
            std::vector<AccessState> scope = b.shared;
            if (!b.before.nothing) scope.push_back(b.before);
            const GraphSubresourceKind kind = b.is_buffer  ? GraphSubresourceKind::buffer
                                              : b.previous ? GraphSubresourceKind::previous
                                                           : GraphSubresourceKind::image;
            for (std::uint32_t l = 0; l < b.layer_count; ++l) {
                const GraphSubresource cell{kind, b.id, b.first_layer + l};
                const bool same = !b.before.nothing && b.before.use == b.after.use;
                const bool moves = !b.is_buffer && !same;
                if (!b.is_buffer && !b.before.nothing)
                    record_fault_of_cell_unless(layouts_.contains(cell) &&
                                                    layouts_[cell] == b.before.use,
                                                cell, "barrier from a layout that it has not");
                if (b.before.nothing) contents_.set_content_of_cell(cell, kGarbageContent);
                if (moves) transitions[cell] = b.after;
                for (auto& [other, events] : events_) {
                    if (other != cell && !do_cells_share_memory(cell, other)) continue;
                    for (PastCellAccess& e : events) {
                        if (e.is_in_barrier_scope(cell, scope))
                            ordered.emplace_back(&e, cell, b.after);
                        else if (moves)
                            record_fault_of_cell_unless(false, cell, "change of layout races");
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

    void execute_planned_pass(const PlannedPass& planned) {
        const std::uint32_t index = planned.pass;
        const Pass& pass = replayed_graph_.list_passes()[index];
        const std::vector<GraphSubresourceUse> uses = list_cell_uses_of_pass(pass);
        for (const GraphSubresourceUse& u : uses)
            check_access_state_of_use(u, make_access_state_of_use(pass, u));
        for (const GraphSubresourceUse& u : uses)
            for (const auto& [other, events] : events_)
                if (u.write && do_cells_share_memory(u.cell, other))
                    contents_.set_contents_to_garbage(other.kind, other.id);
        contents_.execute_pass(pass, index);
        for (std::size_t i = 0; i < pass.images.size(); ++i)
            if (planned.unread >> i & 1) mark_attachment_lost(pass.images[i]);
        for (const GraphSubresourceUse& u : uses) {
            std::vector<PastCellAccess>& events = events_[u.cell];
            if (u.write) events.clear();
            events.push_back({u.cell, make_access_state_of_use(pass, u), u.write, false, {}});
        }
    }

    /// Marks the contents of an attachment that a pass does not store as lost.
    void mark_attachment_lost(const ImageUse& use) {
        for (std::uint32_t l = 0; l < use.image.layer_count; ++l) {
            const GraphSubresource cell{GraphSubresourceKind::image, use.image.id,
                                        use.image.first_layer + l};
            record_fault_of_cell_unless(
                use.write && (use.use == ResourceUse::colour || use.use == ResourceUse::depth),
                cell, "not stored, but no attachment");
            contents_.set_content_of_cell(cell, kGarbageContent);
        }
    }

    static AccessState make_access_state_of_use(const Pass& pass, const GraphSubresourceUse& u) {
        return {.nothing = false, .use = u.use, .write = u.write, .raster = pass.is_raster_pass()};
    }

    void check_access_state_of_use(const GraphSubresourceUse& u, const AccessState& t) {
        if (u.cell.kind != GraphSubresourceKind::buffer)
            record_fault_of_cell_unless(layouts_.contains(u.cell) && layouts_[u.cell] == u.use,
                                        u.cell, "wrong layout for ",
                                        std::string(resource_use_name(u.use)));
        for (const auto& [other, events] : events_) {
            if (other != u.cell && !do_cells_share_memory(u.cell, other)) continue;
            for (const PastCellAccess& e : events)
                if (u.write || e.is_write)
                    record_fault_of_cell_unless(e.is_ordered_before(u.cell, t), u.cell,
                                                std::string(resource_use_name(u.use)),
                                                " races with ",
                                                std::string(resource_use_name(e.touch.use)),
                                                " of image ", std::to_string(other.id));
        }
    }

    void check_contents_at_frame_end() {
        std::vector<std::uint32_t> all(replayed_graph_.list_passes().size());
        for (std::uint32_t p = 0; p < all.size(); ++p) all[p] = p;
        const std::vector<GraphSubresource> cells = list_outcome_cells(replayed_graph_, plan_);
        const std::vector<Value> ideal = simulate_with_separate_memory(replayed_graph_, all, cells);
        for (std::size_t i = 0; i < cells.size(); ++i) {
            const GraphSubresource& cell = cells[i];
            record_fault_of_cell_unless(contents_.content_of_cell(cell) == ideal[i], cell,
                                        "wrong contents");
            if (cell.kind == GraphSubresourceKind::image)
                check_no_access_left_unordered(cell);
            else
                expect_ordered_access(cell, ResourceUse::copy_from);
        }
        for (std::uint32_t i = 0; i < plan_.images.size(); ++i)
            for (std::uint32_t l = 0; l < replayed_graph_.list_images()[i].layers; ++l)
                if (plan_.images[i].used &&
                    (replayed_graph_.image_lifetime(i) == ImageLifetime::previous))
                    check_no_access_left_unordered({GraphSubresourceKind::image, i, l});
    }

    void check_no_access_left_unordered(const GraphSubresource& cell) {
        const ResourceUse use = (replayed_graph_.image_lifetime(cell.id) == ImageLifetime::previous)
                                    ? ResourceUse::sampled
                                    : ResourceUse::copy_from;
        record_fault_of_cell_unless(layouts_.contains(cell) && layouts_[cell] == use, cell,
                                    "left in a wrong layout");
        expect_ordered_access(cell, use);
    }

    void expect_ordered_access(const GraphSubresource& cell, ResourceUse use) {
        for (const PastCellAccess& e : events_[cell])
            record_fault_of_cell_unless(e.is_ordered_before(cell, {.nothing = false, .use = use}),
                                        cell, "races with its reader");
    }

    const Graph& replayed_graph_;
    const GraphPlan& plan_;
    const MemoryRequirementQueries& sizer_;
    std::string where_ = "memory";
    std::vector<std::string> faults_;
    SimulatedGraphContents contents_;
    std::map<GraphSubresource, ResourceUse> layouts_;
    std::map<GraphSubresource, std::vector<PastCellAccess>> events_;
};

} // namespace

std::vector<std::string> replay_graph_plan(const Graph& graph, const GraphPlan& plan,
                                           const MemoryRequirementQueries& sizer) {
    return GraphPlanReplay(graph, plan, sizer).run_replay();
}

} // namespace catoptric::graph
