#include "study/compare_checks.hpp"
#include "compare.hpp"
#include "core/error.hpp"
#include "core/text.hpp"
#include "measure/interval.hpp"
#include "reflect/plan.hpp"
#include "scene/pose.hpp"
#include "session/candidates.hpp"
#include "session/plan_file.hpp"
#include "study/picture_rows.hpp"
#include "study/plan_certificate.hpp"
#include "study/reference_cache.hpp"
#include "study/reference_file.hpp"
#include "study/study.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

namespace catoptric::study {

std::vector<std::string> default_techniques(const Request& base) {
    const scene::SceneAtTime at_time(base.scene, base.time);
    const scene::Scene& now = *at_time;
    std::vector<scene::FlatFaces> flats;
    for (const std::size_t object : scene::mirrors(now))
        flats.push_back(scene::find_flat_faces(now, now.objects[object]));
    const double tolerance = scene::flat_tolerance(base.camera, base.size);
    std::vector<std::string> rows;
    for (const reflect::Technique* technique : reflect::techniques())
        if (!technique->unfit || std::ranges::any_of(flats, [&](const auto& flat) {
                return technique->unfit(flat, tolerance, KnobSettings(technique->knobs)).empty();
            }))
            rows.insert(rows.end(), technique->compared.begin(), technique->compared.end());
    rows.emplace_back(reflect::kAutoPlanName);
    return rows;
}

void check_has_mirror(const scene::Scene& scene) {
    if (!scene::mirrors(scene).empty()) return;
    std::string lines;
    for (const std::string& option : suggest_mirror_options(scene)) lines += "\n  " + option;
    fail(Failure::bad_data, "scene ", quote(scene.name),
         ": wanted a mirror, whose reflections are what is compared, found none; make one with "
         "--mirror PATTERN[=REFLECTANCE]",
         lines.empty() ? "" : ", such as" + lines);
}

void check_round_limit(int rounds) {
    check(rounds >= static_cast<int>(measure::kMinIntervalSamples), Failure::usage,
          "rounds: wanted at least ", measure::kMinIntervalSamples,
          ", because fewer give no 95 % interval of the median, found ", rounds);
}

void check_techniques(const std::vector<std::string>& techniques) {
    std::vector<reflect::TechniquePlan> plans;
    for (const std::string& text : techniques) {
        reflect::TechniquePlan plan = read_plan(text);
        for (const reflect::TechniquePlan& other : plans)
            check(!plan.is_same(other), Failure::usage, "technique '", text,
                  "' is asked for twice");
        plans.push_back(std::move(plan));
    }
}

/// Throws `usage` if fewer frames are measured than draw each capture in its turn.
void check_turns(const reflect::TechniquePlan& plan, int frames) {
    std::uint32_t cycle = 1;
    for (const reflect::PlanRule& rule : plan.rules)
        cycle = std::max(cycle, rule.choice.shared.capture.every);
    check(frames >= static_cast<int>(cycle), Failure::usage, "technique '", plan.label,
          "' draws each capture once in ", cycle,
          " frames: wanted --frames of at least as many, found ", frames);
}

void check_compare_request(const CompareRequest& request) {
    scene::check_scene(request.base.scene);
    check_techniques(request.base.techniques);
    for (const std::string& text : request.base.techniques)
        if (const reflect::TechniquePlan plan = read_plan(text); !plan.is_auto) {
            reflect::assign_techniques(plan, mirror_names(request.base.scene));
            check_turns(plan, request.base.frames);
        }
    check_picture_rows(request);
    check_has_mirror(request.base.scene);
    check_round_limit(request.rounds);
    for (const StudyChoice& choice : request.studies) check_study(choice, request.reference);
    check(!request.both_models || !request.together, Failure::usage,
          "--model both and --together: rows of one frame have one model");
}

void check_inputs(const CompareRequest& request) {
    check_compare_request(request);
    read_certificates(request.base.techniques);
    if (!request.reference_file.empty()) {
        check_reference_has_file(request.reference, request.base.scene, request.reference_file);
        if (std::filesystem::exists(request.reference_file))
            read_reference_file(make_reference_key(request.base, request.reference),
                                request.reference_file);
    }
    report::Comparison unused;
    for (const StudyChoice& choice : request.studies)
        if (const Study& study = find_study(choice.name); study.prepare != nullptr)
            study.prepare(request, choice.count, unused);
}

} // namespace catoptric::study
