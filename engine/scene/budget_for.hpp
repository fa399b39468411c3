#pragma once

#include "scene/budget.hpp"

#include <filesystem>
#include <optional>

namespace catoptric::scene {

/// Memory that rendering takes for a triangle with three vertices of its own, in bytes (measured:
/// docs/extremes.md).
inline constexpr std::uint64_t kRenderBytesPerTriangle = 800;

/// Limits that the user set by options. These limits replace those computed from the free memory.
struct BudgetOverride {
    std::optional<std::uint64_t> bytes;     ///< bytes of all files of the scene
    std::optional<std::uint64_t> triangles; ///< triangles in meshes, with up to three vertices each
};

/// Returns the budget for loading the scene file `scene`. Files may take an eighth of `free_bytes`,
/// triangles all of it. Computed limits are never below the defaults of `LoadBudget`. A file
/// may exceed `LoadBudget::triangles` only if it stores at least 6 bytes per triangle. A small
/// file that asks for many triangles is therefore refused, however much memory is free.
LoadBudget choose_budget(const std::filesystem::path& scene, const BudgetOverride& wish,
                         std::uint64_t free_bytes);

/// Returns the memory that this process can still take without swapping, in bytes. The result is
/// Linux's estimate, and at most the process's limit of the address space.
std::uint64_t read_free_memory();

} // namespace catoptric::scene
