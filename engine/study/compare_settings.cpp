#include "study/compare_settings.hpp"

#include "session/scene_info.hpp"
#include "session/technique_choice.hpp"
#include "study/reference_cache.hpp"
#include "study/row_run.hpp"

#include <cmath>

namespace catoptric::study {

CompareRequest replace_auto_reference(CompareRequest request) {
    request.reference = choose_reference(request.reference, request.base.scene);
    return request;
}

void fill_settings(const CompareRequest& request, report::Comparison& comparison) {
    const Request& base = request.base;
    comparison.version = version();
    comparison.commit = commit();
    comparison.command = request.command;
    comparison.images = request.images;
    comparison.complete = false;
    comparison.scene = make_scene_facts(base);
    comparison.width = static_cast<int>(base.size.x);
    comparison.height = static_cast<int>(base.size.y);
    comparison.frames = base.frames;
    comparison.warmup = base.warmup;
    comparison.rounds = round_count(base.frames, request.rounds);
    comparison.time = base.time;
    comparison.ambient = base.ambient;
    comparison.exposure = base.auto_exposure ? NAN : base.exposure;
    comparison.timing = base.timing == PassTimingMode::isolated ? "isolated" : "pipelined";
    comparison.model = request.both_models ? "both" : work_name(base.model);
    comparison.together = request.together;
    const ParsedTechnique reference = parse_technique(request.reference);
    comparison.reference_technique = reference.technique;
    comparison.reference_label = reference.label;
    comparison.reference_settings = reference.settings;
}

} // namespace catoptric::study
