#pragma once

#include "import/files.hpp"
#include "import/json.hpp"
#include "scene/notes.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::scene::gltf {

using ByteList = std::vector<unsigned char>;

inline constexpr std::string_view kMeshoptExtension = "EXT_meshopt_compression";

/// A buffer of a glTF file: the first `length` bytes, at least 1, of one of the container's files.
struct GltfBuffer {
    std::size_t file = 0; ///< index into `Container::files`
    std::uint64_t length = 0;
};

/// The contents of a .gltf or .glb file: its JSON and the bytes of its buffers. The JSON has
/// version 2 and requires no extension that we lack.
struct Container {
    Json document;
    std::vector<GltfBuffer> buffers;
    /// The bytes of buffer files, data URIs and a GLB's binary chunk. A file that several buffers
    /// use is stored once.
    std::vector<ByteList> files;
};

/// Reads a .gltf or .glb and the files of its buffers. Throws `bad_data`, or `missing_input` for a
/// missing buffer file.
Container read_container(const std::string& file, FileOpener& files, LoadAccount& account,
                         LoaderNotes& notes);

/// Gives each accessor that is sparse, or has no view, a new view with its dense elements. Other
/// views and files of the container stay as they are. The document must have been checked. Throws
/// `bad_data` for a sparse index beyond the accessor, or for more bytes than the budget. Defined in
/// gltf_accessor.cpp.
void expand_sparse(Container& container, const std::string& file, LoadAccount& account);
/// Decodes buffer views with EXT_meshopt_compression and primitives with
/// KHR_draco_mesh_compression. They then name new buffers, views and accessors, and lose these
/// extensions. The types of the document's members must have been checked, but not the bounds of
/// views. Throws `bad_data` for bytes that do not decode, or for more than the budget. Defined in
/// gltf_compressed.cpp.
void decode_geometry(Container& container, const std::string& file, LoadAccount& account);
/// Gives each node with EXT_mesh_gpu_instancing a child node for each instance. Each child has the
/// node's mesh, and the node itself loses its mesh and the extension. Accessors must be dense and
/// checked. Throws `bad_data`. Defined in gltf_instances.cpp.
void expand_instances(Container& container, const std::string& file, LoadAccount& account,
                      LoaderNotes& notes);
/// Returns the size in bytes of one element of a checked accessor.
std::size_t element_bytes(const JsonObject& accessor);

/// Returns the file name that a URI stands for, percent-decoded once. Throws `bad_data` beginning
/// with `place` for a scheme, an absolute path, a backslash, a NUL or an empty name.
std::string name_from_uri(const std::string& uri, const std::string& place);

bool is_data_uri(std::string_view uri);
/// Returns the bytes of a base64 `data:` URI. Throws `bad_data` beginning with `place` for any
/// other URI.
ByteList decode_data_uri(std::string_view uri, const std::string& place);

} // namespace catoptric::scene::gltf
