#include "ray_list.hpp"

#include <cstring>

namespace peers {

using namespace catoptric;
using gpu::BufferUsage;

RayListBenchmark::RayListBenchmark(gpu::Device& device, gpu::PipelineStore& pipelines,
                                   std::span<const bvh::Triangle> triangles,
                                   std::span<const Ray> rays)
    : peer_device_(device),
      met_(device, "met", rays.size() * sizeof(FirstRayHit), BufferUsage::read_back), sets_(device),
      groups_(static_cast<std::uint32_t>(rays.size() / 64)) {
    const bvh::Bvh tree = bvh::build(triangles);
    std::vector<vec4> texels;
    for (const auto& [origin, direction] : rays) {
        texels.emplace_back(origin.x, origin.y, origin.z, 0);
        texels.emplace_back(direction.x, direction.y, direction.z, 0);
    }
    gpu::upload(peer_device_, nodes_, "nodes", tree.nodes, BufferUsage::texels);
    gpu::upload(peer_device_, triangles_, "triangles", tree.triangles, BufferUsage::texels);
    gpu::upload(peer_device_, rays_, "rays", texels, BufferUsage::texels);
    met_.write(std::span<const FirstRayHit>(std::vector<FirstRayHit>(rays.size())));
    bound_ = sets_.bind(pipelines.compute_pipeline({"peers/rays.comp", {}}),
                        {{"bvh_nodes", {&nodes_}},
                         {"bvh_triangles", {&triangles_}},
                         {"rays", {&rays_}},
                         {"Met", {&met_}}});
}

void RayListBenchmark::trace_all_rays() {
    peer_device_.run_commands("trace a list of rays", [&](VkCommandBuffer commands) {
        bound_.bind(commands);
        vkCmdDispatch(commands, groups_, 1, 1);
        record_full_memory_barrier(commands);
    });
}

std::vector<FirstRayHit> RayListBenchmark::read() const {
    const std::vector<std::byte> bytes = met_.read();
    std::vector<FirstRayHit> met(bytes.size() / sizeof(FirstRayHit));
    std::memcpy(met.data(), bytes.data(), bytes.size());
    return met;
}

} // namespace peers
