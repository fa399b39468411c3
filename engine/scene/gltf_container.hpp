#pragma once

#include "scene/files.hpp"
#include "scene/json.hpp"
#include "scene/notes.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::scene::gltf {

using Bytes = std::vector<unsigned char>;

/// Of one of the container's files the first `length` bytes, at least 1.
struct Buffer {
    std::size_t file = 0;
    std::uint64_t length = 0;
};

/// What a .gltf or .glb holds: its JSON, of version 2 and with no required extension that we lack,
/// and the bytes of its buffers.
struct Container {
    Json document;
    std::vector<Buffer> buffers;
    std::vector<Bytes> files; ///< each once, however many buffers lie in it; data URIs too
};

/// Throws `bad_data`, or `missing_input` for a buffer that is not there.
Container read_container(const std::string& file, Files& files, Account& account, Notes& notes);

/// gltf_sparse.cpp: gives each accessor that is sparse, or has no view, a view of what it stands
/// for, of a checked document; what was around it stays. Throws `bad_data` for a place beyond it,
/// or for more bytes than the budget.
void expand_sparse(Container& container, const std::string& file, Account& account);
/// Bytes of one element of an accessor that has been checked.
std::size_t element_bytes(const Item& accessor);

/// The name of a file that a URI stands for, percent-decoded once. Throws `bad_data` beginning with
/// `place` for a scheme, an absolute path, a backslash or a NUL.
std::string file_name_of(const std::string& uri, const std::string& place);

bool is_data_uri(std::string_view uri);
/// The bytes of a base64 data: URI. Throws `bad_data` beginning with `place` for any other.
Bytes data_of(std::string_view uri, const std::string& place);

} // namespace catoptric::scene::gltf
