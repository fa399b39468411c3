#include "graph/cull.hpp"

namespace catoptric::graph {

namespace {

PerLayer<char> wanted_layers(const Graph& graph) {
    PerLayer<char> live(graph, false);
    for (const Image& image : graph.wanted_images())
        live.set(
            {.id = image.id, .first_layer = image.first_layer, .layer_count = image.layer_count},
            true);
    for (const Buffer& buffer : graph.wanted_buffers())
        live.set({.is_buffer = true, .id = buffer.id}, true);
    return live;
}

/// One sweep from the last pass to the first. `live` starts as what must be whole at the end.
std::vector<char> sweep(const Graph& graph, PerLayer<char> live) {
    std::vector<char> survives(graph.passes().size(), false);
    for (std::size_t p = survives.size(); p-- > 0;) {
        const std::vector<Access> all = accesses(graph.passes()[p]);
        survives[p] = std::ranges::any_of(all,
                                          [&](const Access& a) { return a.write && live.any(a); });
        if (!survives[p]) continue;
        for (const Access& a : all)
            if (a.write) live.set(a, false);
        for (const Access& a : all)
            if (a.needs && !a.previous) live.set(a, true);
    }
    return survives;
}

} // namespace

std::vector<char> survivors(const Graph& graph) {
    PerLayer<char> live_at_end = wanted_layers(graph);
    while (true) {
        std::vector<char> survives = sweep(graph, live_at_end);
        // What survivors read of the last frame must be whole at the end of this one, too.
        bool grew = false;
        for (std::size_t p = 0; p < survives.size(); ++p) {
            if (!survives[p]) continue;
            for (const Access& a : accesses(graph.passes()[p])) {
                if (!a.previous) continue;
                const std::vector<char> before = live_at_end.of(a);
                live_at_end.set(a, true);
                grew = grew || before != live_at_end.of(a);
            }
        }
        if (!grew) return survives;
    }
}

std::string cull_reason(const Graph& graph, const Pass& pass) {
    std::string names;
    for (const Access& a : accesses(pass)) {
        const std::string name = quoted_name(graph, a);
        if (!a.write || names.find(name) != std::string::npos) continue;
        names += (names.empty() ? "" : ", ") + name;
    }
    return "nobody wants what it writes: " + names;
}

} // namespace catoptric::graph
