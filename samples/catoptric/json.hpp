#pragma once

#include "measure/comparison.hpp"
#include "measure/picture.hpp"
#include "session/run.hpp"
#include "session/scene_info.hpp"

#include <optional>
#include <string>
#include <vector>

/// The small JSON documents of the verbs. Each is complete and ends with a newline. A number that
/// is not finite becomes null. Bytes that are not UTF-8 (in a path) are replaced.
namespace catoptric::cli {

struct DiffFacts {
    std::string a, b, mask;
    uvec2 size{0, 0};
    double exposure = 0;
    std::string flip_source; ///< values that FLIP compares: "float" or "8-bit" (measure/flip.hpp)
    measure::Difference difference;
    measure::Mean a_mean, b_mean, a_clamped, b_clamped;
    std::vector<std::string> over; ///< quantities that exceed their threshold, in words
};
std::string diff_json(const DiffFacts& facts);

/// `first_frame`: number of the first measured frame in its sequence, from 1.
std::string render_json(const session::Request& request, int first_frame,
                        const session::DeviceInfo& device, const session::RunResult& result,
                        const std::string& output);

/// What a picture was made of: with this and the files of the scene, it can be made again.
struct PictureOrigin {
    std::string device, driver;
    std::string scene, scene_hash;
    std::string technique;       ///< as written for the row, such as "naive:bounces=1"
    std::string model;           ///< "everything" or "required"
    measure::CameraFacts camera; ///< world units
    double time = 0;             ///< seconds into the scene's motion
    std::uint64_t seed = 0;      ///< seed of irregular sample patterns
    double exposure = 0;         ///< stops at which the picture is shown; not part of its values
};
/// Returns the text for the header of an OpenEXR file, in one line, without a newline at its end:
/// schema "catoptric/picture/1". The same origin gives the same text.
std::string origin_json(const PictureOrigin& origin);

/// Returns the passes of one frame in Chrome's trace-event format (chrome://tracing, Perfetto).
std::string trace_json(const session::FrameTimes& frame, const std::string& process);

std::string devices_json(const std::vector<session::DeviceInfo>& devices);
std::string techniques_json(const std::vector<session::TechniqueInfo>& techniques);

struct NamedListEntry {
    std::string name, summary;
};
/// Returns {"schema": "catoptric/list/1", KIND: [{"name", "summary"}]}.
std::string named_json(const std::string& kind, const std::vector<NamedListEntry>& rows);

/// Returns the table of metrics: {"name", "summary", "unit", "mask", "better"}.
std::string metrics_json();

struct ProgramInfo {
    std::optional<session::DeviceInfo> device;
    int lanes = 0;       ///< lanes that run together in the device's shaders
    std::string balance; ///< session::describe_balance
    std::string why_no_device;
    /// Name of each group of features, and its features.
    std::vector<std::pair<std::string, std::vector<std::string>>> features;
};
std::string info_json(const ProgramInfo& facts);

/// Facts that `info SCENE` reports.
struct SceneInfoFacts {
    session::SceneInfo info;
    std::optional<double> exposure; ///< stops; none: unknown
    bool auto_exposure = false;
    double ambient = 0;
    std::string scene_file; ///< scene file that was read; empty: none
    std::vector<std::string> warnings;
};
std::string scene_json(const SceneInfoFacts& words);

} // namespace catoptric::cli
