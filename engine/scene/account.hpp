#pragma once

#include "core/error.hpp"
#include "scene/budget.hpp"

#include <cstdint>
#include <string_view>

/// Totals of the memory and work that a scene file asks for, each checked against its limit in
/// `SceneLoadBudget`.
namespace catoptric::scene {

/// Running sum of one quantity while a scene is loaded, and the largest sum that is allowed.
class BudgetLimitedSum {
public:
    /// `what`: the quantity that error messages name. `remedy`: end of the message, which names the
    /// option that raises the limit; may be empty.
    BudgetLimitedSum(std::string_view what, std::uint64_t budget, std::string_view remedy = {})
        : quantity_name_(what), remedy_(remedy), budget_(budget) {}

    /// Adds `amount`. Throws `bad_data`, with the parts of `place` first in the message, if the sum
    /// would exceed the budget.
    template <typename... Parts>
    void add_amount_within_budget(std::uint64_t amount, const Parts&... place) {
        check_amount_fits_budget(amount, place...);
        spent_ += amount;
    }
    /// Checks that another `amount` fits into the budget, without adding the amount. Throws as
    /// `add_amount_within_budget` does.
    template <typename... Parts>
    void check_amount_fits_budget(std::uint64_t amount, const Parts&... place) const {
        if (amount > budget_ - spent_)
            fail(Failure::bad_data, place..., ": wanted at most ", budget_, " ", quantity_name_,
                 ", the budget of a scene, found ", amount > ~spent_ ? ~0ull : spent_ + amount,
                 remedy_);
    }

private:
    std::string_view quantity_name_, remedy_;
    std::uint64_t budget_;
    std::uint64_t spent_ = 0; ///< at most `budget_`
};

/// The running sums of all quantities of one scene file that the budget limits.
struct SceneLoadBudgetUsage {
    explicit SceneLoadBudgetUsage(const SceneLoadBudget& of) : budget(of) {}

    const SceneLoadBudget budget;
    static constexpr std::string_view kMaxBytesHint = "; --max-bytes allows more",
                                      kMaxTrianglesHint = "; --max-triangles allows more";
    BudgetLimitedSum file_bytes{"bytes in its files", budget.file_bytes, kMaxBytesHint};
    BudgetLimitedSum files{"names of files", budget.files};
    BudgetLimitedSum json_bytes{"bytes of JSON", budget.json_bytes};
    BudgetLimitedSum json_memory{"bytes of memory for its JSON", budget.json_memory};
    BudgetLimitedSum positions{"positions", budget.vertices, kMaxTrianglesHint};
    BudgetLimitedSum normals{"normals", budget.vertices, kMaxTrianglesHint};
    BudgetLimitedSum attributes{"texture coordinates, colours and weights", 4 * budget.vertices};
    BudgetLimitedSum mesh_vertices{"vertices in meshes", budget.vertices, kMaxTrianglesHint};
    BudgetLimitedSum shown_vertices{"vertices shown by objects", budget.shown};
    BudgetLimitedSum mesh_triangles{"triangles in meshes", budget.triangles, kMaxTrianglesHint};
    BudgetLimitedSum shown_triangles{"triangles shown by objects", budget.shown};
    BudgetLimitedSum nodes{"nodes", budget.objects};
    BudgetLimitedSum meshes{"meshes", budget.objects};
    BudgetLimitedSum primitives{"primitives", budget.objects};
    BudgetLimitedSum materials{"materials", budget.objects};
    BudgetLimitedSum remarks{"objects named by comments", budget.objects};
    BudgetLimitedSum cameras{"cameras", budget.objects};
    BudgetLimitedSum channels{"animation channels", budget.objects};
    BudgetLimitedSum objects{"objects", budget.objects};
    BudgetLimitedSum keys{"keys of animations", budget.keys};
    BudgetLimitedSum key_times{"times of keys", budget.keys};
    BudgetLimitedSum key_values{"values of keys", 3 * budget.keys};
    BudgetLimitedSum name_bytes{"bytes of names", budget.name_bytes};
    BudgetLimitedSum texels{"texels in pictures", budget.texels};
    BudgetLimitedSum made_bytes{"bytes of sparse accessors", budget.made_bytes};
    /// The limit of decompressed geometry allows 64 bytes for each vertex, and the indices of all
    /// triangles.
    BudgetLimitedSum decoded_bytes{"bytes of decompressed geometry",
                                   64 * budget.vertices + 12 * budget.triangles, kMaxTrianglesHint};
    BudgetLimitedSum cuts{"comparisons to cut concave polygons", budget.cuts};
};

} // namespace catoptric::scene
