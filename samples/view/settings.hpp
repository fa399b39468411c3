#pragma once

#include "core/math.hpp"

#include <filesystem>
#include <string>

namespace catoptric::view {

/// What is kept from run to run.
struct Settings {
    uvec2 window{0, 0}; ///< as Window takes it; 0: never set
    bool shows_panels = true;
    bool flies = false;
    double speed = 1; ///< of motion
    int gain = 4;     ///< of differences
    bool operator==(const Settings&) const = default;
};

/// XDG_CONFIG_HOME/catoptric/view.json, or below HOME/.config; empty where neither is an absolute
/// path.
std::filesystem::path settings_file();
/// What a file says; what it does not say, or says wrongly, is as it is by default.
Settings settings_of(const std::string& text);
std::string text_of(const Settings& settings);
/// Of the file, where there is one that can be read.
Settings load_settings(const std::filesystem::path& file);
/// Makes folders that are missing. Throws as write_file.
void save_settings(const Settings& settings, const std::filesystem::path& file);

} // namespace catoptric::view
