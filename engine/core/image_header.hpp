#pragma once

#include "core/byte_source.hpp"
#include "core/image_codec.hpp"

#include <optional>
#include <string>

namespace catoptric {

/// Returns what the header of a picture claims, from a few kilobytes of the file and without a
/// library; none for a format whose header is left to its decoder (png). `name` begins every
/// message. Throws `bad_data` for a header that cannot be read, and for one that claims more than a
/// file of this size can hold: an OpenEXR file has at least 16 bytes for each of its chunks and all
/// values where they are not compressed, a Radiance file 8 bytes for each 127 pixels of a line, a
/// TIFF file all bytes of its pixels, or 1/4096 of them where they are compressed without loss.
std::optional<ImageShape> header_of(const ByteSource& bytes, const std::string& format,
                                    const std::string& name);

/// The same of OpenEXR: the first part's channels and data window. Refuses attributes, tables of
/// chunks, previews and tiles that are larger than the file, for which OpenEXR allocates memory
/// before it reads them.
ImageShape openexr_header(const ByteSource& bytes, const std::string& name);

} // namespace catoptric
