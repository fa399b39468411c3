#pragma once

#include "scene/built_in.hpp"
#include "support/searches.hpp"

/// Bounds for the error of each search. reflect/worth_test.cpp tests them from the scene's own
/// camera, long/worth_test.cpp from all cameras.
namespace test {

/// Largest errors that a search may have, as shares of the error of `parallax:face=512` unless
/// another base is named. Searches with continue=4 follow reflected rays through further mirrors,
/// those with continue=0 do not.
struct SearchErrorLimits {
    double first_order;      ///< rmse of first-order pixels at face=512
    double all;              ///< rmse of all mirror pixels at face=512, continue=4
    double coarse;           ///< rmse of all mirror pixels at face=256, continue=4
    double mirror_in_mirror; ///< rmse of mirror-in-mirror pixels, as share of that with continue=0
    double angle;            ///< mean error of lookup directions in first-order pixels
    double wrong_object = 1; ///< share of first-order pixels, not relative to parallax
};

inline const std::map<std::string, SearchErrorLimits> kSearchErrorLimits{
    {"secant", {.53, .38, .45, .24, .012}},
    {"march", {.53, .38, .45, .24, .012}},
    {"pyramid", {.53, .38, .45, .24, .012}},
    {"layered", {.53, .38, .45, .24, .004, .002}}};

inline void expect_errors_within_limits(const std::string& search, const SearchTestView& look) {
    const SearchErrorLimits& worth = kSearchErrorLimits.at(search);
    const std::vector<SearchErrors> judged = measure_search_errors(
        scene::make_cornell(), look,
        {"parallax:face=512", search + ":face=512,continue=0", search + ":face=512,continue=4",
         search + ":face=256,continue=4"});
    const SearchErrors &parallax = judged[0], &alone = judged[1], &followed = judged[2],
                       &coarse = judged[3];
    EXPECT_LE(alone.first_order, worth.first_order * parallax.first_order);
    EXPECT_LE(followed.all, worth.all * parallax.all);
    EXPECT_LE(coarse.all, worth.coarse * parallax.all);
    EXPECT_LE(followed.mirror_in_mirror, worth.mirror_in_mirror * alone.mirror_in_mirror);
    EXPECT_LE(alone.lookup.mean_degrees, worth.angle * parallax.lookup.mean_degrees);
    EXPECT_LE(alone.lookup.wrong_object, worth.wrong_object);
}

/// Expects that `secant` with smaller captures has no larger errors than `parallax`.
inline void expect_small_captures(const SearchTestView& look) {
    const auto judged = measure_search_errors(
        scene::make_cornell(), look,
        {"parallax:face=512", "secant:face=256,continue=0", "secant:face=64,continue=0"});
    EXPECT_LE(judged[1].first_order, judged[0].first_order);
    EXPECT_LE(judged[2].lookup.mean_degrees, .025 * judged[0].lookup.mean_degrees);
}

/// Expects that `hybrid` has much smaller errors than `parallax` and traces few pixels, also in the
/// closed room.
inline void expect_hybrid_beats_parallax(const SearchTestView& look) {
    const auto judged = measure_search_errors(
        scene::make_cornell(), look,
        {"parallax:face=512", "hybrid:face=512", "hybrid:face=512,continue=0", "hybrid:face=256"});
    const SearchErrors &parallax = judged[0], &followed = judged[1], &alone = judged[2],
                       &coarse = judged[3];
    EXPECT_LE(followed.all, .38 * parallax.all);
    EXPECT_LE(coarse.all, .45 * parallax.all);
    EXPECT_LE(followed.mirror_in_mirror, .24 * alone.mirror_in_mirror);
    EXPECT_LE(followed.traced_fraction, .06);

    const auto closed = measure_search_errors(scene::make_closed_cornell(), look,
                                              {"parallax:face=512", "hybrid:face=512"});
    EXPECT_LE(closed[1].all, .39 * closed[0].all);
    EXPECT_LE(closed[1].traced_fraction, .02);
}

} // namespace test
