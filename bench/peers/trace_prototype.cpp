#include "trace_prototype.hpp"

#include "bvh/words.hpp"
#include "skip_links.hpp"

#include <bit>
#include <cstring>

namespace peers {

using namespace catoptric;
using gpu::BufferUsage;

namespace {

vec4 make_texel(const PeerVector3& v, float w = 0) { return {v.x, v.y, v.z, w}; }

/// Returns the tree's nodes with the tag bit removed from the words of children.
std::vector<vec4> copy_bvh_nodes_without_tags(const bvh::Bvh& tree) {
    std::vector<vec4> nodes = tree.nodes;
    for (vec4& node : nodes)
        node.w = std::bit_cast<float>(std::bit_cast<std::uint32_t>(node.w) &
                                      ~f32::kBvhNormalFloatBit);
    return nodes;
}

} // namespace

RayTracingPrototype::RayTracingPrototype(gpu::Device& device, gpu::PipelineStore& pipelines,
                                         const EmbreeWhittedTracer& peer,
                                         std::span<const bvh::Triangle> triangles,
                                         PrototypeBvhKind tree)
    : peer_device_(device), sets_(device) {
    const WhittedTracerScene& scene = peer.whitted_tracer_scene();
    const PeerSceneLight& light = scene.lights.front();
    const auto width = static_cast<std::uint32_t>(scene.width),
               height = static_cast<std::uint32_t>(scene.height);
    picture_ = GeneralLayoutVulkanImage(device, TexelFormat::rgba32f, {width, height}, 1,
                                        VK_IMAGE_USAGE_STORAGE_BIT |
                                            VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    pixels_ = gpu::Buffer(device, "pixels", sizeof(vec4) * width * height, BufferUsage::read_back);
    view_ = {make_texel(scene.eye, scene.ambient),
             make_texel(scene.forward, static_cast<float>(scene.depth)),
             make_texel(scene.right),
             make_texel(scene.down),
             make_texel(light.position, scene.shadow_end),
             make_texel(light.normal),
             make_texel(light.intensity),
             {}};
    upload(scene, triangles, tree);
    const char* const shader = tree == PrototypeBvhKind::stack ? "peers/trace.comp"
                                                               : "peers/trace.comp#skip_links";
    bound_ = sets_.bind(pipelines.compute_pipeline({shader, {}}),
                        {{"nodes", {&nodes_}},
                         {"triangles", {&triangles_}},
                         {"normals", {&normals_}},
                         {"surfaces", {&surfaces_}},
                         {"picture", {nullptr, picture_.view(VK_IMAGE_VIEW_TYPE_2D)}}});
}

void RayTracingPrototype::upload(const WhittedTracerScene& scene,
                                 std::span<const bvh::Triangle> triangles, PrototypeBvhKind tree) {
    const bvh::Bvh hierarchy = bvh::build(triangles);
    std::vector<vec4> corners, normals, surfaces;
    for (std::size_t i = 0; i < hierarchy.triangles.size(); i += 3) {
        const vec4* const at = &hierarchy.triangles[i];
        const std::size_t number = bvh::unpack_number(at[1].w);
        const vec3 a(at[0]);
        corners.emplace_back(a, static_cast<float>(scene.triangle_objects[number]));
        corners.emplace_back(vec3(at[1]) - a, 0), corners.emplace_back(vec3(at[2]) - a, 0);
        for (const PeerVector3& normal : scene.normals[number])
            normals.push_back(make_texel(normal));
    }
    for (const PeerSurfaceMaterial& surface : scene.surfaces) {
        surfaces.push_back(make_texel(surface.albedo, surface.is_mirror ? 1 : 0));
        surfaces.push_back(make_texel(surface.emission));
        surfaces.push_back(make_texel(surface.reflectance));
    }
    std::vector<vec4> nodes = copy_bvh_nodes_without_tags(hierarchy);
    if (tree == PrototypeBvhKind::skip_links) {
        SkipLinkBvh list = convert_bvh_to_skip_links(hierarchy);
        view_.grid = vec4(list.lowest, list.steps);
        nodes = std::move(list.nodes);
    }
    gpu::upload(peer_device_, nodes_, "nodes", nodes, BufferUsage::texels);
    gpu::upload(peer_device_, triangles_, "triangles", corners, BufferUsage::texels);
    gpu::upload(peer_device_, normals_, "normals", normals, BufferUsage::texels);
    gpu::upload(peer_device_, surfaces_, "surfaces", surfaces, BufferUsage::texels);
}

void RayTracingPrototype::trace_picture_with_prototype() {
    peer_device_.run_commands("trace the prototype's picture", [&](VkCommandBuffer commands) {
        bound_.bind(commands);
        bound_.push_draw_constants(commands, view_);
        vkCmdDispatch(commands, picture_.image_extent().width / 8,
                      picture_.image_extent().height / 8, 1);
        record_full_memory_barrier(commands);
    });
}

std::vector<PeerVector3> RayTracingPrototype::read() {
    peer_device_.run_commands("read the prototype's picture",
                              [&](VkCommandBuffer commands) { picture_.copy(commands, pixels_); });
    return read_texel_colours_from_buffer(pixels_);
}

} // namespace peers
