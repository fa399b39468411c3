#pragma once

#include "gpu/variants.hpp"
#include "measure/tuning.hpp"
#include "session/engine.hpp"

#include <filesystem>
#include <string>
#include <vector>

/// Device profiles: measured choices of shader variants (gpu/variants.hpp), in a small JSON file
/// per device and driver.
namespace catoptric::session {

/// Returns the file name of the profile for this device and driver: "10de-2330-NVIDIA-550.54.json".
std::string profile_file_name(const DeviceInfo& device);

/// Returns the text of a profile. `tried`: measured variants in the table's order; the profile
/// chooses those that are taken.
std::string profile_text(const DeviceInfo& device, const std::vector<measure::VariantTrial>& tried);
/// Reads the choices from the text of `file`. Throws `bad_data` if the text is no profile, or
/// belongs to another device or driver.
gpu::VariantChoices parse_profile(const std::string& text, const std::string& file,
                                  const DeviceInfo& device);

/// Returns each variant with its choice, by name.
NamedVariants named_variants(const gpu::VariantChoices& choices);
/// Returns the choices of named variants. Variants that are not named have their defaults. Throws
/// `usage` for unknown names.
gpu::VariantChoices parse_variants(const NamedVariants& variants, const DeviceInfo& device);
/// Returns the choices without a profile. Work groups are scattered on a processor and in order on
/// any other device. Each other variant has its first choice.
gpu::VariantChoices default_variants(const DeviceInfo& device);

/// Returns the choices for the device by the options. Writes the variants, and the profile or why
/// it is not used, to `device`. Throws `bad_data` and `missing_input` for a profile that the
/// options name.
gpu::VariantChoices choose_variants(const EngineOptions& options, DeviceInfo& device);

} // namespace catoptric::session
