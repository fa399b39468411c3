#include "require/suggest.hpp"

#include "scene/flat_mirror.hpp"
#include "scene/material_facts.hpp"
#include "scene/mirror_shape.hpp"
#include "scene/rough_reflectors.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <utility>

namespace catoptric::require {

namespace {

constexpr PictureCostTable kPictureCostTable;
constexpr TechniqueErrorTable kTechniqueErrorTable;
constexpr double kMaxEqualErrorFactor = 1.1; // errors within this factor count as equal
/// If some mirror is traced, each mirror with hidden reflected points and at least this share of
/// all mirror pixels is traced as well.
constexpr double kLargeMirrorShare = .1;
constexpr int kMinPlanarBounces = 2;        // smallest `bounces` of `planar`
constexpr int kMaxSuggestedBounces = 6;     // largest `bounces` that is suggested
constexpr double kMaxBlackPixelShare = .01; // share of mirror pixels that may need more bounces

/// Facts about a picture's mirrors that the choice depends on.
struct MirrorCostInputs {
    MirrorPathCounts paths;
    std::vector<bool> is_flat, is_seen, is_glass; ///< one entry per mirror
    double triangles = 0;                         ///< number of triangles in the scene
    double pixels = 0;                            ///< number of pixels in the picture
    double on_mirrors = 0;                        ///< paths whose first hit is a mirror; at least 1
    int bounces = kMinPlanarBounces;              ///< knob `bounces` of `planar`

