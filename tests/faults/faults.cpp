#include "faults/faults.hpp"
#include "places.hpp"

#include "core/error.hpp"

#include <atomic>
#include <cstdlib>
#include <sstream>
#include <thread>

#include <unistd.h>

namespace {

namespace fs = std::filesystem;

/// Returns the folder of the driver's shader cache, which all runs share. Without the cache,
/// compiling shaders would take most of the time.
const fs::path& shader_cache_folder() {
    static const struct Folder {
        Folder()
            : folder_path(fs::temp_directory_path() /
                          ("catoptric-faults-cache-" + std::to_string(::getpid()))) {
            fs::create_directories(folder_path);
        }
        ~Folder() {
            std::error_code ignored;
            fs::remove_all(folder_path, ignored);
        }
        fs::path folder_path;
    } folder;
    return folder.folder_path;
}

std::map<std::string, std::string> make_fault_layer_environment(const fs::path& report) {
    return {{"VK_ADD_LAYER_PATH", CATOPTRIC_FAULTS_LAYER},
            {"VK_INSTANCE_LAYERS", "VK_LAYER_CATOPTRIC_faults"},
            {"CATOPTRIC_FAULT_REPORT", report.string()},
            {"MESA_SHADER_CACHE_DIR", shader_cache_folder().string()}};
}

std::string describe_fault(const VulkanCallFault& fault) {
    return fault.call + ":" + std::to_string(fault.at) + ":" + std::to_string(fault.result);
}

void read_fault_layer_report(const std::string& report, WatchedRun& watched) {
    std::istringstream lines(report);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string call;
        words >> call;
        if (call == "strays") {
            words >> watched.strays;
        } else if (call == "untimely") {
            words >> watched.untimely;
        } else if (call == "loose_stamps") {
            words >> watched.loose_stamps;
        } else if (call == "most_bytes") {
            words >> watched.most_bytes;
        } else {
            CallCount& count = watched.counts[call];
            words >> count.calls >> count.alive;
        }
    }
}

} // namespace

std::string WatchedRun::describe_undestroyed_objects() const {
    if (counts.empty()) return "no report of the layer: the program crashed";
    std::string text;
    for (const auto& [call, count] : counts)
        if (count.alive != 0)
            text += std::to_string(count.alive) + " of " + call + " never destroyed; ";
    if (strays != 0) text += std::to_string(strays) + " handles destroyed that were not alive";
    if (untimely != 0) text += std::to_string(untimely) + " handles destroyed that may be in use";
    return text;
}

std::string WatchedRun::describe_objects_destroyed_after_loss() const {
    if (counts.empty()) return "no report of the layer";
    std::string text;
    for (const char* call : {"vkCreateInstance", "vkCreateDevice"})
        if (counts.at(call).alive != 1) text += std::string(call) + "'s was destroyed; ";
    if (untimely != 0) text += std::to_string(untimely) + " handles destroyed that may be in use; ";
    if (strays != 0) text += std::to_string(strays) + " handles destroyed that were not alive";
    return text;
}

void Faults::SetUp() {
    static const WatchedRun probe = run_with_fault_layer({"list", "devices"}, std::nullopt);
    if (!probe.counts.empty()) return;
    FAIL() << "the loader did not load the layer of " << CATOPTRIC_FAULTS_LAYER << ": "
           << probe.ended.err;
}

WatchedRun Faults::run_with_fault_layer(const Words& words,
                                        const std::optional<VulkanCallFault>& fault,
                                        const std::string& place) const {
    test::ProcessStartOptions process = make_process_start(words);
    process.folder = folder / place;
    const fs::path report = folder / (place == "." ? "calls.txt" : place + ".calls.txt");
    fs::remove(report);
    process.environment = make_fault_layer_environment(report);
    if (fault) process.environment["CATOPTRIC_FAULT"] = describe_fault(*fault);
    WatchedRun watched{.ended = test::run_process(process)};
    read_fault_layer_report(read_file_at_path(report), watched);
    fs::remove(report);
    return watched;
}

FaultLayerInThisProcess::FaultLayerInThisProcess(fs::path report) : report_(std::move(report)) {
    for (const auto& [name, value] : make_fault_layer_environment(report_))
        ::setenv(name.c_str(), value.c_str(), 1);
}

WatchedRun
FaultLayerInThisProcess::run(const std::optional<VulkanCallFault>& fault,
                             const std::function<void(catoptric::session::Engine&)>& work) {
    fs::remove(report_);
    if (fault)
        ::setenv("CATOPTRIC_FAULT", describe_fault(*fault).c_str(), 1);
    else
        ::unsetenv("CATOPTRIC_FAULT");
    WatchedRun watched{.ended = {.exit_code = 0}};
    try {
        catoptric::session::Engine engine({});
        work(engine);
    } catch (const catoptric::Error& error) {
        watched.ended.exit_code = static_cast<int>(error.failure);
        watched.ended.err = error.what();
    }
    std::ifstream file(report_);
    read_fault_layer_report({std::istreambuf_iterator<char>(file), {}}, watched);
    return watched;
}

void run_on_two_threads(std::size_t count, const std::function<void(std::size_t)>& run) {
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
        for (std::size_t i; (i = next++) < count;) run(i);
    };
    std::jthread other(work);
    work();
}
