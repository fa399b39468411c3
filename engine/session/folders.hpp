#pragma once

#include <filesystem>

// Folders of the user in which programs of this tree keep files.
namespace catoptric::session {

/// Returns XDG_CACHE_HOME/catoptric, or HOME/.cache/catoptric; empty if neither is an absolute
/// path.
std::filesystem::path find_cache_folder();
/// Returns XDG_CONFIG_HOME/catoptric, or HOME/.config/catoptric; empty if neither is an absolute
/// path.
std::filesystem::path find_config_folder();
/// Returns XDG_CONFIG_HOME/catoptric/devices, or HOME/.config/catoptric/devices; empty if neither
/// is an absolute path.
std::filesystem::path find_profile_folder();
/// Returns XDG_CONFIG_HOME/catoptric/costs, or HOME/.config/catoptric/costs; empty if neither is an
/// absolute path.
std::filesystem::path find_calibration_folder();

} // namespace catoptric::session
