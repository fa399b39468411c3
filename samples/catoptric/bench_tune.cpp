// Measures which shader settings are fastest on the device, and writes them to the device's
// profile.
#include "bench_tune.hpp"

#include "bench_table.hpp"
#include "compare.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/text.hpp"
#include "output_checks.hpp"
#include "progress.hpp"
#include "session/folders.hpp"
#include "session/profile.hpp"
#include "study/compare_checks.hpp"
#include "table.hpp"

#include <fmt/format.h>

namespace catoptric::cli {

namespace fs = std::filesystem;

std::string tuning_table(const session::DeviceInfo& device,
                         const std::vector<measure::VariantTrial>& tried) {
    std::vector<std::vector<std::string>> cells{
        {"variant", "choice", "default", "ratio", "[95 %]", ""}};
    for (const measure::VariantTrial& one : tried) {
        const measure::CostRatio ratio = one.time_ratio();
        cells.push_back({one.variant, one.choice, one.standard, fmt::format("{:.3f}", ratio.median),
                         format_interval(ratio.ci95), one.is_faster() ? "taken" : "not taken"});
    }
    return fmt::format("{}, {}; {}, {} rounds; device time over the default's\n", device.name,
                       device.driver, escape(tried.front().benchmark), tried.front().ms.size()) +
           align_columns(cells, 5);
}

int tune_device(const CommonOptions& common, int rounds, const std::string& output) {
    study::check_round_limit(rounds);
    check(common.device.profile.empty(), Failure::usage,
          "--tune and --device-profile: wanted one of them, found both");
    session::Request request = make_request(common);
    request.techniques = {benchmark::kTuningTechnique};
    session::EngineOptions opened = engine_options(common.device);
    opened.profiles.clear(); // tuning starts from the defaults
    session::Engine engine(opened);
    print_device(engine, common.output_options);
    const session::DeviceInfo& device = engine.device();
    const fs::path place = choose_device_file(output, session::find_profile_folder(), "profile",
                                              device);
    check_distinct({kStdoutPath, place}, request.scene.files);

    ProgressPrinter progress(common.output_options);
    const benchmark::TuningResult tuned = benchmark::tune_shaders(
        engine, request,
        {.iterations = request.frames, .rounds = rounds, .watcher = make_watcher(progress)});
    progress.clear();
    if (tuned.noisy)
        print_warning(
            "others were at work beside what was measured; what is taken may be their doing");
    const std::string text = session::profile_text(device, tuned.tried);
    print_result(common.output_options.json ? text : tuning_table(device, tuned.tried));
    write_file(place, text);
    print_note(common.output_options, "written: " + place.string());
    if (common.device.validate) engine.check_validation();
    return 0;
}

} // namespace catoptric::cli
