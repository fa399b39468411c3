#pragma once

#include <string>
#include <string_view>

namespace catoptric::gpu {

/// Returns the bytes of a cache file with `data`: signature, checksum, data.
std::string add_header(std::string_view signature, std::string_view data);

/// Returns the data of a cache file; empty if the file has another signature or is not complete.
std::string strip_header(std::string_view signature, std::string_view file);

} // namespace catoptric::gpu
