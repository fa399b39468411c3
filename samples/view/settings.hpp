#pragma once

#include "core/math.hpp"

#include <filesystem>
#include <string>

namespace catoptric::view {

/// Settings that are kept from run to run.
struct ViewerSettings {
    uvec2 window{0, 0}; ///< in desktop units, as ViewWindow takes it; 0: never set
    bool shows_panels = true;
    bool flies = false;
    double speed = 1; ///< speed factor of motion
    int gain = 4;     ///< factor on differences
    bool operator==(const ViewerSettings&) const = default;
};

/// Returns the file of the settings: XDG_CONFIG_HOME/catoptric/view.json, or the same below
/// HOME/.config. Empty if neither is an absolute path.
std::filesystem::path settings_file();
/// Returns the settings in a file's text. Missing or invalid values get their defaults.
ViewerSettings parse_settings(const std::string& text);
std::string serialise_settings(const ViewerSettings& settings);
/// Returns the settings in the file, or defaults if the file cannot be read.
ViewerSettings load_settings(const std::filesystem::path& file);
/// Makes missing folders. Throws as write_file does.
void save_settings(const ViewerSettings& settings, const std::filesystem::path& file);

} // namespace catoptric::view
