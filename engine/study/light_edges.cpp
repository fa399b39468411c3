#include "study/light_edges.hpp"

#include "measure/light_edges.hpp"
#include "measure/masks.hpp"
#include "report/comparison.hpp"

#include <algorithm>

namespace catoptric::study {

namespace {

/// Returns the texels along an edge of each mirror's capture; 0: the mirror has no capture.
std::vector<std::uint32_t> capture_edges(const report::Row& row) {
    std::vector<std::uint32_t> faces;
    for (const PlanEntry& entry : row.plan) {
        const auto face = std::ranges::find(entry.settings, "face", &Setting::name);
        const bool has_captures = face != entry.settings.end();
        // face=auto gives all captures the same edge.
        const double edge = has_captures
                                ? face->number.value_or(row.auto_face ? row.auto_face->edge : 0)
                                : 0;
        faces.push_back(static_cast<std::uint32_t>(edge));
    }
    return faces;
}

} // namespace

measure::LightEdgeErrors split_at_light_edges(const report::Row& row,
                                              const ComparedReference& truth,
                                              const std::vector<std::uint32_t>& hits,
                                              const std::vector<vec4>& lookup,
                                              const TrueHitFinder& finder, double exposure) {
    measure::Mask there = finder.find_light_edges(lookup, capture_edges(row));
    measure::Mask elsewhere = measure::mask_mirrors(hits);
    for (std::size_t i = 0; i < there.size(); ++i) {
        there[i] = there[i] & elsewhere[i];
        elsewhere[i] = elsewhere[i] & static_cast<std::uint8_t>(~there[i]);
    }
    const auto over = [&](const measure::Mask& mask) {
        return masked_error(row.hdr, truth, mask, row.flip_map, exposure);
    };
    return measure::split_by_light_edges(over(there), over(elsewhere));
}

} // namespace catoptric::study
