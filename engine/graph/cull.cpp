#include "graph/cull.hpp"

#include <algorithm>

namespace catoptric::graph {

namespace {

/// One sweep from the last pass to the first. `live` starts as what must be whole at the end.
std::vector<char> sweep(const Accesses& all, std::size_t passes, Ledger<char> live) {
    std::vector<char> survives(passes, false);
    for (std::size_t p = survives.size(); p-- > 0;) {
        survives[p] = std::ranges::any_of(
            all.of(p), [&](const Access& a) { return a.write && live.any(a, true); });
        if (!survives[p]) continue;
        for (const Access& a : all.of(p))
            if (a.write) live.set(a, false);
        for (const Access& a : all.of(p))
            if (a.needs && !a.previous) live.set(a, true);
    }
    return survives;
}

} // namespace

std::vector<char> survivors(const Graph& graph, const Accesses& all) {
    Ledger<char> live_at_end = wanted_parts(graph);
    while (true) {
        std::vector<char> survives = sweep(all, graph.passes().size(), live_at_end);
        // What survivors read of the last frame must be whole at the end of this one, too.
        bool grew = false;
        for (std::size_t p = 0; p < survives.size(); ++p) {
            if (!survives[p]) continue;
            for (const Access& a : all.of(p)) {
                if (!a.previous || !live_at_end.any(a, false)) continue;
                live_at_end.set(a, true);
                grew = true;
            }
        }
        if (!grew) return survives;
    }
}

std::string cull_reason(const Graph& graph, std::span<const Access> accesses) {
    std::string names;
    for (const Access& a : accesses) {
        const std::string name = quoted_name(graph, a);
        if (!a.write || names.find(name) != std::string::npos) continue;
        names += (names.empty() ? "" : ", ") + name;
    }
    return "nobody wants what it writes: " + names;
}

} // namespace catoptric::graph