    std::size_t mirror_count() const { return is_flat.size(); }
    /// Returns how many pixels of the picture this number of paths stands for.
    double estimate_pixels_of_mirror_paths(std::size_t paths_through) const {
        return pixels * static_cast<double>(paths_through) / static_cast<double>(paths.count);
    }
};

bool is_mirror_flat(const RequiredWorkModelInput& question, const scene::Object& object) {
    const scene::FlatFaces flats = scene::find_flat_faces(question.now, object);
    // The errors of the candidates are those of sharp mirrors. A blurred view has a larger error.
    return !flats.is_rough &&
           flats.flat_area_share(scene::compute_flat_tolerance(question.camera, question.size)) >=
               1 - kMaxCurvedAreaShare;
}

/// Returns how many mirrors for which `of` is true the path meets before any other mirror.
std::size_t count_leading_mirrors(const std::vector<std::uint32_t>& path,
                                  const std::vector<bool>& of) {
    return static_cast<std::size_t>(
        std::ranges::find_if(path, [&](std::uint32_t mirror) { return !of[mirror]; }) -
        path.begin());
}

/// Returns how many flat mirrors one behind the other the picture shows, ignoring few pixels.
int count_bounces_between_flat_mirrors(const MirrorCostInputs& known) {
    for (int bounces = kMinPlanarBounces; bounces < kMaxSuggestedBounces; ++bounces) {
        double more = 0;
        for (const auto& [path, count] : known.paths.through)
            if (path.size() == static_cast<std::size_t>(bounces) + 1 &&
                count_leading_mirrors(path, known.is_flat) == path.size())
                more += static_cast<double>(count);
        if (more <= kMaxBlackPixelShare * known.on_mirrors) return bounces;
    }
    return kMaxSuggestedBounces;
}

MirrorCostInputs gather_mirror_cost_inputs(const RequiredWorkModelInput& question) {
    MirrorCostInputs known{.paths = trace_mirror_paths(question)};
    for (const std::size_t object : scene::mirrors(question.now)) {
        known.is_flat.push_back(is_mirror_flat(question, question.now.objects[object]));
        known.is_glass.push_back(
            scene::is_glass(question.now.materials[question.now.objects[object].material]));
    }
    known.triangles = static_cast<double>(scene::triangle_count(question.now));
    known.pixels = 1.0 * question.size.x * question.size.y;
    known.on_mirrors = static_cast<double>(
        std::max<std::size_t>(1, known.paths.count_paths_on_mirrors()));
    for (const std::size_t reached : known.paths.reached)
        known.is_seen.push_back(static_cast<double>(reached) >
                                kHardlySeenPixelShare * known.on_mirrors);
    // Without any visible mirror, treat all as visible.
    if (std::ranges::none_of(known.is_seen, std::identity()))
        known.is_seen.assign(known.mirror_count(), true);
    known.bounces = count_bounces_between_flat_mirrors(known);
    return known;
}

double estimate_pass_cost(const MirrorCostInputs& known, double pixels) {
    return kPictureCostTable.pass + kPictureCostTable.triangle * known.triangles +
           kPictureCostTable.pixel * pixels;
}

constexpr const char* kTracedGlassTechnique = "raytrace";

/// The ways to draw a mirror.
enum class MirrorDrawMethod { planes, hybrid, march, small };

/// Returns whether tracing what its capture does not show reduces the mirror's estimated error by
/// more than a tenth.
bool should_trace_mirror(const MirrorCostInputs& known, std::size_t mirror) {
    if (known.is_glass[mirror]) return true; // captures only approximate what passes the body
    const auto first = static_cast<double>(known.paths.first[mirror]),
               hidden = static_cast<double>(known.paths.hidden[mirror]);
    return hidden * (kTechniqueErrorTable.unknown - kTechniqueErrorTable.search) >
           (kMaxEqualErrorFactor - 1) * kTechniqueErrorTable.search * first;
}

/// Adds cost and error of a mirror that is seen in flat mirrors with mirrored views. `path` lists
/// the mirrors that `count` rays meet; this mirror is the last. A mirrored view looks into the
/// mirror's capture but traces nothing, so it can only guess what the capture does not show.
void add_cost_in_flat_mirrors(PlanCandidate& candidate, const MirrorCostInputs& known,
                              const std::vector<std::uint32_t>& path, std::size_t count,
                              MirrorDrawMethod way) {
    const bool is_searched = way != MirrorDrawMethod::small;
    if (is_searched)
        candidate.cost += kPictureCostTable.searched * known.estimate_pixels_of_mirror_paths(count);
    const double error = is_searched ? kTechniqueErrorTable.search : kTechniqueErrorTable.reuse;
    candidate.error += static_cast<double>(count) * (error - kTechniqueErrorTable.planar);
    const auto found = known.paths.hidden_after.find(path);
    if (is_searched && found != known.paths.hidden_after.end())
        candidate.error += static_cast<double>(found->second) *
                           (kTechniqueErrorTable.unknown - error);
}

/// Adds cost and error of the candidate's techniques. `face` is the edge in texels of the captures
/// of mirrors drawn by `planar`; 0: no captures.
void compute_cost_and_error(PlanCandidate& candidate, const MirrorCostInputs& known,
                            const std::vector<MirrorDrawMethod>& ways, std::uint32_t face) {
    std::vector<bool> by_planes;
    for (const MirrorDrawMethod way : ways) by_planes.push_back(way == MirrorDrawMethod::planes);
    candidate.cost = estimate_pass_cost(known, known.pixels);
    for (std::size_t i = 0; i < known.mirror_count() && face > 0; ++i) {
        const double edge = by_planes[i]                         ? face
                            : ways[i] == MirrorDrawMethod::small ? kSmallCaptureFaceEdge
                                                                 : kUsualFaceEdge,
                     pixels = 6 * edge * edge;
        candidate.cost += estimate_pass_cost(known, pixels);
        if (ways[i] == MirrorDrawMethod::hybrid)
            candidate.cost += kPictureCostTable.bounds * pixels;
    }
    for (std::size_t i = 0; i < known.mirror_count(); ++i) {
        const auto first = static_cast<double>(known.paths.first[i]);
        const bool is_searched = ways[i] == MirrorDrawMethod::hybrid ||
                                 ways[i] == MirrorDrawMethod::march;
        if (is_searched)
            candidate.cost += kPictureCostTable.searched *
                              known.estimate_pixels_of_mirror_paths(known.paths.first[i]);
        if (ways[i] == MirrorDrawMethod::hybrid)
            candidate.cost += kPictureCostTable.traced *
                              known.estimate_pixels_of_mirror_paths(
                                  known.is_glass[i] ? known.paths.first[i] : known.paths.hidden[i]);
        if (ways[i] == MirrorDrawMethod::march)
            candidate.error += static_cast<double>(known.paths.hidden[i]) *
                               (kTechniqueErrorTable.unknown - kTechniqueErrorTable.search);
        candidate.error += first * (by_planes[i]  ? kTechniqueErrorTable.planar
                                    : is_searched ? kTechniqueErrorTable.search
                                                  : kTechniqueErrorTable.reuse);
    }
    for (const auto& [path, count] : known.paths.through) {
        const auto bounces = static_cast<std::size_t>(known.bounces);
        const std::size_t planes = count_leading_mirrors(path, by_planes);
        if (planes > 0 && planes + 1 == path.size() && planes <= bounces)
            add_cost_in_flat_mirrors(candidate, known, path, count, ways[path.back()]);
        if (planes != path.size()) continue;
        if (path.size() <= bounces)
            candidate.cost += estimate_pass_cost(known,
                                                 known.estimate_pixels_of_mirror_paths(count));
        if (path.size() == bounces + 1)
            candidate.error += static_cast<double>(count) *
                               (kTechniqueErrorTable.black - kTechniqueErrorTable.planar);
    }
    candidate.error /= known.on_mirrors;
}

/// Returns the techniques of a candidate, each once, without those of hardly seen mirrors: "planar,
/// hybrid".
std::string candidate_technique_names(const std::vector<MirrorDrawMethod>& ways) {
    std::string name;
    for (const auto& [way, word] : {std::pair(MirrorDrawMethod::planes, "planar"),
                                    std::pair(MirrorDrawMethod::hybrid, "hybrid"),
                                    std::pair(MirrorDrawMethod::march, "march")})
        if (std::ranges::find(ways, way) != ways.end())
            name += (name.empty() ? "" : ", ") + std::string(word);
    return name.empty() ? "reuse" : name;
}

/// Returns a candidate. Flat mirrors get `planar` if `planes` is set. Hardly seen mirrors get small
/// captures, and all others get searches.
PlanCandidate make_plan_candidate(const MirrorCostInputs& known, bool planes) {
    std::vector<MirrorDrawMethod> ways(known.mirror_count(), MirrorDrawMethod::small);
    bool is_searched = false; // whether any mirror's capture is searched
    for (std::size_t i = 0; i < known.mirror_count(); ++i) {
        if (!known.is_seen[i] || (planes && known.is_flat[i])) continue;
        ways[i] = should_trace_mirror(known, i) ? MirrorDrawMethod::hybrid
                                                : MirrorDrawMethod::march;
        is_searched = true;
    }
    if (std::ranges::find(ways, MirrorDrawMethod::hybrid) != ways.end())
        for (std::size_t i = 0; i < known.mirror_count(); ++i)
            if (ways[i] == MirrorDrawMethod::march && known.paths.hidden[i] > 0 &&
                static_cast<double>(known.paths.first[i]) >= kLargeMirrorShare * known.on_mirrors)
                ways[i] = MirrorDrawMethod::hybrid;
    bool has_captures = false;
    for (std::size_t i = 0; i < known.mirror_count(); ++i) {
        // If no mirror is searched, a mirrored view costs less than a capture.
        if (planes && known.is_flat[i] && (known.is_seen[i] || !is_searched))
            ways[i] = MirrorDrawMethod::planes;
        has_captures = has_captures || ways[i] != MirrorDrawMethod::planes;
    }
    std::string planar = "planar";
    const char* between = ":";
    const auto add = [&](const std::string& setting) {
        planar += between + setting, between = ",";
    };
    if (known.bounces != kMinPlanarBounces) add("bounces=" + std::to_string(known.bounces));
    if (has_captures && !is_searched) add("capture=" + std::to_string(kSmallCaptureFaceEdge));
    PlanCandidate candidate{.name = candidate_technique_names(ways)};
    for (const MirrorDrawMethod way : ways)
        candidate.techniques.push_back(way == MirrorDrawMethod::planes   ? planar
                                       : way == MirrorDrawMethod::hybrid ? "hybrid"
                                       : way == MirrorDrawMethod::march
                                           ? "march"
                                           : "reuse:face=" + std::to_string(kSmallCaptureFaceEdge));
    compute_cost_and_error(candidate, known, ways,
                           !has_captures ? 0
                           : is_searched ? kUsualFaceEdge
                                         : kSmallCaptureFaceEdge);
    return candidate;
}

/// Returns whether all seen mirrors are of smooth glass, which rays draw right with one ray for
/// each pixel.
bool are_all_seen_mirrors_smooth_glass(const RequiredWorkModelInput& question,
                                       const MirrorCostInputs& known) {
    const std::vector<std::size_t> mirrors = scene::mirrors(question.now);
    for (std::size_t i = 0; i < known.mirror_count(); ++i) {
        if (!known.is_seen[i]) continue;
        const scene::Object& object = question.now.objects[mirrors[i]];
        if (!known.is_glass[i] || scene::may_reflect_by_lobe(question.now, object)) return false;
    }
    return true;
}

/// Returns the candidate that traces the whole picture. It needs no captures.
PlanCandidate make_traced_candidate(const MirrorCostInputs& known) {
    PlanCandidate candidate{.name = "raytrace"};
    candidate.techniques.assign(known.mirror_count(), kTracedGlassTechnique);
    candidate.cost = kPictureCostTable.whole * known.pixels;
    return candidate;
}

std::string format_percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
    return text;
}

/// Returns the reason that follows the mirror's technique.
std::string explain_technique_choice(const RequiredWorkModelInput& question,
                                     const MirrorCostInputs& known, std::size_t mirror,
                                     const scene::Object& object, const std::string& technique) {
    const auto share = [&](std::size_t paths) {
        return format_percent(static_cast<double>(paths) / static_cast<double>(known.paths.count));
    };
    const std::size_t first = known.paths.first[mirror], reached = known.paths.reached[mirror];
    std::string seen = reached == 0 ? "no pixel shows it"
                                    : share(first) + " of the picture, " + share(reached) +
                                          " with what other mirrors show of it";
    if (reached == first && first > 0) seen = share(first) + " of the picture";
    const scene::MirrorShape::ShapeKind kind =
        scene::classify_mirror_shape(question.now, object).kind;
    const char* shape = known.is_glass[mirror]                                   ? "glass"
                        : scene::may_reflect_by_lobe(question.now, object)       ? "rough"
                        : question.now.materials[object.material].normal_texture ? "bumpy"
                        : known.is_flat[mirror]
                            ? kind == scene::MirrorShape::ShapeKind::flat ? "flat" : "flat faces"
                        : kind == scene::MirrorShape::ShapeKind::flat   ? "not quite flat"
                        : kind == scene::MirrorShape::ShapeKind::sphere ? "a sphere"
                                                                        : "curved";
    std::string reason = std::string(shape) + ", " + seen;
    const std::size_t hidden = known.paths.hidden[mirror];
    if (known.is_glass[mirror] && (technique == "hybrid" || technique == kTracedGlassTechnique))
        reason += "; rays pass it";
    else if (technique == "march" && hidden == 0)
        reason += "; its centre sees all that it shows";
    else if (technique == "march" || technique == "hybrid")
        reason += "; its centre does not see what " + share(hidden) + " of the picture show";
    if (technique == "march" && hidden > 0) reason += ", too little to trace";
    return reason;
}

/// Returns a plan such as "1,3=planar *=hybrid". All techniques other than `rest` list their
/// mirrors by number.
std::string
write_technique_plan_text(const std::map<std::string, std::vector<std::size_t>>& mirrors,
                          const std::string& rest) {
    if (mirrors.empty()) return rest;
    if (mirrors.size() == 1) return mirrors.begin()->first;
    std::string plan;
    for (const auto& [technique, numbers] : mirrors) {
        if (technique == rest) continue;
        for (const std::size_t number : numbers)
            plan += (number == numbers.front() ? "" : ",") + std::to_string(number);
        plan += "=" + technique + " ";
    }
    if (mirrors.contains(rest)) return plan + "*=" + rest;
    plan.pop_back();
    return plan;
}

} // namespace

