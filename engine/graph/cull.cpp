#include "graph/cull.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// Returns the layers and buffers whose contents are needed at the end of the frame.
SubresourceValues<char> live_at_end(const Graph& graph) {
    SubresourceValues<char> live = output_parts(graph);
    for (std::uint32_t i = 0; i < graph.images().size(); ++i)
        if (graph.image_lifetime(i) == Lifetime::persistent ||
            graph.image_lifetime(i) == Lifetime::imported)
            live.set(whole_image(graph, i), true);
    for (std::uint32_t b = 0; b < graph.buffers().size(); ++b)
        if (graph.is_imported({b})) live.set({.is_buffer = true, .id = b}, true);
    return live;
}

/// Returns a bit for each attachment of the pass that is not read before it is written again.
/// Images come first among the accesses, in order of declaration.
std::uint32_t unread_attachments(std::span<const ResourceAccess> accesses,
                                 const SubresourceValues<char>& live) {
    constexpr std::size_t kUnreadBitCount = 32;
    std::uint32_t bits = 0;
    for (std::size_t i = 0; i < std::min(accesses.size(), kUnreadBitCount); ++i) {
        const ResourceAccess& a = accesses[i];
        if (!a.is_buffer && a.write && is_attachment(a.use) && !live.has_any(a, true))
            bits |= 1u << i;
    }
    return bits;
}

/// Goes through the passes from the last to the first, and culls those whose results are not
/// needed. `live` begins as the contents that are needed at the end of the frame.
std::vector<CullDecision> cull_backwards(const GraphAccesses& all, std::size_t passes,
                                         SubresourceValues<char> live) {
    std::vector<CullDecision> fates(passes);
    for (std::size_t p = fates.size(); p-- > 0;) {
        fates[p].survives = std::ranges::any_of(all.of_pass(p), [&](const ResourceAccess& a) {
            return a.write && live.has_any(a, true);
        });
        if (!fates[p].survives) continue;
        fates[p].unread = unread_attachments(all.of_pass(p), live);
        for (const ResourceAccess& a : all.of_pass(p))
            if (a.write) live.set(a, false);
        for (const ResourceAccess& a : all.of_pass(p))
            if (a.needs && !a.previous) live.set(a, true);
    }
    return fates;
}

} // namespace

std::vector<CullDecision> cull_decisions(const Graph& graph, const GraphAccesses& all) {
    SubresourceValues<char> at_end = live_at_end(graph);
    while (true) {
        std::vector<CullDecision> fates = cull_backwards(all, graph.passes().size(), at_end);
        // If passes that are kept read contents of the last frame, these contents must also be
        // complete at the end of this frame.
        bool grew = false;
        for (std::size_t p = 0; p < fates.size(); ++p) {
            if (!fates[p].survives) continue;
            for (const ResourceAccess& a : all.of_pass(p)) {
                if (!a.previous || !at_end.has_any(a, false)) continue;
                at_end.set(a, true);
                grew = true;
            }
        }
        if (!grew) return fates;
    }
}

std::string cull_reason(const Graph& graph, std::span<const ResourceAccess> accesses) {
    std::string names;
    for (const ResourceAccess& a : accesses) {
        const std::string name = quoted_name(graph, a);
        if (!a.write || names.find(name) != std::string::npos) continue;
        names += (names.empty() ? "" : ", ") + name;
    }
    return "no output depends on what it writes: " + names;
}

} // namespace catoptric::graph
