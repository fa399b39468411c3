#pragma once

#include "scene/budget.hpp"

#include <filesystem>
#include <optional>

namespace catoptric::scene {

/// Memory that a triangle takes while it is rendered, with three vertices of its own, in bytes
/// (measured: docs/extremes.md).
inline constexpr std::uint64_t kBytesPerTriangle = 800;

/// What the user allows, in place of what fits into memory.
struct BudgetOverride {
    std::optional<std::uint64_t> bytes;     ///< of all files of the scene
    std::optional<std::uint64_t> triangles; ///< in meshes, with up to three vertices each
};

/// Returns how much the scene in this file may ask for. Files may take an eighth of
/// `free_bytes`, triangles all of it. A file may have more triangles than `Budget` says only as
/// far as it stores them, in at least 6 bytes each: a small file that asks for much is refused
/// however much memory there is.
Budget budget_for(const std::filesystem::path& scene, const BudgetOverride& wish,
                  std::uint64_t free_bytes);

/// Bytes of memory that this process can still take without swapping, as Linux estimates it, and
/// within the limit of its address space.
std::uint64_t free_memory();

} // namespace catoptric::scene