PlanSuggestion suggest_technique_plan(const RequiredWorkModelInput& question) {
    const std::vector<std::size_t> mirrors = scene::mirrors(question.now);
    PlanSuggestion suggestion;
    if (mirrors.empty()) {
        suggestion.plan = "hybrid";
        return suggestion;
    }
    const MirrorCostInputs known = gather_mirror_cost_inputs(question);
    suggestion.candidates.push_back(make_plan_candidate(known, true));
    if (PlanCandidate searched = make_plan_candidate(known, false);
        searched.techniques != suggestion.candidates.front().techniques) {
        const PlanCandidate& planes = suggestion.candidates.front();
        const bool is_cheaper = searched.cost < planes.cost,
                   is_better =
                       searched.error *
                       kMaxEqualErrorFactor<planes.error, is_worse = searched.error> planes.error *
                       kMaxEqualErrorFactor;
        const bool wins = is_better || (!is_worse && is_cheaper);
        suggestion.candidates.insert(wins ? suggestion.candidates.begin()
                                          : suggestion.candidates.end(),
                                     std::move(searched));
    }
    if (known.paths.count_paths_on_mirrors() > 0 &&
        are_all_seen_mirrors_smooth_glass(question, known))
        if (PlanCandidate traced = make_traced_candidate(known);
            traced.cost < suggestion.candidates.front().cost)
            suggestion.candidates.insert(suggestion.candidates.begin(), std::move(traced));
    std::map<std::string, std::vector<std::size_t>> of_technique;
    for (std::size_t i = 0; i < mirrors.size(); ++i) {
        const std::string& technique = suggestion.candidates.front().techniques[i];
        of_technique[technique].push_back(i + 1);
        suggestion.reasons.push_back(technique + ": " +
                                     explain_technique_choice(question, known, i,
                                                              question.now.objects[mirrors[i]],
                                                              technique));
    }
    suggestion.plan = write_technique_plan_text(of_technique, "hybrid");
    return suggestion;
}

std::string format_plan_candidates(const std::vector<PlanCandidate>& candidates) {
    std::string text;
    for (const PlanCandidate& candidate : candidates) {
        char figures[160];
        std::snprintf(figures, sizeof figures,
                      ": estimated cost %.3g million drawn pixels a frame, FLIP %.2g%s\n",
                      candidate.cost / 1e6, candidate.error,
                      &candidate == candidates.data() ? " (chosen)" : "");
        text += "  " + candidate.name + figures;
    }
    return text;
}

} // namespace catoptric::require
