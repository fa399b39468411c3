#pragma once

#include "app/engine.hpp"
#include "gpu/variants.hpp"
#include "measure/tuning.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Device profiles: what a device's shaders are to be (gpu/variants.hpp), as it was measured, in a
/// small JSON file for each device and driver.
namespace catoptric::app {

/// The file's name for this device and driver: "10de-2330-NVIDIA-550.54.json".
std::string profile_name(const DeviceInfo& device);

/// A profile's text. `tried`: in the table's order; those taken are chosen.
std::string profile_text(const DeviceInfo& device, const std::vector<measure::Tried>& tried);
/// The choices of the text, which lies in `file`. Throws `bad_data` for what is no profile or is
/// another device's or driver's.
gpu::Choices read_profile(const std::string& text, const std::string& file,
                          const DeviceInfo& device);

/// Each variant with its choice, by name.
Variants variants_of(const gpu::Choices& choices);
/// The other way round; what is not named is as by default. Throws `usage` for unknown names.
gpu::Choices choices_of(const Variants& variants, const DeviceInfo& device);
/// What holds without a profile: work groups scattered on a processor, in order on any other
/// device; all else the first of its choices.
gpu::Choices default_choices(const DeviceInfo& device);

/// What holds for the device by the options, said in `device` too: its variants, the profile, or
/// why that is not used. Throws `bad_data`, `missing_input` for a profile that they name.
gpu::Choices choose(const EngineOptions& options, DeviceInfo& device);

} // namespace catoptric::app
