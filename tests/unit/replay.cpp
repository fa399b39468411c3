#include "replay.hpp"

#include "replay_contents.hpp"

#include <algorithm>
#include <tuple>

namespace catoptric::graph {

namespace {

/// An earlier access to a subresource, which is an image layer or a buffer. Barriers order some
/// later accesses after it.
struct PastSubresourceAccess {
    GraphSubresource subresource;
    AccessState touch;
    bool is_write = false; // true for a write or a layout change
    bool is_layout = false;
    std::vector<std::pair<GraphSubresource, AccessState>>
        ordered; // later accesses, by the barrier's subresource

    /// Returns whether a barrier orders the access `t` to subresource `by` after this access. A
    /// barrier on this access's own subresource counts for every subresource.
    bool is_ordered_before(const GraphSubresource& by, const AccessState& t) const {
        return std::ranges::count(ordered, std::pair(by, t)) > 0 ||
               std::ranges::count(ordered, std::pair(subresource, t)) > 0;
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
    GraphPlanReplay(const Graph& graph, const GraphPlan& plan, const MemorySizer& sizer)
        : replayed_graph_(graph), plan_(plan), sizer_(sizer) {
        const AccessState raster{
            .nothing = false, .use = ResourceUse::sampled, .write = false, .raster = true};
        AccessState compute = raster;
        compute.raster = false;
        for (std::uint32_t i = 0; i < graph.images().size(); ++i)
            for (std::uint32_t l = 0; l < graph.images()[i].layers; ++l) {
                const GraphSubresource subresource{GraphSubresourceKind::previous, i, l};
                layouts_[subresource] = ResourceUse::sampled;
                events_[subresource] = {
                    {subresource, {}, true, true, {{subresource, raster}, {subresource, compute}}}};
            }
    }

    std::vector<std::string> run_replay() {
        check_order_of_passes();
        check_memory_placements();
        for (const PlannedPass& planned : plan_.passes) {
            where_ = "'" + replayed_graph_.passes()[planned.pass].name + "'";
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
    void record_fault_of_subresource_unless(bool ok, const GraphSubresource& subresource,
                                            const Parts&... parts) {
        if (ok) return;
        const std::string name = subresource.kind == GraphSubresourceKind::buffer
                                     ? replayed_graph_.buffers()[subresource.id].name
                                     : replayed_graph_.images()[subresource.id].name;
        faults_.push_back(
            where_ + ": " + name + " layer " + std::to_string(subresource.layer) +
            (subresource.kind == GraphSubresourceKind::previous ? " of last frame" : "") + ": " +
            (std::string(parts) + ...));
    }

    const MemoryPlacement& placement_of_subresource(const GraphSubresource& subresource) const {
        return subresource.kind == GraphSubresourceKind::buffer ? plan_.buffers[subresource.id]
                                                                : plan_.images[subresource.id];
    }

    bool do_subresources_share_memory(const GraphSubresource& a, const GraphSubresource& b) const {
        if (a.kind == GraphSubresourceKind::previous || b.kind == GraphSubresourceKind::previous)
            return false;
        if (a.kind == b.kind && a.id == b.id) return false;
        const MemoryPlacement& x = placement_of_subresource(a);
        const MemoryPlacement& y = placement_of_subresource(b);
        return x.used && y.used && x.heap == y.heap && x.offset < y.offset + y.bytes &&
               y.offset < x.offset + x.bytes;
    }

    void check_order_of_passes() {
        std::vector<std::uint32_t> kept, all;
        int scene = 0;
        for (const PlannedPass& planned : plan_.passes) {
            kept.push_back(planned.pass);
            scene += replayed_graph_.passes()[planned.pass].tag == PassPurpose::scene ? 1 : 0;
        }
        if (!std::ranges::is_sorted(kept)) faults_.push_back("passes are reordered");
        if (scene != plan_.scene_passes) faults_.push_back("scene passes are miscounted");
        all = kept;
        for (const CulledPass& culled : plan_.culled) all.push_back(culled.pass);
        std::ranges::sort(all);
        for (std::uint32_t p = 0; p < replayed_graph_.passes().size(); ++p)
            if (p >= all.size() || all[p] != p) faults_.push_back("a pass is lost or doubled");
        const std::vector<GraphSubresource> subresources = list_outcome_subresources(
            replayed_graph_, plan_);
        const std::vector<Value> outcome = simulate_with_separate_memory(replayed_graph_, kept,
                                                                         subresources);
        for (const std::uint32_t p : kept) {
            std::vector<std::uint32_t> fewer = kept;
            std::erase(fewer, p);
            if (simulate_with_separate_memory(replayed_graph_, fewer, subresources) == outcome)
                faults_.push_back("nobody needs pass '" + replayed_graph_.passes()[p].name + "'");
        }
    }

    void check_memory_placements() {
        std::map<GraphSubresource, std::pair<std::uint32_t, std::uint32_t>> lives;
        for (std::uint32_t at = 0; at < plan_.passes.size(); ++at)
            for (GraphSubresourceUse u :
                 list_subresource_uses_of_pass(replayed_graph_.passes()[plan_.passes[at].pass])) {
                u.subresource.layer = 0;
                if (u.subresource.kind == GraphSubresourceKind::previous)
                    u.subresource.kind = GraphSubresourceKind::image;
                lives.try_emplace(u.subresource, at, at).first->second.second = at;
            }
        std::vector<std::uint64_t> ends(plan_.heap_bytes.size(), 0);
        for (const auto& [subresource, life] : lives) {
            const MemoryPlacement& p = placement_of_subresource(subresource);
            record_fault_of_subresource_unless(p.used && std::pair(p.first, p.last) == life,
                                               subresource, "wrong lifetime");
            check_placement_size(subresource);
            record_fault_of_subresource_unless(p.heap < ends.size(), subresource, "no such heap");
            ends.at(p.heap) = std::max(ends.at(p.heap), p.offset + p.bytes);
            for (const auto& [other, life2] : lives) {
                if (!(subresource < other) || !do_subresources_share_memory(subresource, other))
                    continue;
                record_fault_of_subresource_unless(life.second < life2.first ||
                                                       life2.second < life.first,
                                                   subresource, "shares memory while alive");
                record_fault_of_subresource_unless(!must_subresource_have_own_memory(subresource) &&
                                                       !must_subresource_have_own_memory(other),
                                                   subresource, "should be alone");
            }
        }
        std::uint64_t sum = 0;
        for (const std::uint64_t end : ends) sum += end;
        if (ends != plan_.heap_bytes || sum != plan_.bytes || sum > plan_.bytes_unshared)
            faults_.push_back("heap sizes are wrong");
    }

    bool must_subresource_have_own_memory(const GraphSubresource& subresource) const {
        if (subresource.kind == GraphSubresourceKind::buffer)
            return std::ranges::count(replayed_graph_.output_buffers(), subresource.id,
                                      &BufferHandle::id) > 0;
        return (replayed_graph_.image_lifetime(subresource.id) == Lifetime::previous) ||
               std::ranges::count(replayed_graph_.output_images(), subresource.id,
                                  &ImageHandle::id) > 0;
    }

    void check_placement_size(const GraphSubresource& subresource) {
        const MemoryPlacement& p = placement_of_subresource(subresource);
        const bool is_buffer = subresource.kind == GraphSubresourceKind::buffer;
        const MemoryRequirements wanted =
            is_buffer ? sizer_.buffer(replayed_graph_.buffers()[subresource.id])
                      : sizer_.image(replayed_graph_.images()[subresource.id]);
        std::uint64_t bytes = wanted.bytes;
        if (!is_buffer && (replayed_graph_.image_lifetime(subresource.id) == Lifetime::previous)) {
            const std::uint64_t padding = wanted.alignment - 1;
            bytes = 2 * ((bytes + padding) / wanted.alignment * wanted.alignment);
        }
        record_fault_of_subresource_unless(p.bytes == bytes && p.heap == wanted.heap &&
                                               p.offset % wanted.alignment == 0,
                                           subresource, "wrong size, heap or alignment");
        record_fault_of_subresource_unless(p.alone == must_subresource_have_own_memory(subresource),
                                           subresource, "wrong `alone`");
    }

    /// Applies all barriers of one pass at once, because barriers of the same command do not order
    /// each other.
    void apply_barriers_of_pass(const std::vector<PlannedBarrier>& barriers) {
        std::vector<std::tuple<PastSubresourceAccess*, GraphSubresource, AccessState>> ordered;
        std::map<GraphSubresource, AccessState> transitions;
        for (const PlannedBarrier& b : barriers) {
            std::vector<AccessState> scope = b.shared;
            if (!b.before.nothing) scope.push_back(b.before);
            const GraphSubresourceKind kind = b.is_buffer  ? GraphSubresourceKind::buffer
                                              : b.previous ? GraphSubresourceKind::previous
                                                           : GraphSubresourceKind::image;
            for (std::uint32_t l = 0; l < b.layer_count; ++l) {
                const GraphSubresource subresource{kind, b.id, b.first_layer + l};
                const bool same = !b.before.nothing && b.before.use == b.after.use;
                const bool moves = !b.is_buffer && !same;
                if (!b.is_buffer && !b.before.nothing)
                    record_fault_of_subresource_unless(
                        layouts_.contains(subresource) && layouts_[subresource] == b.before.use,
                        subresource, "barrier from a layout that it has not");
                if (b.before.nothing)
                    contents_.set_content_of_subresource(subresource, kGarbageContent);
                if (moves) transitions[subresource] = b.after;
                for (auto& [other, events] : events_) {
                    if (other != subresource && !do_subresources_share_memory(subresource, other))
                        continue;
                    for (PastSubresourceAccess& e : events) {
                        if (e.is_in_barrier_scope(subresource, scope))
                            ordered.emplace_back(&e, subresource, b.after);
                        else if (moves)
                            record_fault_of_subresource_unless(false, subresource,
                                                               "change of layout races");
                    }
                }
            }
        }
        for (auto& [event, subresource, after] : ordered)
            event->ordered.emplace_back(subresource, after);
        for (const auto& [subresource, after] : transitions) {
            layouts_[subresource] = after.use;
            events_[subresource] = {{subresource, after, true, true, {{subresource, after}}}};
        }
    }

    void execute_planned_pass(const PlannedPass& planned) {
        const std::uint32_t index = planned.pass;
        const Pass& pass = replayed_graph_.passes()[index];
        const std::vector<GraphSubresourceUse> uses = list_subresource_uses_of_pass(pass);
        for (const GraphSubresourceUse& u : uses)
            check_access_state_of_use(u, make_access_state_of_use(pass, u));
        for (const GraphSubresourceUse& u : uses)
            for (const auto& [other, events] : events_)
                if (u.write && do_subresources_share_memory(u.subresource, other))
                    contents_.set_contents_to_garbage(other.kind, other.id);
        contents_.execute_pass(pass, index);
        for (std::size_t i = 0; i < pass.images.size(); ++i)
            if (planned.unread >> i & 1) mark_attachment_lost(pass.images[i]);
        for (const GraphSubresourceUse& u : uses) {
            std::vector<PastSubresourceAccess>& events = events_[u.subresource];
            if (u.write) events.clear();
            events.push_back(
                {u.subresource, make_access_state_of_use(pass, u), u.write, false, {}});
        }
    }

    /// Marks the contents of an attachment that a pass does not store as lost.
    void mark_attachment_lost(const ImageUse& use) {
        for (std::uint32_t l = 0; l < use.image.layer_count; ++l) {
            const GraphSubresource subresource{GraphSubresourceKind::image, use.image.id,
                                               use.image.first_layer + l};
            record_fault_of_subresource_unless(
                use.write && (use.use == ResourceUse::colour || use.use == ResourceUse::depth),
                subresource, "not stored, but no attachment");
            contents_.set_content_of_subresource(subresource, kGarbageContent);
        }
    }

    static AccessState make_access_state_of_use(const Pass& pass, const GraphSubresourceUse& u) {
        return {.nothing = false, .use = u.use, .write = u.write, .raster = pass.is_raster()};
    }

    void check_access_state_of_use(const GraphSubresourceUse& u, const AccessState& t) {
        if (u.subresource.kind != GraphSubresourceKind::buffer)
            record_fault_of_subresource_unless(
                layouts_.contains(u.subresource) && layouts_[u.subresource] == u.use, u.subresource,
                "wrong layout for ", std::string(use_name(u.use)));
        for (const auto& [other, events] : events_) {
            if (other != u.subresource && !do_subresources_share_memory(u.subresource, other))
                continue;
            for (const PastSubresourceAccess& e : events)
                if (u.write || e.is_write)
                    record_fault_of_subresource_unless(
                        e.is_ordered_before(u.subresource, t), u.subresource,
                        std::string(use_name(u.use)), " races with ",
                        std::string(use_name(e.touch.use)), " of image ", std::to_string(other.id));
        }
    }

    void check_contents_at_frame_end() {
        std::vector<std::uint32_t> all(replayed_graph_.passes().size());
        for (std::uint32_t p = 0; p < all.size(); ++p) all[p] = p;
        const std::vector<GraphSubresource> subresources = list_outcome_subresources(
            replayed_graph_, plan_);
        const std::vector<Value> ideal = simulate_with_separate_memory(replayed_graph_, all,
                                                                       subresources);
        for (std::size_t i = 0; i < subresources.size(); ++i) {
            const GraphSubresource& subresource = subresources[i];
            record_fault_of_subresource_unless(contents_.content_of_subresource(subresource) ==
                                                   ideal[i],
                                               subresource, "wrong contents");
            if (subresource.kind == GraphSubresourceKind::image)
                check_no_access_left_unordered(subresource);
            else
                expect_ordered_access(subresource, ResourceUse::copy_from);
        }
        for (std::uint32_t i = 0; i < plan_.images.size(); ++i)
            for (std::uint32_t l = 0; l < replayed_graph_.images()[i].layers; ++l)
                if (plan_.images[i].used &&
                    (replayed_graph_.image_lifetime(i) == Lifetime::previous))
                    check_no_access_left_unordered({GraphSubresourceKind::image, i, l});
    }

    void check_no_access_left_unordered(const GraphSubresource& subresource) {
        const ResourceUse use = (replayed_graph_.image_lifetime(subresource.id) ==
                                 Lifetime::previous)
                                    ? ResourceUse::sampled
                                    : ResourceUse::copy_from;
        record_fault_of_subresource_unless(layouts_.contains(subresource) &&
                                               layouts_[subresource] == use,
                                           subresource, "left in a wrong layout");
        expect_ordered_access(subresource, use);
    }

    void expect_ordered_access(const GraphSubresource& subresource, ResourceUse use) {
        for (const PastSubresourceAccess& e : events_[subresource])
            record_fault_of_subresource_unless(
                e.is_ordered_before(subresource, {.nothing = false, .use = use}), subresource,
                "races with its reader");
    }

    const Graph& replayed_graph_;
    const GraphPlan& plan_;
    const MemorySizer& sizer_;
    std::string where_ = "memory";
    std::vector<std::string> faults_;
    SimulatedGraphContents contents_;
    std::map<GraphSubresource, ResourceUse> layouts_;
    std::map<GraphSubresource, std::vector<PastSubresourceAccess>> events_;
};

} // namespace

std::vector<std::string> replay_graph_plan(const Graph& graph, const GraphPlan& plan,
                                           const MemorySizer& sizer) {
    return GraphPlanReplay(graph, plan, sizer).run_replay();
}

} // namespace catoptric::graph
