#pragma once

#include "core/error.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

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

/// Running sum of one quantity while a scene is loaded, and the largest sum that is allowed.
class LimitedSum {
public:
    /// `what`: the quantity that error messages name. `remedy`: end of the message, which names the
    /// option that raises the limit; may be empty.
    LimitedSum(std::string_view what, std::uint64_t budget, std::string_view remedy = {})
        : what_(what), remedy_(remedy), budget_(budget) {}

    /// Adds `amount`. Throws `bad_data`, with the parts of `place` first in the message, if the sum
    /// would exceed the budget.
    template <typename... Parts>
    void add(std::uint64_t amount, const Parts&... place) {
        check_fits(amount, place...);
        spent_ += amount;
    }
    /// Checks that another `amount` fits into the budget, without adding the amount. Throws as
    /// `add` does.
    template <typename... Parts>
    void check_fits(std::uint64_t amount, const Parts&... place) const {
        if (amount > budget_ - spent_)
            fail(Failure::bad_data, place..., ": wanted at most ", budget_, " ", what_,
                 ", the budget of a scene, found ", amount > ~spent_ ? ~0ull : spent_ + amount,
                 remedy_);
    }

private:
    std::string_view what_, remedy_;
    std::uint64_t budget_;
    std::uint64_t spent_ = 0; ///< at most `budget_`
};

/// The running sums of all quantities of one scene file that the budget limits.
struct LoadAccount {
    explicit LoadAccount(const LoadBudget& of) : budget(of) {}

    const LoadBudget budget;
    static constexpr std::string_view kMaxBytesHint = "; --max-bytes allows more",
                                      kMaxTrianglesHint = "; --max-triangles allows more";
    LimitedSum file_bytes{"bytes in its files", budget.file_bytes, kMaxBytesHint};
    LimitedSum files{"names of files", budget.files};
    LimitedSum json_bytes{"bytes of JSON", budget.json_bytes};
    LimitedSum json_memory{"bytes of memory for its JSON", budget.json_memory};
    LimitedSum positions{"positions", budget.vertices, kMaxTrianglesHint};
    LimitedSum normals{"normals", budget.vertices, kMaxTrianglesHint};
    LimitedSum attributes{"texture coordinates, colours and weights", 4 * budget.vertices};
    LimitedSum mesh_vertices{"vertices in meshes", budget.vertices, kMaxTrianglesHint};
    LimitedSum shown_vertices{"vertices shown by objects", budget.shown};
    LimitedSum mesh_triangles{"triangles in meshes", budget.triangles, kMaxTrianglesHint};
    LimitedSum shown_triangles{"triangles shown by objects", budget.shown};
    LimitedSum nodes{"nodes", budget.objects};
    LimitedSum meshes{"meshes", budget.objects};
    LimitedSum primitives{"primitives", budget.objects};
    LimitedSum materials{"materials", budget.objects};
    LimitedSum remarks{"objects named by comments", budget.objects};
    LimitedSum cameras{"cameras", budget.objects};
    LimitedSum channels{"animation channels", budget.objects};
    LimitedSum objects{"objects", budget.objects};
    LimitedSum keys{"keys of animations", budget.keys};
    LimitedSum key_times{"times of keys", budget.keys};
    LimitedSum key_values{"values of keys", 3 * budget.keys};
    LimitedSum name_bytes{"bytes of names", budget.name_bytes};
    LimitedSum texels{"texels in pictures", budget.texels};
    LimitedSum made_bytes{"bytes of sparse accessors", budget.made_bytes};
    /// The limit of decompressed geometry allows 64 bytes for each vertex, and the indices of all
    /// triangles.
    LimitedSum decoded_bytes{"bytes of decompressed geometry",
                             64 * budget.vertices + 12 * budget.triangles, kMaxTrianglesHint};
    LimitedSum cuts{"comparisons to cut concave polygons", budget.cuts};
};

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
