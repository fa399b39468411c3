#include "repeats.hpp"

#include "compare.hpp"
#include "import/load.hpp"
#include "measure/judge.hpp"
#include "measure/statistics.hpp"
#include "scene/built_in.hpp"

#include <algorithm>
#include <cstdio>
#include <map>

using namespace catoptric;

namespace {

struct PairOutcomeCount {
    int faster = 0, slower = 0;
    std::vector<double> ratios; ///< ratios of the two rows' median times
};

} // namespace

void repeat_comparison_of_rows(int times, const std::vector<std::string>& rows) {
    session::Engine engine({});
    study::CompareRequest request;
    request.base.scene = scene::make_cornell();
    request.base.camera = request.base.scene.cameras.front();
    request.base.size = {128, 128};
    request.base.techniques = rows;
    std::map<std::pair<std::size_t, std::size_t>, PairOutcomeCount> pairs;
    int noisy = 0;
    for (int k = 0; k < times; ++k) {
        const measure::Comparison found = study::compare(engine, request);
        noisy += !measure::find_noisy_rows(found).empty();
        for (std::size_t b = 1; b < rows.size(); ++b)
            for (std::size_t a = 0; a < b; ++a) {
                PairOutcomeCount& count = pairs[{a, b}];
                count.faster += measure::compare_times(found.rows[b], found.rows[a]) ==
                                measure::Order::less;
                count.slower += measure::compare_times(found.rows[a], found.rows[b]) ==
                                measure::Order::less;
                count.ratios.push_back(found.rows[b].time_ms().median /
                                       found.rows[a].time_ms().median);
            }
    }
    std::printf("%s, %s; 128x128, %d times; noisy rows in %d\n\n", engine.device().name.c_str(),
                engine.device().driver.c_str(), times, noisy);
    std::printf("| Row | beside | faster | slower | tie | ratio, median [least - largest] |\n"
                "|---|---|---:|---:|---:|---:|\n");
    for (const auto& [pair, count] : pairs) {
        const auto [least, most] = std::ranges::minmax(count.ratios);
        std::printf("| %s | %s | %d | %d | %d | %.3f [%.3f - %.3f] |\n", rows[pair.second].c_str(),
                    rows[pair.first].c_str(), count.faster, count.slower,
                    times - count.faster - count.slower, measure::summarise(count.ratios).median,
                    least, most);
    }
}
