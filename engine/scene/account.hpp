#pragma once

#include "core/error.hpp"
#include "scene/budget.hpp"

#include <cstdint>
#include <string_view>

/// Totals of the memory and work that a scene file asks for, each checked against its limit in
/// `LoadBudget`.
namespace catoptric::scene {

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

} // namespace catoptric::scene
