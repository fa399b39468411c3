#include "require/plan_candidates.hpp"

#include "scene/flat_mirror.hpp"
#include "scene/material_facts.hpp"
#include "scene/rough_reflectors.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace catoptric::require {

namespace {

constexpr TechniqueErrors kTechniqueErrors;
/// Tracing what a capture does not show must reduce the mirror's estimated error by this factor.
constexpr double kMinErrorGain = 1.1;
/// If some mirror is traced, each mirror with hidden reflected points and at least this share of
/// all mirror pixels is traced as well.
constexpr double kLargeMirrorShare = .1;
constexpr int kMinPlanarBounces = 2;        // smallest `bounces` of `planar`
constexpr int kMaxSuggestedBounces = 6;     // largest `bounces` that is suggested
constexpr double kMaxBlackPixelShare = .01; // share of mirror pixels that may need more bounces
constexpr int kLobeRayDepth = 4;            // reflections of traced plans with rays of lobes
// Visits of a subgroup for each node of rays that scatter, and of rays of listed pixels.
constexpr double kIncoherentLanes = 1 / 3.5, kListedLanes = 1 / 4.8;

/// Returns how many mirrors for which `of` is true the path meets before any other mirror.
std::size_t count_leading_mirrors(const std::vector<std::uint32_t>& path,
                                  const std::vector<bool>& of) {
    return static_cast<std::size_t>(
        std::ranges::find_if(path, [&](std::uint32_t mirror) { return !of[mirror]; }) -
        path.begin());
}

bool is_mirror_flat(const WorkModelInput& input, const scene::Object& object) {
    const scene::FlatFaces flats = scene::find_flat_faces(input.now, object);
    // The errors of the candidates are those of sharp mirrors. A blurred view has a larger error.
    return !flats.is_rough &&
           flats.flat_share(scene::flat_tolerance(input.camera, input.size)) >= 1 - kMaxCurvedShare;
}

/// Returns how many flat mirrors one behind the other the picture shows, ignoring few pixels.
int count_planar_bounces(const CostInputs& known) {
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

/// Returns whether tracing what its capture does not show reduces the mirror's estimated error by
/// more than a tenth.
bool should_trace(const CostInputs& known, std::size_t mirror) {
    if (known.is_glass[mirror]) return true; // captures only approximate what passes the body
    const auto first = static_cast<double>(known.paths.first[mirror]),
               hidden = static_cast<double>(known.paths.hidden[mirror]);
    return hidden * (kTechniqueErrors.unknown - kTechniqueErrors.search) >
           (kMinErrorGain - 1) * kTechniqueErrors.search * first;
}

double search_error(const CostInputs& known, std::size_t mirror) {
    return known.is_rough[mirror] ? kTechniqueErrors.rough_search : kTechniqueErrors.search;
}

/// Adds work and error of a mirror that is seen in flat mirrors with mirrored views. `path` lists
/// the mirrors that `count` rays meet; this mirror is the last. A mirrored view looks into the
/// mirror's capture but traces nothing, so it can only guess what the capture does not show.
void add_reflected_mirror(PlanCandidate& candidate, FrameWork& work, const CostInputs& known,
                          const std::vector<std::uint32_t>& path, std::size_t count,
                          DrawMethod way) {
    const bool is_searched = way != DrawMethod::small;
    if (is_searched) work.add_search(known.pixels(count));
    const double error = is_searched ? search_error(known, path.back()) : kTechniqueErrors.reuse;
    candidate.error += static_cast<double>(count) * (error - kTechniqueErrors.planar);
    const auto found = known.paths.hidden_after.find(path);
    if (is_searched && found != known.paths.hidden_after.end())
        candidate.error += static_cast<double>(found->second) * (kTechniqueErrors.unknown - error);
}

/// Adds the work and the error of one mirror's own pixels, without mirrored views.
void add_mirror(PlanCandidate& candidate, FrameWork& work, const CostInputs& known,
                std::size_t mirror, DrawMethod way) {
    const std::size_t first = known.paths.first[mirror], hidden = known.paths.hidden[mirror];
    const bool is_searched = way == DrawMethod::hybrid || way == DrawMethod::march;
    if (is_searched)
        work.add_search(known.pixels(first));
    else if (way == DrawMethod::small)
        work.add_lookup(known.pixels(first));
    if (way == DrawMethod::hybrid) {
        const WalkedRays& sharp = known.paths.sharp;
        const double rays = known.pixels(known.is_glass[mirror] ? first : hidden),
                     ray_nodes = rays * sharp.nodes / std::max(1.0, sharp.rays);
        work.add_rays({WorkKind::mirror_rays, rays, ray_nodes, ray_nodes * kIncoherentLanes, true});
    }
    const double error = way == DrawMethod::planes ? kTechniqueErrors.planar
                         : is_searched             ? search_error(known, mirror)
                                                   : kTechniqueErrors.reuse;
    candidate.error += static_cast<double>(first) * error;
    if (way == DrawMethod::march)
        candidate.error += static_cast<double>(hidden) * (kTechniqueErrors.unknown - error);
}

/// Sets the time and the error of the candidate's techniques. `face` is the edge in texels of the
/// captures of mirrors drawn by `planar`; 0: no captures.
void estimate(PlanCandidate& candidate, const CostInputs& known, const UnitCosts& costs,
              const std::vector<DrawMethod>& ways, std::uint32_t face) {
    FrameWork work(known.picture);
    work.add_view();
    std::vector<bool> by_planes;
    for (const DrawMethod way : ways) by_planes.push_back(way == DrawMethod::planes);
    for (std::size_t i = 0; i < known.mirror_count() && face > 0; ++i)
        work.add_capture(by_planes[i]                   ? face
                         : ways[i] == DrawMethod::small ? kSmallFaceEdge
                                                        : kUsualFaceEdge,
                         ways[i] == DrawMethod::hybrid, known.is_rough[i]);
    if (std::ranges::find(ways, DrawMethod::hybrid) != ways.end()) work.add_list();
    for (std::size_t i = 0; i < known.mirror_count(); ++i)
        add_mirror(candidate, work, known, i, ways[i]);
    for (const auto& [path, count] : known.paths.through) {
        const auto bounces = static_cast<std::size_t>(known.bounces);
        const std::size_t planes = count_leading_mirrors(path, by_planes);
        if (planes > 0 && planes + 1 == path.size() && planes <= bounces)
            add_reflected_mirror(candidate, work, known, path, count, ways[path.back()]);
        if (planes != path.size()) continue;
        if (path.size() <= bounces) work.add_mirrored_view(known.pixels(count));
        if (path.size() == bounces + 1)
            candidate.error += static_cast<double>(count) *
                               (kTechniqueErrors.black - kTechniqueErrors.planar);
    }
    candidate.error /= known.on_mirrors;
    candidate.ms = predict_ms(work.work(), costs);
}

/// Returns the techniques of a candidate, each once, without those of hardly seen mirrors: "planar,
/// hybrid".
std::string technique_names(const std::vector<DrawMethod>& ways) {
    std::string name;
    for (const auto& [way, word] :
         {std::pair(DrawMethod::planes, "planar"), std::pair(DrawMethod::hybrid, "hybrid"),
          std::pair(DrawMethod::march, "march")})
        if (std::ranges::find(ways, way) != ways.end())
            name += (name.empty() ? "" : ", ") + std::string(word);
    return name.empty() ? "reuse" : name;
}

/// Returns whether some seen mirror is one of these.
bool has_seen_mirror(const CostInputs& known, const std::vector<bool>& of) {
    for (std::size_t i = 0; i < known.mirror_count(); ++i)
        if (known.is_seen[i] && of[i]) return true;
    return false;
}

/// Returns the technique that traces all mirrors.
std::string write_traced_technique(int lobe_rays, bool is_rasterised) {
    std::string text = "raytrace";
    const char* between = ":";
    const auto add = [&](const std::string& setting) { text += between + setting, between = ","; };
    // Sharp paths end where they meet no mirror, so a large depth costs nothing.
    if (lobe_rays > 0) {
        add("depth=" + std::to_string(kLobeRayDepth));
        add("rays=" + std::to_string(lobe_rays));
    }
    if (is_rasterised) add("first=raster");
    return text;
}

/// Returns a candidate that traces all mirrors, and the whole picture unless `is_rasterised`.
/// `lobe_rays`: rays of each pixel that are drawn from lobes; 0: rough mirrors reflect sharply.
PlanCandidate make_traced_candidate(const CostInputs& known, const UnitCosts& costs, int lobe_rays,
                                    bool is_rasterised) {
    const bool has_lobes = lobe_rays > 0;
    PlanCandidate candidate{.name = write_traced_technique(lobe_rays, is_rasterised)};
    candidate.ways.assign(known.mirror_count(), DrawMethod::traced);
    candidate.techniques.assign(known.mirror_count(), candidate.name);
    FrameWork work(known.picture);
    const WalkedRays &camera = known.paths.camera, &sharp = known.paths.sharp,
                     &rough = known.paths.rough;
    const double scale = known.picture.pixels_per_path;
    if (is_rasterised) {
        work.add_view();
        work.add_list();
    } else {
        work.add_traced_picture();
        work.add_rays({WorkKind::camera_rays, scale * camera.rays, scale * camera.nodes,
                       scale * camera.node_lanes});
    }
    const double times = scale * std::max(1, lobe_rays);
    const double sharp_lanes = has_lobes       ? sharp.nodes * kIncoherentLanes
                               : is_rasterised ? sharp.nodes * kListedLanes
                                               : sharp.node_lanes;
    work.add_rays({WorkKind::mirror_rays, times * sharp.rays, times * sharp.nodes,
                   times * sharp_lanes, is_rasterised});
    if (has_lobes)
        work.add_rays({WorkKind::mirror_rays, times * rough.rays, times * rough.nodes,
                       times * rough.nodes * kIncoherentLanes, is_rasterised});
    candidate.ms = predict_ms(work.work(), costs);
    for (std::size_t i = 0; i < known.mirror_count(); ++i)
        if (known.is_rough[i])
            candidate.error += static_cast<double>(known.paths.first[i]) *
                               (lobe_rays > 1 ? kTechniqueErrors.four_rough_rays
                                              : kTechniqueErrors.one_rough_ray) /
                               known.on_mirrors;
    if (is_rasterised) candidate.error += kTechniqueErrors.raster;
    return candidate;
}

} // namespace

CostInputs gather_cost_inputs(const WorkModelInput& input) {
    CostInputs known{.paths = trace_paths(input)};
    for (const std::size_t object : scene::mirrors(input.now)) {
        known.is_flat.push_back(is_mirror_flat(input, input.now.objects[object]));
        known.is_glass.push_back(
            scene::is_glass(input.now.materials[input.now.objects[object].material]));
        known.is_rough.push_back(scene::may_reflect_by_lobe(input.now, input.now.objects[object]));
    }
    known.picture = count_picture(input, known.paths);
    known.on_mirrors = static_cast<double>(std::max<std::size_t>(1, known.paths.on_mirrors()));
    for (const std::size_t reached : known.paths.reached)
        known.is_seen.push_back(static_cast<double>(reached) > kHardlySeenShare * known.on_mirrors);
    // Without any visible mirror, treat all as visible.
    if (std::ranges::none_of(known.is_seen, std::identity()))
        known.is_seen.assign(known.mirror_count(), true);
    known.bounces = count_planar_bounces(known);
    return known;
}

PlanCandidate make_captured_candidate(const CostInputs& known, const UnitCosts& costs,
                                      bool planes) {
    std::vector<DrawMethod> ways(known.mirror_count(), DrawMethod::small);
    bool is_searched = false; // whether any mirror's capture is searched
    for (std::size_t i = 0; i < known.mirror_count(); ++i) {
        if (!known.is_seen[i] || (planes && known.is_flat[i])) continue;
        ways[i] = should_trace(known, i) ? DrawMethod::hybrid : DrawMethod::march;
        is_searched = true;
    }
    if (std::ranges::find(ways, DrawMethod::hybrid) != ways.end())
        for (std::size_t i = 0; i < known.mirror_count(); ++i)
            if (ways[i] == DrawMethod::march && known.paths.hidden[i] > 0 &&
                static_cast<double>(known.paths.first[i]) >= kLargeMirrorShare * known.on_mirrors)
                ways[i] = DrawMethod::hybrid;
    bool has_captures = false;
    for (std::size_t i = 0; i < known.mirror_count(); ++i) {
        // If no mirror is searched, a mirrored view costs less than a capture.
        if (planes && known.is_flat[i] && (known.is_seen[i] || !is_searched))
            ways[i] = DrawMethod::planes;
        has_captures = has_captures || ways[i] != DrawMethod::planes;
    }
    std::string planar = "planar";
    const char* between = ":";
    const auto add = [&](const std::string& setting) {
        planar += between + setting, between = ",";
    };
    if (known.bounces != kMinPlanarBounces) add("bounces=" + std::to_string(known.bounces));
    if (has_captures && !is_searched) add("capture=" + std::to_string(kSmallFaceEdge));
    PlanCandidate candidate{.name = technique_names(ways), .ways = ways};
    for (const DrawMethod way : ways)
        candidate.techniques.push_back(way == DrawMethod::planes   ? planar
                                       : way == DrawMethod::hybrid ? "hybrid"
                                       : way == DrawMethod::march
                                           ? "march"
                                           : "reuse:face=" + std::to_string(kSmallFaceEdge));
    estimate(candidate, known, costs, ways,
             !has_captures ? 0
             : is_searched ? kUsualFaceEdge
                           : kSmallFaceEdge);
    return candidate;
}

std::vector<PlanCandidate> make_traced_candidates(const CostInputs& known, const UnitCosts& costs) {
    std::vector<int> lobe_rays{0};
    if (has_seen_mirror(known, known.is_rough)) lobe_rays = {1, 4};
    std::vector<PlanCandidate> candidates;
    for (const int rays : lobe_rays)
        for (const bool is_rasterised : {false, true})
            candidates.push_back(make_traced_candidate(known, costs, rays, is_rasterised));
    return candidates;
}

} // namespace catoptric::require
