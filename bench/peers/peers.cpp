// Compares our ray tracer and captures with Embree 3 and with simple prototypes. All of them run in
// turn in one process.
//   catoptric_peers [ROUNDS] [CASE...]
// ROUNDS is at least 6. Without CASE, all cases run. The exit code is 1 if results differ.
// The cases `built-in`, `100k`, `1M` and `room` compare pictures of these scenes. `built-in` also
// compares captures and prototypes. The case `rays` compares lists of camera rays and of
// incoherent rays, and the case `trees` compares trees.
#include "cases.hpp"
#include "core/error.hpp"
#include "gpu/shader.hpp"
#include "measure/interval.hpp"
#include "prototype_shaders.hpp"

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <functional>

namespace {

using namespace catoptric;
using peers::EmbreeComparisonBench;

struct EmbreeComparisonCase {
    std::string name;
    std::function<bool(const EmbreeComparisonBench&)> compare;
};

std::vector<EmbreeComparisonCase> list_embree_comparison_cases() {
    std::vector<EmbreeComparisonCase> cases{{"built-in", peers::compare_built_in_scene_pictures}};
    for (const peers::NamedSceneFactory& scene : peers::list_named_scene_factories().subspan(1))
        cases.push_back({scene.name, [&scene](const EmbreeComparisonBench& bench) {
                             return peers::compare_whitted_pictures_with_embree(bench, scene);
                         }});
    cases.push_back({"rays", [](const EmbreeComparisonBench& bench) {
                         return std::ranges::count_if(
                                    peers::list_named_scene_factories(),
                                    [&](const peers::NamedSceneFactory& scene) {
                                        return !peers::compare_ray_lists_with_embree(bench, scene);
                                    }) == 0;
                     }});
    cases.push_back({"trees", [](const EmbreeComparisonBench& bench) {
                         peers::compare_bvhs_with_embree(bench);
                         return true;
                     }});
    return cases;
}

/// Returns the cases that the words name, or all cases if `words` is empty.
std::vector<EmbreeComparisonCase>
select_comparison_cases_by_name(const std::vector<std::string>& words) {
    const std::vector<EmbreeComparisonCase> all = list_embree_comparison_cases();
    std::vector<EmbreeComparisonCase> chosen;
    for (const std::string& word : words) {
        const auto found = std::ranges::find(all, word, &EmbreeComparisonCase::name);
        std::string names;
        for (const EmbreeComparisonCase& one : all) names += " " + one.name;
        check(found != all.end(), Failure::usage, "no case '", word, "': there are", names);
        chosen.push_back(*found);
    }
    return words.empty() ? all : chosen;
}

/// Returns the number of rounds in the first word and removes this word. Returns 0 if the first
/// word is no number.
int parse_benchmark_round_count(std::vector<std::string>& words) {
    int rounds = 0;
    if (words.empty()) return 0;
    const char* const end = words[0].data() + words[0].size();
    const auto [last, error] = std::from_chars(words[0].data(), end, rounds);
    if (error != std::errc() || last != end) return 0;
    words.erase(words.begin());
    return rounds;
}

} // namespace

int main(int argc, char** argv) try {
    const session::UsageMeter meter(session::UsageMeter::Threads::process); // created before other
                                                                            // threads start
    std::vector<std::string> words(argv + 1, argv + argc);
    const int rounds = std::max(static_cast<int>(measure::kMinIntervalSamples),
                                parse_benchmark_round_count(words));
    const std::vector<EmbreeComparisonCase> cases = select_comparison_cases_by_name(words);
    if (!meter.why_uncounted().empty())
        std::printf("cycles are not counted: %s\n", meter.why_uncounted().c_str());
    for (const gpu::EmbeddedShader& shader : peers::prototype_shaders()) gpu::add_shader(shader);
    const peers::EmbreeDevice device;
    session::Engine engine({});
    const int threads = std::max(1, engine.device().threads);
    std::printf("%s, %s; Embree %s, packets of 16 %s; %d threads each\n",
                engine.device().name.c_str(), engine.device().driver.c_str(), RTC_VERSION_STRING,
                rtcGetDeviceProperty(device.embree_device_handle(),
                                     RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)
                    ? "native"
                    : "emulated",
                threads);
    const EmbreeComparisonBench bench{engine, meter, device, threads, rounds};
    bool same = true;
    for (const EmbreeComparisonCase& one : cases) same = one.compare(bench) && same;
    return same ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "catoptric_peers: %s\n", error.what());
    return 1;
}
