#include "render/limits.hpp"

#include "bvh/bvh.hpp"
#include "core/error.hpp"
#include "render/object_space.hpp"
#include "shared.h"

#include <limits>

namespace catoptric::render {

namespace {

constexpr std::uint64_t kBytesPerStorageTexel = 16, kTexelsPerTriangle = 3, kTexelsPerNode = 4;

} // namespace

SceneAmounts count_amounts(const scene::Scene& scene) {
    SceneAmounts amounts;
    const std::vector<bool> shared = find_sharing_objects(scene);
    // For each mesh, whether its vertices were counted. Copies of a mesh share vertices, which
    // count once.
    std::vector<bool> stored(scene.meshes.size());
    for (std::size_t i = 0; i < scene.objects.size(); ++i) {
        const scene::Object& object = scene.objects[i];
        const scene::Mesh& mesh = scene.meshes[object.mesh];
        amounts.mirrors += scene::is_mirror(scene, object) ? 1 : 0;
        if (shared[i] && stored[object.mesh]) continue;
        if (shared[i]) stored[object.mesh] = true;
        amounts.vertices += mesh.positions.size();
        amounts.triangles += mesh.triangles.size();
    }
    amounts.objects = scene.objects.size();
    if (scene.environment) amounts.environment_texels = scene.environment->texels.size();
    return amounts;
}

void check_limits(const std::string& scene, const SceneAmounts& amounts,
                  const GeometryLimits& limits) {
    const auto within = [&](std::uint64_t wanted, std::uint64_t allowed, const char* what) {
        check(wanted <= allowed, Failure::exhausted, "scene '", scene, "' wants ", wanted, " ",
              what, ", the device allows ", allowed);
    };
    const std::uint64_t vertex_bytes = amounts.vertices * sizeof(shared::Vertex),
                        index_bytes = 3 * amounts.triangles * sizeof(std::uint32_t),
                        texels = kTexelsPerTriangle * amounts.triangles,
                        node_texels = kTexelsPerNode * (amounts.triangles / bvh::kMaxLeafTriangles);
    check(amounts.mirrors <= shared::kMaxMirrors, Failure::exhausted, "scene '", scene, "' has ",
          amounts.mirrors, " mirrors, ", shared::kMaxMirrors, " are allowed");
    within(amounts.vertices, std::numeric_limits<std::uint32_t>::max(), "vertices");
    within(3 * amounts.triangles, std::numeric_limits<std::uint32_t>::max(), "indices");
    within(texels, limits.texels, "texels of triangles");
    within(amounts.environment_texels, limits.texels, "texels of the environment");
    within(amounts.objects * shared::kTexelsPerSurface, limits.texels, "texels of surfaces");
    within(amounts.mirrors * shared::kTexelsPerProbe, limits.texels, "texels of mirrors");
    within((1 + 6 * amounts.mirrors) * sizeof(shared::View), limits.storage_bytes,
           "bytes of views");
    within(vertex_bytes, limits.piece_bytes, "bytes of vertices");
    within(index_bytes, limits.piece_bytes, "bytes of indices");
    // The bytes of triangles, of their normals and of the tree's nodes are added.
    within(vertex_bytes + index_bytes + (2 * texels + node_texels) * kBytesPerStorageTexel,
           limits.memory_bytes, "bytes");
}

} // namespace catoptric::render
