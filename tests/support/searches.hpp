#pragma once

#include "measure/flip.hpp"
#include "measure/lookup.hpp"
#include "scene/built_in.hpp"
#include "study/oracle.hpp"
#include "support/rendering.hpp"

#include <iostream>
#include <map>

/// Measures the errors of techniques that search captures, in the built-in scene at 512x512, from
/// several cameras.
namespace test {

inline constexpr uvec2 kSearchTestPictureSize{512, 512};
inline constexpr int kConvergedFrames = 4; ///< frames until deeper bounces have arrived

/// A camera and the instant of its picture.
struct SearchTestView {
    scene::Camera camera;
    double time = 0;
};

/// Returns three cameras: the scene's own, one at the side and one above. Ball 4 is at another
/// place at each camera's instant.
inline std::vector<SearchTestView> list_search_test_views() {
    return {{scene::make_cornell().cameras.front(), 0},
            {{.name = "side",
              .eye = {400, 330, -760},
              .target = {400, 330, 0},
              .vertical_fov_degrees = 37.5},
             1.3},
            {{.name = "above",
              .eye = {120, 420, -500},
              .target = {330, 120, 300},
              .vertical_fov_degrees = 45},
             2.6}};
}

/// Returns three cameras that were not used while searches were developed: low at the open front of
/// the room, along the floor, and down from below the ceiling.
inline std::vector<SearchTestView> list_unseen_search_test_views() {
    return {{{.name = "low",
              .eye = {540, 12, -60},
              .target = {300, 60, 400},
              .vertical_fov_degrees = 55},
             1.9},
            {{.name = "floor",
              .eye = {100, 5, -100},
              .target = {300, 40, 400},
              .vertical_fov_degrees = 50},
             0},
            {{.name = "ceiling",
              .eye = {300, 300, 545},
              .target = {300, 90, 200},
              .vertical_fov_degrees = 75},
             0}};
}

/// Errors of a technique against ray tracing: rmse in linear RGB by what the reflected ray meets,
/// and errors of the looked-up directions.
struct SearchErrors {
    double all = 0, first_order = 0, mirror_in_mirror = 0;
    measure::LookupSummary lookup;
    double traced_fraction = 0; ///< share of mirror pixels that are traced (`hybrid`)
};

namespace detail {

/// The reference picture from one camera, and a finder of what its reflected rays meet.
struct ReferencePicture {
    session::TechniqueResult part;
    study::TrueHitFinder finder;
};

inline session::Request make_view_request(const scene::Scene& scene, const SearchTestView& look,
                                          const std::string& technique) {
    session::Request asked = make_test_request(scene, {technique}, kSearchTestPictureSize);
    asked.camera = look.camera;
    asked.time = look.time;
    return asked;
}

inline SearchErrors measure_search_errors(const scene::Scene& scene, const SearchTestView& look,
                                          const std::string& technique,
                                          const ReferencePicture& truth) {
    session::Request asked = make_view_request(scene, look, technique);
    asked.with_lookup = true;
    const session::TechniqueResult part = std::move(
        render_last_frame(asked, kConvergedFrames).front());
    const SearchErrors error{
        rmse_of_pictures(part.hdr, truth.part.hdr, measure::mask_mirrors(truth.part.hits)),
        rmse_of_pictures(part.hdr, truth.part.hdr, measure::mask_first_order(truth.part.hits)),
        rmse_of_pictures(part.hdr, truth.part.hdr, measure::mask_mirror_in_mirror(truth.part.hits)),
        measure::summarise_lookups(truth.finder.judge_lookups(part.lookup)),
        part.traced_fraction.value_or(0)};
    std::cout << "[ MEASURED ] " << look.camera.name << ", " << part.label << ": rmse " << error.all
              << ", first order " << error.first_order << ", mirror in mirror "
              << error.mirror_in_mirror << "; mean angle " << error.lookup.mean_degrees
              << " degrees, p95 " << error.lookup.p95_degrees << ", wrong object "
              << error.lookup.wrong_object << ", unknown " << error.lookup.unknown << ", traced "
              << error.traced_fraction << "\n";
    return error;
}

} // namespace detail

/// Returns the errors of techniques from one camera. A program renders each technique and reference
/// only once per camera name, because tests of several searches share the results.
inline std::vector<SearchErrors>
measure_search_errors(const scene::Scene& scene, const SearchTestView& look,
                      const std::vector<std::string>& techniques,
                      const std::string& reference = "raytrace:depth=16") {
    static std::map<std::string, detail::ReferencePicture> truths;
    static std::map<std::string, SearchErrors> known;
    const std::string place = scene.name + ", " + look.camera.name + ", " + reference;
    if (!truths.contains(place)) {
        const session::Request asked = detail::make_view_request(scene, look, reference);
        truths.emplace(place, detail::ReferencePicture{
                                  std::move(session::run(get_test_engine(), asked).parts.front()),
                                  study::TrueHitFinder(asked)});
    }
    std::vector<SearchErrors> judged;
    for (const std::string& technique : techniques) {
        const std::string key = place + ", " + technique;
        if (!known.contains(key))
            known.emplace(key,
                          detail::measure_search_errors(scene, look, technique, truths.at(place)));
        judged.push_back(known.at(key));
    }
    return judged;
}

/// Returns FLIP and other differences from ray tracing over the mirrors, for the second frame of
/// each technique. The second frame suffices, because searches follow rays to deeper mirrors
/// themselves.
inline std::vector<measure::Difference>
compare_mirror_pictures(const scene::Scene& scene, const SearchTestView& look,
                        std::vector<std::string> techniques) {
    techniques.push_back("raytrace:depth=16");
    session::Request asked = make_test_request(scene, techniques, kSearchTestPictureSize);
    asked.camera = look.camera;
    asked.time = look.time;
    const std::vector<session::TechniqueResult> parts = render_last_frame(asked, 2);
    const session::TechniqueResult& truth = parts.back();
    std::vector<measure::Difference> seen;
    for (std::size_t i = 0; i + 1 < parts.size(); ++i) {
        seen.push_back(
            measure::difference(parts[i].hdr, truth.hdr, measure::mask_mirrors(truth.hits),
                                measure::flip(measure::to_unrounded_display(parts[i].hdr),
                                              measure::to_unrounded_display(truth.hdr))));
        std::cout << "[ MEASURED ] " << look.camera.name << ", " << parts[i].label << ": FLIP "
                  << seen.back().flip << ", off " << seen.back().off << ", longest line "
                  << seen.back().longest_line << "\n";
    }
    return seen;
}

/// Returns the error of the looked-up direction of each first-order pixel, seen by the scene's
/// first camera.
inline std::vector<measure::LookupError>
measure_lookup_directions(const scene::Scene& scene, const std::string& technique, uvec2 size) {
    session::Request asked = make_test_request(scene, {technique}, size);
    asked.with_lookup = true;
    return study::TrueHitFinder(asked).judge_lookups(
        session::run(get_test_engine(), asked).parts.front().lookup);
}

} // namespace test
