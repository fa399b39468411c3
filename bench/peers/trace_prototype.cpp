#include "trace_prototype.hpp"

#include "bvh/words.hpp"
#include "skip_links.hpp"

#include <bit>
#include <cstring>

namespace peers {

using namespace catoptric;
using gpu::BufferUsage;

namespace {

vec4 texel(const Vector& v, float w = 0) { return {v.x, v.y, v.z, w}; }

/// Returns the tree's nodes with the tag bit removed from the words of children.
std::vector<vec4> plain_nodes(const bvh::Bvh& tree) {
    std::vector<vec4> nodes = tree.nodes;
    for (vec4& node : nodes)
        node.w = std::bit_cast<float>(std::bit_cast<std::uint32_t>(node.w) &
                                      ~f32::kBvhNormalFloatBit);
    return nodes;
}

} // namespace

TracePrototype::TracePrototype(gpu::Device& device, gpu::Pipelines& pipelines,
                               const PeerScene& peer, std::span<const bvh::Triangle> triangles,
                               Tree tree)
    : device_(device), sets_(device) {
    const Whitted& scene = peer.whitted();
    const Light& light = scene.lights.front();
    const auto width = static_cast<std::uint32_t>(scene.width),
               height = static_cast<std::uint32_t>(scene.height);
    picture_ = PlainImage(device, Format::rgba32f, {width, height}, 1,
                          VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    pixels_ = gpu::Buffer(device, "pixels", sizeof(vec4) * width * height, BufferUsage::read_back);
    view_ = {texel(scene.eye, scene.ambient),
             texel(scene.forward, static_cast<float>(scene.depth)),
             texel(scene.right),
             texel(scene.down),
             texel(light.position, scene.shadow_end),
             texel(light.normal),
             texel(light.intensity),
             {}};
    upload(scene, triangles, tree);
    const char* const shader = tree == Tree::stack ? "peers/trace.comp"
                                                   : "peers/trace.comp#skip_links";
    bound_ = sets_.bind(pipelines.find_or_make_compute({shader, {}}),
                        {{"nodes", {&nodes_}},
                         {"triangles", {&triangles_}},
                         {"normals", {&normals_}},
                         {"surfaces", {&surfaces_}},
                         {"picture", {nullptr, picture_.view(VK_IMAGE_VIEW_TYPE_2D)}}});
}

void TracePrototype::upload(const Whitted& scene, std::span<const bvh::Triangle> triangles,
                            Tree tree) {
    const bvh::Bvh hierarchy = bvh::build_bvh(triangles);
    std::vector<vec4> corners, normals, surfaces;
    for (std::size_t i = 0; i < hierarchy.triangles.size(); i += 3) {
        const vec4* const at = &hierarchy.triangles[i];
        const std::size_t number = bvh::float_word_to_integer(at[1].w);
        const vec3 a(at[0]);
        corners.emplace_back(a, static_cast<float>(scene.triangle_objects[number]));
        corners.emplace_back(vec3(at[1]) - a, 0), corners.emplace_back(vec3(at[2]) - a, 0);
        for (const Vector& normal : scene.normals[number]) normals.push_back(texel(normal));
    }
    for (const Surface& surface : scene.surfaces) {
        surfaces.push_back(texel(surface.albedo, surface.is_mirror ? 1 : 0));
        surfaces.push_back(texel(surface.emission));
        surfaces.push_back(texel(surface.reflectance));
    }
    std::vector<vec4> nodes = plain_nodes(hierarchy);
    if (tree == Tree::skip_links) {
        SkipLinks list = skip_links(hierarchy);
        view_.grid = vec4(list.lowest, list.steps);
        nodes = std::move(list.nodes);
    }
    gpu::upload_to_buffer(device_, nodes_, "nodes", nodes, BufferUsage::texels);
    gpu::upload_to_buffer(device_, triangles_, "triangles", corners, BufferUsage::texels);
    gpu::upload_to_buffer(device_, normals_, "normals", normals, BufferUsage::texels);
    gpu::upload_to_buffer(device_, surfaces_, "surfaces", surfaces, BufferUsage::texels);
}

void TracePrototype::trace() {
    device_.submit_now("trace the prototype's picture", [&](VkCommandBuffer commands) {
        bound_.bind(commands);
        bound_.push(commands, view_);
        vkCmdDispatch(commands, picture_.extent().width / 8, picture_.extent().height / 8, 1);
        plain_barrier(commands);
    });
}

std::vector<Vector> TracePrototype::read() {
    device_.submit_now("read the prototype's picture",
                       [&](VkCommandBuffer commands) { picture_.copy(commands, pixels_); });
    return vectors_of(pixels_);
}

} // namespace peers
