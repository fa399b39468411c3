#include "reflect/frame.hpp"

#include "core/table.hpp"
#include "reflect/feature.hpp"

namespace catoptric::reflect {

RegisteredFeature::RegisteredFeature(const FrameFeature& feature) {
    table_rows<const FrameFeature*>().push_back(&feature);
}

std::vector<const FrameFeature*> features() {
    return sorted_rows<const FrameFeature*>(
        [](const FrameFeature* row) { return std::pair(row->order, row->name); });
}

const CaptureHistory& FrameDeclaration::continued_history() const {
    static const CaptureHistory kNothing{.model = kDrawEverythingModel};
    return probes ? kNothing : history;
}

TechniqueOutputs add_frame_passes(graph::Graph& graph, const render::FrameInputs& inputs,
                                  const Assignment& assignment, const CaptureHistory& history) {
    FrameDeclaration frame(graph, inputs, assignment, history);
    for (const FrameFeature* const feature : features())
        if (feature->applies(frame)) feature->add(frame);
    return std::move(frame.outputs);
}

} // namespace catoptric::reflect
