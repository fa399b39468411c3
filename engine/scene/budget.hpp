#pragma once

#include "core/error.hpp"

#include <cstdint>
#include <string_view>

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
    /// Listed in the file (positions, normals), kept in meshes (with those that missing normals
    /// add), and shown by objects: each of these.
    std::uint64_t vertices = 4'000'000;
    /// In meshes, and shown by objects: each of these.
    std::uint64_t triangles = 2'000'000;
    /// Nodes, meshes, primitives, materials, cameras, animation channels, objects: each of these.
    std::uint64_t objects = 125'000;
    std::uint64_t keys = 1'000'000;       ///< of animations, each sampler once
    std::uint64_t name_bytes = 64 << 20;  ///< of the names of meshes and objects
    std::uint64_t texels = 64 << 20;      ///< of pictures that materials show, each once
    std::uint64_t made_bytes = 128 << 20; ///< of sparse accessors, and of those without a view
    std::uint64_t cuts = 100'000'000;     ///< comparisons that cut concave polygons of an .obj
};

/// One of the totals while a file is loaded.
class Total {
public:
    Total(std::string_view what, std::uint64_t budget) : what_(what), budget_(budget) {}

    /// Throws `bad_data` with the parts of `place` when the sum would go over the budget.
    template <typename... Parts>
    void add(std::uint64_t amount, const Parts&... place) {
        if (amount > budget_ - spent_)
            fail(Failure::bad_data, place..., ": wanted at most ", budget_, " ", what_,
                 ", the budget of a scene, found ", amount > ~spent_ ? ~0ull : spent_ + amount);
        spent_ += amount;
    }

private:
    std::string_view what_;
    std::uint64_t budget_;
    std::uint64_t spent_ = 0; ///< at most `budget_`
};

/// All of them.
struct Account {
    explicit Account(const Budget& of) : budget(of) {}

    const Budget budget;
    Total file_bytes{"bytes in its files", budget.file_bytes};
    Total files{"names of files", budget.files};
    Total json_bytes{"bytes of JSON", budget.json_bytes};
    Total json_memory{"bytes of memory for its JSON", budget.json_memory};
    Total positions{"positions", budget.vertices};
    Total normals{"normals", budget.vertices};
    Total attributes{"texture coordinates, colours and weights", 4 * budget.vertices};
    Total mesh_vertices{"vertices in meshes", budget.vertices};
    Total shown_vertices{"vertices shown by objects", budget.vertices};
    Total mesh_triangles{"triangles in meshes", budget.triangles};
    Total shown_triangles{"triangles shown by objects", budget.triangles};
    Total nodes{"nodes", budget.objects};
    Total meshes{"meshes", budget.objects};
    Total primitives{"primitives", budget.objects};
    Total materials{"materials", budget.objects};
    Total remarks{"objects named by comments", budget.objects};
    Total cameras{"cameras", budget.objects};
    Total channels{"animation channels", budget.objects};
    Total objects{"objects", budget.objects};
    Total keys{"keys of animations", budget.keys};
    Total key_times{"times of keys", budget.keys};
    Total key_values{"values of keys", 3 * budget.keys};
    Total name_bytes{"bytes of names", budget.name_bytes};
    Total texels{"texels in pictures", budget.texels};
    Total made_bytes{"bytes of sparse accessors", budget.made_bytes};
    Total cuts{"comparisons to cut concave polygons", budget.cuts};
};

} // namespace catoptric::scene
