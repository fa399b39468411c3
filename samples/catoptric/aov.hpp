#pragma once

#include "measure/picture_file.hpp"
#include "session/first_surface.hpp"

#include <optional>
#include <string>
#include <vector>

// Layers of an EXR picture beside its colours (arbitrary output variables), for `render --aov`.
namespace catoptric::cli {

enum class PictureAov { distance, normal, object, mirror, tier, roughness };

/// Returns the layers of a list such as "distance,normal", or of "all", each once and in the order
/// of PictureAov. Throws `usage` for another name.
std::vector<PictureAov> parse_aovs(const std::string& text);

/// Returns a line for the help about each layer, with its channels.
std::string describe_aovs();

/// `tiers`: set if `aovs` has PictureAov::tier.
std::vector<measure::ExtraChannel>
aov_channels(const std::vector<PictureAov>& aovs, const session::FirstSurfaces& surfaces,
             const std::optional<session::ReflectionTiers>& tiers);

} // namespace catoptric::cli
