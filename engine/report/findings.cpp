#include "report/findings.hpp"

#include "report/lag_tables.hpp"
#include "report/rows.hpp"
#include "report/seed_table.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace catoptric::report {

namespace {

using Sentence = std::optional<std::string>;

/// One step of an 8-bit picture.
constexpr double kStep = 1.0 / 255;

double ms_of(const Row& row) { return row.gpu_ms.median; }

std::string percent(double share) { return fixed(100 * share, share < 0.1 ? 1 : 0) + " %"; }

/// "1.2 against 3.4 ms", and that no more can be said where the bands of the times overlap.
std::string both_times(const Row& a, const Row& b) {
    return ms_text(ms_of(a)) + " against " + ms_text(ms_of(b)) + " ms";
}
bool is_tie(const Row& a, const Row& b) { return !is_faster(a, b) && !is_faster(b, a); }
constexpr const char* kTie = ": their bands overlap, they are not told apart";

/// What a clear would do to our part one, which renders and clears no cube without
/// inter-reflections.
std::string clear_verdict(double clear, const Row& one, const Row& two) {
    if (is_faster(two, one))
        return "part one is slower without any clear, so clearing alone does not explain the order "
               "on "
               "this device";
    if (!(one.gpu_ms.p05 + clear > two.gpu_ms.p95))
        return "added to part one that still leaves it no slower than part two, so clearing alone "
               "does "
               "not explain the report's order on this device";
    const double gap = (ms_of(one) + clear - ms_of(two)) / ms_of(two);
    const double seed_gap = (kSeedPartOne.ms - kSeedPartTwo.ms) / kSeedPartTwo.ms;
    return fmt::format(
        "added to part one that would put it {} behind part two (the report: {}), so "
        "clearing alone does explain the order on this device",
        percent(gap), percent(seed_gap));
}

Sentence clears(const Comparison& comparison) {
    const Row* one = find_naive(comparison, 0);
    const Row* two = find_row(comparison, "reuse");
    if (one == nullptr || two == nullptr) return {};
    const char* order = is_faster(*two, *one) ? "slower than" : "not slower than";
    std::string text = fmt::format("Clears: the report's part one without inter-reflections took "
                                   "{:.1f} ms more than its part two "
                                   "({:.1f} against {:.1f} ms), which it puts down to clearing the "
                                   "cube maps. Here part one, {}, "
                                   "is {} part two ({})",
                                   kSeedPartOne.ms - kSeedPartTwo.ms, kSeedPartOne.ms,
                                   kSeedPartTwo.ms, one->label, order, both_times(*one, *two));
    if (!comparison.clear_ms) return text + "; what a clear costs was not measured.";
    const double clear = comparison.clear_ms->median;
    return text + ". Clearing the cubes of all mirrors costs " + ms_text(clear) +
           " ms: " + clear_verdict(clear, *one, *two) + ".";
}

Sentence stored_distance(const Comparison& comparison) {
    const auto eight_bits = [&](std::string_view range) {
        const Wanted wanted[] = {{"distance", "unorm8"}, {"range", range}};
        return find_row(comparison, "parallax", wanted);
    };
    const Row* plain = find_row(comparison, "reuse");
    const Row* full = find_parallax(comparison);
    const Row* near = eight_bits("200");
    const Row* far = eight_bits("1000");
    if (!judged(plain) || !judged(full) || (!judged(near) && !judged(far))) return {};
    const auto rmse = [](const Row* row) { return error_text(row->error.rmse); };
    std::string text = "Stored distance: rmse over the mirrors is " + rmse(plain) +
                       " without correction, " + rmse(full) + " corrected with 32-bit distances";
    if (judged(near)) text += ", " + rmse(near) + " with 8 bits up to 200 units as in the report";
    if (judged(far)) text += ", " + rmse(far) + " with 8 bits up to 1000 units";
    if (!judged(near)) return text + ".";
    if (near->error.rmse > plain->error.rmse)
        return text +
               ". With the report's range the correction makes the picture worse than none, so "
               "its figure 7 cannot have been made that way in these units.";
    return text +
           ". With the report's range the correction still helps, so its figure 7 may have been "
           "made that way.";
}

Sentence inter_reflections(const Comparison& comparison) {
    std::vector<const Row*> steps;
    for (int i = 1; judged(find_naive(comparison, i)); ++i)
        steps.push_back(find_naive(comparison, i));
    if (steps.size() < 2) return {};
    std::vector<std::string> figures;
    for (const Row* row : steps) figures.push_back(error_text(row->error.rmse));
    std::string text = fmt::format(
        "Inter-reflections: with i = 1 to {} the rmse of part one over the mirrors is {}. ",
        steps.size(), joined(figures, ", "));
    const double fall = steps.front()->error.rmse - steps.back()->error.rmse;
    if (fall > kStep)
        return text + "More inter-reflections bring it closer to the reference, by " +
               error_text(fall) + " in all.";
    text +=
        "From i = 1 on, more of them bring it no closer to the reference by as much as one 8-bit "
        "step (1/255)";
    // Parallax dominates where correcting it takes away more than half of the squared error.
    const Row* corrected = find_parallax(comparison);
    const double rest = steps.back()->error.rmse;
    if (judged(corrected) && 2 * corrected->error.rmse * corrected->error.rmse < rest * rest)
        text +=
            ": parallax dominates what is left, and no number of inter-reflections repairs it (" +
            error_text(corrected->error.rmse) + " once corrected)";
    return text + ".";
}

Sentence price_of_correction(const Comparison& comparison) {
    const Row* two = find_row(comparison, "reuse");
    const Row* three = find_parallax(comparison);
    if (two == nullptr || three == nullptr || !(ms_of(*two) > 0)) return {};
    const double more = ms_of(*three) / ms_of(*two) - 1;
    std::string text = fmt::format(
        "Price of the correction: the report calls the code's complexity its only drawback ({:.1f} "
        "against {:.1f} ms). Here part three takes ",
        kSeedPartThree.ms, kSeedPartTwo.ms);
    if (is_tie(*two, *three))
        text += "as long as part two (" + both_times(*three, *two) + kTie + ")";
    else
        text += percent(std::abs(more)) + (more < 0 ? " less" : " more") + " time than part two (" +
                both_times(*three, *two) + ")";
    if (three->memory_bytes > two->memory_bytes)
        text += fmt::format(" and {} MiB more memory for the distances",
                            mebibytes(three->memory_bytes - two->memory_bytes));
    return text + ".";
}

Sentence ray_tracing(const Comparison& comparison) {
    const Row* three = find_parallax(comparison);
    const Row* traced = find_ray_traced(comparison);
    if (three == nullptr || traced == nullptr || !(ms_of(*three) > 0)) return {};
    std::string text = fmt::format("Ray tracing: in the report it takes {:.1f} times as long as "
                                   "part three ({:.1f} against {:.1f} "
                                   "ms); here {} takes ",
                                   kSeedRayTrace.ms / kSeedPartThree.ms, kSeedRayTrace.ms,
                                   kSeedPartThree.ms, traced->label);
    if (is_tie(*three, *traced))
        text += "as long as " + three->label + " (" + both_times(*traced, *three) + kTie + ")";
    else
        text += ms_text(ms_of(*traced) / ms_of(*three)) + " times as long as " + three->label +
                " (" + both_times(*traced, *three) + ")";
    return text + ".";
}

} // namespace

std::string findings_title(const Comparison& comparison) {
    return comparison.scene.is_seed ? "What this says of the seed report" : "What this says";
}

std::vector<std::string> findings(const Comparison& comparison) {
    struct Finding {
        Sentence (*say)(const Comparison&);
        bool beside_the_report; ///< compares with its figures, so with its scene only
    };
    std::vector<std::string> list;
    for (const auto& [say, beside_the_report] : {Finding{clears, true},
                                                 {inter_reflections, false},
                                                 {stored_distance, true},
                                                 {price_of_correction, true},
                                                 {ray_tracing, true},
                                                 {lag_in_words, false}}) {
        if (beside_the_report && !comparison.scene.is_seed) continue;
        if (const Sentence sentence = say(comparison)) list.push_back(*sentence);
    }
    return list;
}

} // namespace catoptric::report
