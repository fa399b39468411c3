#include "ray_list.hpp"

#include <cstring>

namespace peers {

using namespace catoptric;
using gpu::BufferUsage;

RayList::RayList(gpu::Device& device, gpu::Pipelines& pipelines,
                 std::span<const bvh::Triangle> triangles, std::span<const Ray> rays)
    : device_(device), met_(device, "met", rays.size() * sizeof(Met), BufferUsage::read_back),
      sets_(device), groups_(static_cast<std::uint32_t>(rays.size() / 64)) {
    const bvh::Bvh tree = bvh::build_bvh(triangles);
    std::vector<vec4> texels;
    for (const auto& [origin, direction] : rays) {
        texels.emplace_back(origin.x, origin.y, origin.z, 0);
        texels.emplace_back(direction.x, direction.y, direction.z, 0);
    }
    gpu::upload_to_buffer(device_, nodes_, "nodes", tree.nodes, BufferUsage::texels);
    gpu::upload_to_buffer(device_, triangles_, "triangles", tree.triangles, BufferUsage::texels);
    gpu::upload_to_buffer(device_, rays_, "rays", texels, BufferUsage::texels);
    met_.write(std::span<const Met>(std::vector<Met>(rays.size())));
    bound_ = sets_.bind(pipelines.find_or_make_compute({"peers/rays.comp", {}}),
                        {{"bvh_nodes", {&nodes_}},
                         {"bvh_triangles", {&triangles_}},
                         {"rays", {&rays_}},
                         {"Met", {&met_}}});
}

void RayList::trace() {
    device_.submit_now("trace a list of rays", [&](VkCommandBuffer commands) {
        bound_.bind(commands);
        vkCmdDispatch(commands, groups_, 1, 1);
        plain_barrier(commands);
    });
}

std::vector<Met> RayList::read() const {
    const std::vector<std::byte> bytes = met_.read();
    std::vector<Met> met(bytes.size() / sizeof(Met));
    std::memcpy(met.data(), bytes.data(), bytes.size());
    return met;
}

} // namespace peers
