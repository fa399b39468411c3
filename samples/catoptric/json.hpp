#pragma once

#include "app/run.hpp"
#include "app/scene_info.hpp"
#include "measure/difference.hpp"

#include <optional>
#include <string>
#include <vector>

/// The small JSON documents of the verbs, each whole with a newline at its end. A number that is
/// not finite is null; bytes that are not UTF-8 (in a path) are replaced.
namespace catoptric::cli {

struct DiffFacts {
    std::string a, b, mask;
    uvec2 size{0, 0};
    double exposure = 0;
    std::string flip_source; ///< see measure/flip.hpp
    measure::Difference difference;
    measure::Mean a_mean, b_mean, a_clamped, b_clamped;
    std::vector<std::string> over; ///< what is over its threshold, in words
};
std::string diff_json(const DiffFacts& facts);

std::string render_json(const app::Request& request, const app::DeviceInfo& device,
                        const app::Result& result, const std::string& output);

/// Chrome's trace-event format (chrome://tracing, Perfetto): the passes of one frame.
std::string trace_json(const app::FrameTimes& frame, const std::string& process);

std::string devices_json(const std::vector<app::DeviceInfo>& devices);
std::string techniques_json(const std::vector<app::TechniqueInfo>& techniques);

struct Named {
    std::string name, summary;
};
/// {"schema": "catoptric/list/1", KIND: [{"name", "summary"}]}
std::string named_json(const std::string& kind, const std::vector<Named>& rows);

/// The table of quantities: {"name", "summary", "unit", "mask", "better"}.
std::string metrics_json();

struct InfoFacts {
    std::optional<app::DeviceInfo> device;
    int lanes = 0; ///< of the device's shaders that run together
    std::string why_no_device;
    /// Name of a group and what is in it.
    std::vector<std::pair<std::string, std::vector<std::string>>> features;
};
std::string info_json(const InfoFacts& facts);

/// What `info SCENE` has to say.
struct SceneWords {
    app::SceneInfo info;
    std::optional<double> exposure; ///< stops; none: not known
    bool auto_exposure = false;
    double ambient = 0;
    std::string scene_file; ///< that was read; empty: none
    std::vector<std::string> warnings;
};
std::string scene_json(const SceneWords& words);

} // namespace catoptric::cli
