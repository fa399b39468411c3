#pragma once

#include "core/byte_source.hpp"
#include "core/image_codec.hpp"

#include <optional>
#include <string>

namespace catoptric {

/// Returns the shape that the header of a picture claims. Reads a few kilobytes of the file and
/// uses no library. Returns none for a format whose header is left to its decoder (png). `name`
/// begins every message.
/// Throws `bad_data` for a header that cannot be read, or that claims more than a file of this size
/// can hold. An OpenEXR file has at least 16 bytes per chunk, and all values if they are not
/// compressed. A Radiance file has 8 bytes per 127 pixels of a line. A TIFF file has all bytes of
/// its pixels, or 1/4096 of them with lossless compression.
std::optional<ImageShape> read_image_header(const ByteSource& bytes, const std::string& format,
                                            const std::string& name);

/// Returns the shape of an OpenEXR picture: the channels and data window of its first part. Throws
/// `bad_data` for attributes, chunk tables, previews and tiles larger than the file, because
/// OpenEXR allocates memory for them before it reads them.
ImageShape read_openexr_header(const ByteSource& bytes, const std::string& name);

} // namespace catoptric
