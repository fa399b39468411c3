#include "graph/cull.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// Returns the layers and buffers whose contents are needed at the end of the frame.
ValuesPerSubresource<char> mark_parts_live_at_frame_end(const Graph& graph) {
    ValuesPerSubresource<char> live = mark_output_image_parts(graph);
    for (std::uint32_t i = 0; i < graph.list_images().size(); ++i)
        if (graph.image_lifetime(i) == Lifetime::persistent ||
            graph.image_lifetime(i) == Lifetime::imported)
            live.set_subresource_values_of_access(make_access_to_whole_image(graph, i), true);
    for (std::uint32_t b = 0; b < graph.list_buffers().size(); ++b)
        if (graph.is_imported({b}))
            live.set_subresource_values_of_access({.is_buffer = true, .id = b}, true);
    return live;
}

/// Returns a bit for each attachment of the pass that is not read before it is written again.
/// Images come first among the accesses, in order of declaration.
std::uint32_t find_unread_attachments(std::span<const ResourceAccess> accesses,
                                      const ValuesPerSubresource<char>& live) {
    constexpr std::size_t kUnreadBitCount = 32;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < std::min(accesses.size(), kUnreadBitCount); ++i) {
        const ResourceAccess& a = accesses[i];
        if (!a.is_buffer && a.write && is_attachment(a.use) && !live.has_any_equal_value(a, true))
            bits |= 1u << i;
    }
    return bits;
}

/// Goes through the passes from the last to the first, and culls those whose results are not
/// needed. `live` begins as the contents that are needed at the end of the frame.
std::vector<PassCullingDecision> cull_passes_backwards(const GraphAccesses& all, std::size_t passes,
                                                       ValuesPerSubresource<char> live) {
    std::vector<PassCullingDecision> fates(passes);
    for (std::size_t p = fates.size(); p-- > 0;) {
        fates[p].survives = std::ranges::any_of(
            all.accesses_of_pass(p),
            [&](const ResourceAccess& a) { return a.write && live.has_any_equal_value(a, true); });
        if (!fates[p].survives) continue;
        fates[p].unread = find_unread_attachments(all.accesses_of_pass(p), live);
        for (const ResourceAccess& a : all.accesses_of_pass(p))
            if (a.write) live.set_subresource_values_of_access(a, false);
        for (const ResourceAccess& a : all.accesses_of_pass(p))
            if (a.needs && !a.previous) live.set_subresource_values_of_access(a, true);
    }
    return fates;
}

} // namespace

std::vector<PassCullingDecision> decide_which_passes_are_culled(const Graph& graph,
                                                                const GraphAccesses& all) {
    ValuesPerSubresource<char> at_end = mark_parts_live_at_frame_end(graph);
    while (true) {
        std::vector<PassCullingDecision> fates = cull_passes_backwards(
            all, graph.list_passes().size(), at_end);
        // If passes that are kept read contents of the last frame, these contents must also be
        // complete at the end of this frame.
        bool grew = false;
        for (std::size_t p = 0; p < fates.size(); ++p) {
            if (!fates[p].survives) continue;
            for (const ResourceAccess& a : all.accesses_of_pass(p)) {
                if (!a.previous || !at_end.has_any_equal_value(a, false)) continue;
                at_end.set_subresource_values_of_access(a, true);
                grew = true;
            }
        }
        if (!grew) return fates;
    }
}

std::string describe_cull_reason(const Graph& graph, std::span<const ResourceAccess> accesses) {
    std::string names;
    for (const ResourceAccess& a : accesses) {
        const std::string name = quote_resource_name(graph, a);
        if (!a.write || names.find(name) != std::string::npos) continue;
        names += (names.empty() ? "" : ", ") + name;
    }
    return "no output depends on what it writes: " + names;
}

} // namespace catoptric::graph
