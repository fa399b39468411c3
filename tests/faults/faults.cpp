#include "faults/faults.hpp"
#include "places.hpp"

#include <atomic>
#include <functional>
#include <sstream>
#include <thread>

#include <unistd.h>

namespace {

namespace fs = std::filesystem;

/// Compiled shaders, shared by all runs: without it compiling would be most of the time.
const fs::path& shader_cache() {
    static const struct Folder {
        Folder()
            : path(fs::temp_directory_path() /
                   ("catoptric-faults-cache-" + std::to_string(::getpid()))) {
            fs::create_directories(path);
        }
        ~Folder() {
            std::error_code ignored;
            fs::remove_all(path, ignored);
        }
        fs::path path;
    } folder;
    return folder.path;
}

} // namespace

std::string Watched::leaks() const {
    if (counts.empty()) return "no report of the layer: the program crashed";
    std::string text;
    for (const auto& [call, count] : counts)
        if (count.alive != 0)
            text += std::to_string(count.alive) + " of " + call + " never destroyed; ";
    if (strays != 0) text += std::to_string(strays) + " handles destroyed that were not alive";
    return text;
}

void Faults::SetUp() {
    static const Watched probe = watch({"list", "devices"}, std::nullopt);
    if (!probe.counts.empty()) return;
    FAIL() << "the loader did not load the layer of " << CATOPTRIC_FAULTS_LAYER << ": "
           << probe.ended.err;
}

Watched Faults::watch(const Words& words, const std::optional<Fault>& fault,
                      const std::string& place) const {
    test::Start process = start(words);
    process.folder = folder / place;
    const fs::path report = folder / (place == "." ? "calls.txt" : place + ".calls.txt");
    fs::remove(report);
    process.environment = {{"VK_ADD_LAYER_PATH", CATOPTRIC_FAULTS_LAYER},
                           {"VK_INSTANCE_LAYERS", "VK_LAYER_CATOPTRIC_faults"},
                           {"CATOPTRIC_FAULT_REPORT", report.string()},
                           {"MESA_SHADER_CACHE_DIR", shader_cache().string()}};
    if (fault)
        process.environment["CATOPTRIC_FAULT"] = fault->call + ":" + std::to_string(fault->at) +
                                                 ":" + std::to_string(fault->result);
    Watched watched{.ended = test::run_process(process)};
    std::istringstream lines(read_path(report));
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words_of(line);
        std::string call;
        words_of >> call;
        if (call == "strays") {
            words_of >> watched.strays;
        } else if (call == "most_bytes") {
            words_of >> watched.most_bytes;
        } else {
            Count& count = watched.counts[call];
            words_of >> count.calls >> count.alive;
        }
    }
    fs::remove(report);
    return watched;
}

void two_at_a_time(std::size_t count, const std::function<void(std::size_t)>& run) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i; (i = next++) < count;) run(i);
    };
    std::jthread other(work);
    work();
}
