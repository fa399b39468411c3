#pragma once

#include <cstdint>

namespace catoptric::scene {

/// Limits on the memory and work that one scene file may ask for. A loader adds up what the file
/// claims and stops before it allocates or works for more. The error is `bad_data` and names the
/// place, the total, the budget and the amount found. Within these limits, loading a scene and
/// rendering a small picture of it should take at most 1 GiB of memory and 10 s (measured:
/// docs/extremes.md). A million triangles that share no normal fit. Scenes built in code have no
/// limits.
struct LoadBudget {
    std::uint64_t file_bytes = 256 << 20; ///< bytes of all files of the scene, each counted once
    std::uint64_t files = 4'000; ///< file names in the scene, whether the files are read or not
    std::uint64_t json_bytes = 64 << 20; ///< bytes of glTF JSON, without the binary chunk of a GLB
    std::uint64_t json_memory = 448 << 20; ///< memory for JSON values and tinygltf's copies
    /// Limit for each of these: positions in the file, normals in the file, and vertices kept in
    /// meshes. The last includes the vertices added for missing normals.
    std::uint64_t vertices = 4'000'000;
    std::uint64_t triangles = 2'000'000; ///< triangles in meshes
    /// Limit for vertices and for triangles, counted once for each object that shows them.
    std::uint64_t shown = 200'000'000;
    /// Limit for each of these: nodes, meshes, primitives, materials, cameras, animation channels,
    /// objects.
    std::uint64_t objects = 125'000;
    std::uint64_t keys = 1'000'000;       ///< keys of animations; each sampler counts once
    std::uint64_t name_bytes = 64 << 20;  ///< bytes of the names of meshes and objects
    std::uint64_t texels = 64 << 20;      ///< texels of textures; each picture counts once
    std::uint64_t made_bytes = 128 << 20; ///< made for accessors that are sparse or have no view
    std::uint64_t cuts = 100'000'000;     ///< comparisons to cut concave polygons of an .obj file
};

} // namespace catoptric::scene
