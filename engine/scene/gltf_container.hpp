#pragma once

#include "scene/files.hpp"
#include "scene/json.hpp"

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::scene::gltf {

/// What a .gltf or .glb holds: its JSON, of version 2 and with no required extension that we lack,
/// and the bytes of its buffers.
struct Container {
    Json document;
    std::vector<std::string_view> buffers;
    std::vector<std::shared_ptr<const std::string>> owners; ///< of the buffers' bytes
};

/// Throws `bad_data`, or `missing_input` for a buffer that is not there.
Container read_container(const std::string& file, Files& files, Account& account);

/// The name of a file that a URI stands for, percent-decoded once. Throws `bad_data` beginning with
/// `place` for a scheme, an absolute path, a backslash or a NUL.
std::string file_name_of(const std::string& uri, const std::string& place);

bool is_data_uri(std::string_view uri);
/// The bytes of a base64 data: URI. Throws `bad_data` beginning with `place` for any other.
std::string data_of(std::string_view uri, const std::string& place);

} // namespace catoptric::scene::gltf
