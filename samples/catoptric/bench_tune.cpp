// Measures which shader settings suit the device, and writes them to its profile.
#include "bench_tune.hpp"

#include "bench_table.hpp"
#include "compare.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/text.hpp"
#include "places.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "session/folders.hpp"
#include "session/profile.hpp"
#include "study/asked.hpp"
#include "table.hpp"

#include <fmt/format.h>

namespace catoptric::cli {

namespace fs = std::filesystem;

namespace {

/// Returns the path of the profile. Checks before the measurement that the file can be written.
fs::path place_of(const std::string& output, const app::DeviceInfo& device,
                  const std::vector<fs::path>& inputs) {
    fs::path place = output;
    if (output.empty()) {
        const fs::path folder = app::profile_folder();
        check(!folder.empty(), Failure::cannot_create,
              "no folder for the device's profile: wanted XDG_CONFIG_HOME or HOME to be an "
              "absolute path; -o FILE writes it elsewhere");
        report::create_folder(folder); // fail before the measurement
        place = folder / app::profile_name(device);
    } else {
        check_file_can_be_made(place);
    }
    check_apart({kStdout, place}, inputs);
    return place;
}

} // namespace

std::string tuned_table(const app::DeviceInfo& device, const std::vector<measure::Tried>& tried) {
    std::vector<std::vector<std::string>> cells{
        {"variant", "choice", "default", "ratio", "[95 %]", ""}};
    for (const measure::Tried& one : tried) {
        const measure::Ratio ratio = one.ratio();
        cells.push_back({one.variant, one.choice, one.standard, fmt::format("{:.3f}", ratio.median),
                         interval_text(ratio.ci95), one.is_taken() ? "taken" : "not taken"});
    }
    return fmt::format("{}, {}; {}, {} rounds; device time over the default's\n", device.name,
                       device.driver, printable(tried.front().benchmark), tried.front().ms.size()) +
           aligned(cells, 5);
}

int tune_device(const Common& common, int rounds, const std::string& output) {
    app::check_rounds(rounds);
    check(common.device.profile.empty(), Failure::usage,
          "--tune and --device-profile: wanted one of them, found both");
    app::Request request = make_request(common);
    request.techniques = {app::kTunedTechnique};
    app::EngineOptions opened = engine_options(common.device);
    opened.profiles.clear(); // tuning starts from the defaults
    app::Engine engine(opened);
    introduce(engine, common.manners);
    const app::DeviceInfo& device = engine.device();
    const fs::path place = place_of(output, device, request.scene.files);

    Progress progress(common.manners);
    const app::Tuned tuned = app::tune(
        engine, request,
        {.iterations = request.frames, .rounds = rounds, .watcher = watcher_of(progress)});
    progress.clear();
    if (tuned.noisy)
        warn("others were at work beside what was measured; what is taken may be their doing");
    const std::string text = app::profile_text(device, tuned.tried);
    put(common.manners.json ? text : tuned_table(device, tuned.tried));
    write_file(place, text);
    note(common.manners, "written: " + place.string());
    if (common.device.validate) engine.check_validation();
    return 0;
}

} // namespace catoptric::cli
