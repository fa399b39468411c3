#pragma once

#include "measure/picture.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

// OpenEXR files with several pictures of one size.
namespace catoptric::measure {

/// A picture with the name of its layer, such as "A": channels A.R, A.G and A.B.
struct PictureLayer {
    std::string name;
    Picture picture;
};
struct LayeredFile {
    std::vector<PictureLayer> layers;
    std::string description; ///< text that the file holds beside its pixels
};

/// Writes an OpenEXR file of 32-bit floats, with each value bit-exact. The file is replaced as a
/// whole or not at all.
void write_layers(const LayeredFile& file, const std::filesystem::path& path);
/// Throws `missing_input` for a missing file, and `bad_data` for a file without these layers.
LayeredFile read_layers(const std::filesystem::path& path, std::span<const std::string> names);

} // namespace catoptric::measure
