#include "study/choose_mix.hpp"

#include "measure/judge.hpp"
#include "measure/plan_mix.hpp"
#include "session/plan_file.hpp"

#include <map>

namespace catoptric::study {

namespace {

/// Returns the text of a plan with one technique per mirror; empty if all mirrors have the same
/// technique.
std::string mix_text(const std::vector<std::string>& texts, const std::vector<std::size_t>& mix) {
    std::map<std::size_t, std::string> mirrors; // numbers of the mirrors of each technique
    for (std::size_t mirror = 0; mirror < mix.size(); ++mirror) {
        std::string& list = mirrors[mix[mirror]];
        list += (list.empty() ? "" : ",") + std::to_string(mirror + 1);
    }
    if (mirrors.size() < 2) return "";
    std::string text;
    for (const auto& [technique, list] : mirrors)
        text += (text.empty() ? "" : " ") + list + "=" + texts[technique];
    return text;
}

} // namespace

std::string find_fastest_mixed_plan(const ResolvedRequest& request,
                                    const measure::Comparison& training,
                                    const std::vector<JudgedPlan>& plans) {
    if (!request.max_error) return "";
    const bool squares = request.quantity == ErrorQuantity::rmse; // squared errors can be added
                                                                  // over pixels
    std::vector<measure::MixCandidate> candidates;
    std::vector<std::string> texts;
    std::vector<std::vector<double>> pixels;
    for (std::size_t i = 0; i < plans.size(); ++i) {
        if (!read_plan(plans[i].text).is_technique) continue;
        measure::MixCandidate candidate{plans[i].ms, {}};
        pixels.clear();
        for (const measure::Errors& view : training.rows[i].views) {
            std::vector<double>& sums = candidate.error_sums.emplace_back();
            std::vector<double>& counts = pixels.emplace_back();
            for (const measure::Difference& mirror : view.error_per_mirror) {
                const double error = mirror.pixels > 0 ? error_value(request.quantity, mirror) : 0;
                counts.push_back(static_cast<double>(mirror.pixels));
                sums.push_back(counts.back() * (squares ? error * error : error));
            }
        }
        candidates.push_back(std::move(candidate));
        texts.push_back(plans[i].text);
    }
    const double limit = squares ? *request.max_error * *request.max_error : *request.max_error;
    const std::vector<std::size_t> mix = measure::find_fastest_mix(candidates, pixels, limit);
    return mix_text(texts, mix);
}

bool is_second_faster(const ResolvedRequest& request, const std::string& first,
                      JudgedPlan& second) {
    const std::vector<std::string> texts{first, second.text};
    const measure::Comparison both = request.compare_plans(texts, 0, request.base.seed, 1);
    std::vector<JudgedPlan> plans = judged_plans(request, both, texts);
    const bool is_faster = request.device_costs
                               ? plans[1].ms < plans[0].ms
                               : measure::RowJudge(both.rows).times(both.rows[1], both.rows[0]) ==
                                     measure::Order::less;
    second = std::move(plans[1]);
    return is_faster;
}

} // namespace catoptric::study
