#pragma once

#include <cstdint>

namespace catoptric::scene {

/// How much a scene file may ask for. A loader adds up what the file claims and stops before it
/// allocates or works for more: `bad_data` naming the place, the total, the budget and what was
/// found. Within it a load with a small picture of it is to take at most 1 GiB of memory and 10 s,
/// whatever the file says (measured: docs/extremes.md). A million triangles that share no normal
/// fit. Nothing here limits scenes made in code.
struct Budget {
    std::uint64_t file_bytes = 256 << 20;  ///< of all files of the scene, each counted once
    std::uint64_t files = 4'000;           ///< names of files, read or not
    std::uint64_t json_bytes = 64 << 20;   ///< of glTF's JSON, without a GLB's binary chunk
    std::uint64_t json_memory = 448 << 20; ///< its values, and what tinygltf makes of them
    /// Listed in the file (positions, normals), and kept in meshes (with those that missing normals
    /// add): each of these.
    std::uint64_t vertices = 4'000'000;
    std::uint64_t triangles = 2'000'000; ///< in meshes
    std::uint64_t shown = 200'000'000;   ///< vertices, and triangles, as often as objects show them
    /// Nodes, meshes, primitives, materials, cameras, animation channels, objects: each of these.
    std::uint64_t objects = 125'000;
    std::uint64_t keys = 1'000'000;       ///< of animations, each sampler once
    std::uint64_t name_bytes = 64 << 20;  ///< of the names of meshes and objects
    std::uint64_t texels = 64 << 20;      ///< of pictures that materials show, each once
    std::uint64_t made_bytes = 128 << 20; ///< of sparse accessors, and of those without a view
    std::uint64_t cuts = 100'000'000;     ///< comparisons that cut concave polygons of an .obj
};

} // namespace catoptric::scene
