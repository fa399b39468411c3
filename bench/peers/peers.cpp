// Compares our ray tracer and captures with Embree 3 and with simple prototypes. All of them run in
// turn in one process.
//   catoptric_peers [ROUNDS] [CASE...]
// ROUNDS is at least 6. Without CASE, all cases run. The exit code is 1 if results differ.
// The cases `built-in`, `100k`, `1M` and `room` compare pictures of these scenes. `built-in` also
// compares captures and prototypes. The cases `rays` and `trees` compare incoherent rays and trees.
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
using peers::PeerBench;

struct PeerCase {
    std::string name;
    std::function<bool(const PeerBench&)> compare;
};

std::vector<PeerCase> list_all_cases() {
    std::vector<PeerCase> cases{{"built-in", peers::compare_built_in_scene_pictures}};
    for (const peers::NamedScene& scene : peers::list_named_scenes().subspan(1))
        cases.push_back({scene.name, [&scene](const PeerBench& bench) {
                             return peers::compare_pictures(bench, scene);
                         }});
    cases.push_back({"rays", [](const PeerBench& bench) {
                         return std::ranges::count_if(peers::list_named_scenes(),
                                                      [&](const peers::NamedScene& scene) {
                                                          return !peers::compare_rays(bench, scene);
                                                      }) == 0;
                     }});
    cases.push_back({"trees", [](const PeerBench& bench) {
                         peers::compare_trees(bench);
                         return true;
                     }});
    return cases;
}

/// Returns the cases that the words name, or all cases if `words` is empty.
std::vector<PeerCase> choose_cases_by_words(const std::vector<std::string>& words) {
    const std::vector<PeerCase> all = list_all_cases();
    std::vector<PeerCase> chosen;
    for (const std::string& word : words) {
        const auto found = std::ranges::find(all, word, &PeerCase::name);
        std::string names;
        for (const PeerCase& one : all) names += " " + one.name;
        check(found != all.end(), Failure::usage, "no case '", word, "': there are", names);
        chosen.push_back(*found);
    }
    return words.empty() ? all : chosen;
}

/// Returns the number of rounds in the first word and removes this word. Returns 0 if the first
/// word is no number.
int parse_round_count(std::vector<std::string>& words) {
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
    const app::ProcessorUsageMeter meter(
        app::ProcessorUsageMeter::CountedThreadChoice::process); // created before other threads
                                                                 // start
    std::vector<std::string> words(argv + 1, argv + argc);
    const int rounds = std::max(static_cast<int>(measure::kMinIntervalSamples),
                                parse_round_count(words));
    const std::vector<PeerCase> cases = choose_cases_by_words(words);
    if (!meter.why_not_counted().empty())
        std::printf("cycles are not counted: %s\n", meter.why_not_counted().c_str());
    for (const gpu::EmbeddedShader& shader : peers::prototype_shaders()) gpu::add_shader(shader);
    const peers::EmbreeDevice device;
    app::Engine engine({});
    const int threads = std::max(1, engine.device().threads);
    std::printf(
        "%s, %s; Embree %s, packets of 16 %s; %d threads each\n", engine.device().name.c_str(),
        engine.device().driver.c_str(), RTC_VERSION_STRING,
        rtcGetDeviceProperty(device.embree_device(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED)
            ? "native"
            : "emulated",
        threads);
    const PeerBench bench{engine, meter, device, threads, rounds};
    bool same = true;
    for (const PeerCase& one : cases) same = one.compare(bench) && same;
    return same ? 0 : 1;
} catch (const std::exception& error) {
    std::fprintf(stderr, "catoptric_peers: %s\n", error.what());
    return 1;
}
