#include "capture_prototype.hpp"

#include "render/views.hpp"
#include "scene/light.hpp"

#include <algorithm>

namespace peers {

using namespace catoptric;
using gpu::BufferUsage;

namespace {

constexpr std::uint32_t kShadowMapEdge = 1024;
constexpr float kNearDistance = .002f;     // near distance of all views, scene units
constexpr float kNoSurfaceDistance = 1000; // stored distance where no surface is seen, scene units
constexpr std::uint32_t kMirrorCount = 4, kLightViewIndex = 1 + 6 * kMirrorCount;
// The light shines down, so its shadow map needs no face +Y.
constexpr std::uint32_t kShadowMapFaceCount = 5;

/// The uniform block Frame of shaders/draw.glsl.
struct FrameUniforms {
    glm::mat4 clip_from_scene[kLightViewIndex + kShadowMapFaceCount];
    vec4 light, light_normal, intensity;
};

glm::mat4 make_clip_from_scene_matrix(const shared::View& view) {
    glm::mat4 rows(0);
    const auto row = [&](const vec3& axis) { return vec4(axis, -dot(axis, view.eye)); };
    rows[0] = row(view.right), rows[1] = row(view.down);
    rows[2] = vec4(0, 0, 0, kNearDistance), rows[3] = row(view.forward);
    return transpose(rows);
}

} // namespace

CubeCapturePrototypeRenderer::CubeCapturePrototypeRenderer(gpu::Device& device,
                                                           gpu::PipelineStore& pipelines,
                                                           const session::Request& request,
                                                           std::uint32_t face)
    : peer_device_(device), face_(face), linear_(make_linear_sampler(device, false)),
      compare_(make_linear_sampler(device, true)), sets_(device) {
    add_scene(request);
    make_images(request.size);
    make_programs(pipelines);
}

void CubeCapturePrototypeRenderer::add_scene(const session::Request& request) {
    const render::SceneUnits space = render::make_scene_units(request.scene);
    const scene::Scene now = scene::scene_at(request.scene, request.time);
    geometry_ = render::make_geometry(now, space);
    const scene::PointLight light = scene::list_lights(now).at(0);
    const vec3 at = space.to_scene_point(light.position);
    views_ = {render::make_camera_view(request.camera, space, request.size, 1)};
    for (std::size_t i = 0; i < now.objects.size(); ++i) {
        const scene::Material& material = now.materials[now.objects[i].material];
        const bool mirror = scene::is_mirror(now, now.objects[i]);
        materials_.push_back(
            {vec4(mirror ? material.reflectance : material.albedo, 0), vec4(material.emission, 0)});
        if (!mirror) continue;
        mirrors_.push_back(i);
        for (const shared::View& view :
             render::make_cube_views(geometry_.ranges[i].bounds.centre(), 1))
            views_.push_back(view);
    }
    for (const shared::View& view : render::make_cube_views(at, 1))
        if (dot(view.forward, vec3(light.normal)) > -.5f) views_.push_back(view);
    FrameUniforms frame{};
    check(views_.size() == std::size(frame.clip_from_scene), Failure::usage,
          "the prototype with captures wants ", kMirrorCount, " mirrors, found ", mirrors_.size());
    for (std::size_t i = 0; i < views_.size(); ++i)
        frame.clip_from_scene[i] = make_clip_from_scene_matrix(views_[i]);
    frame.light = vec4(at, static_cast<float>(request.ambient));
    frame.light_normal = vec4(vec3(light.normal), kNearDistance);
    frame.intensity = vec4(
        light.emission * static_cast<float>(light.area * space.scale * space.scale), 0);
    gpu::upload(peer_device_, vertices_, "vertices", geometry_.vertices, BufferUsage::vertex);
    gpu::upload(peer_device_, indices_, "indices", geometry_.indices, BufferUsage::index);
    gpu::upload(peer_device_, frame_, "frame", std::vector<FrameUniforms>{frame},
                BufferUsage::uniform);
}

void CubeCapturePrototypeRenderer::make_images(uvec2 size) {
    constexpr VkImageUsageFlags kSampledUsage = VK_IMAGE_USAGE_SAMPLED_BIT,
                                kColour = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT,
                                kDepthUsage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
    constexpr VkImageViewType kArrayViewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY,
                              kOne = VK_IMAGE_VIEW_TYPE_2D;
    shadow_map_ = GeneralLayoutVulkanImage(peer_device_, TexelFormat::d32f, uvec2(kShadowMapEdge),
                                           kShadowMapFaceCount, kDepthUsage | kSampledUsage);
    shadow_faces_ = shadow_map_.view(kArrayViewType, 0, kShadowMapFaceCount);
    depth_ = GeneralLayoutVulkanImage(peer_device_, TexelFormat::d32f, uvec2(face_), 6,
                                      kDepthUsage);
    depth_faces_ = depth_.view(kArrayViewType, 0, 6);
    view_ = GeneralLayoutVulkanImage(peer_device_, TexelFormat::rgba32f, size, 1,
                                     kColour | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    picture_ = view_.view(kOne);
    view_depth_ = GeneralLayoutVulkanImage(peer_device_, TexelFormat::d32f, size, 1, kDepthUsage);
    picture_depth_ = view_depth_.view(kOne);
    pixels_ = gpu::Buffer(peer_device_, "pixels", sizeof(vec4) * size.x * size.y,
                          BufferUsage::read_back);
    const auto layers = static_cast<std::uint32_t>(6 * mirrors_.size());
    for (std::size_t i = 0; i < 2; ++i) {
        cubes_[i] = {GeneralLayoutVulkanImage(peer_device_, TexelFormat::rgba16f, uvec2(face_),
                                              layers, kColour | kSampledUsage),
                     GeneralLayoutVulkanImage(peer_device_, TexelFormat::r32f, uvec2(face_), layers,
                                              kColour | kSampledUsage)};
        for (std::uint32_t first = 0; first < layers; first += 6)
            faces_[i].push_back({cubes_[i].colour.view(kArrayViewType, first, 6),
                                 cubes_[i].distance.view(kArrayViewType, first, 6)});
    }
}

void CubeCapturePrototypeRenderer::make_programs(gpu::PipelineStore& pipelines) {
    const gpu::AttachmentFormats faces{{TexelFormat::rgba16f, TexelFormat::r32f}, true},
        picture{{TexelFormat::rgba32f}, true};
    const auto layers = static_cast<std::uint32_t>(6 * mirrors_.size());
    // Faces of a cube map are mirrored pictures, which reverse the winding of triangles. Triangles
    // of a ball that face away are culled.
    constexpr gpu::TriangleWinding kBackFaceWinding = gpu::TriangleWinding::clockwise,
                                   kAwayInFaces = gpu::TriangleWinding::counterclockwise;
    const auto state = [](const char* fragment, gpu::TriangleWinding hidden) {
        return gpu::RasterState{"peers/surface.vert", fragment, {}, hidden};
    };
    for (std::size_t i = 0; i < 2; ++i) {
        const VkImageViewType cubes = VK_IMAGE_VIEW_TYPE_CUBE_ARRAY;
        const Resources resources{
            {"frame", {&frame_}},
            {"shadow_map", {nullptr, shadow_faces_, compare_}},
            {"colours", {nullptr, cubes_[i].colour.view(cubes, 0, layers), linear_}},
            {"distances", {nullptr, cubes_[i].distance.view(cubes, 0, layers), linear_}}};
        const auto bind = [&](const char* fragment, gpu::TriangleWinding hidden,
                              const gpu::AttachmentFormats& to) {
            return sets_.bind(pipelines.raster_pipeline(state(fragment, hidden), to), resources);
        };
        capture_[i] = {bind("peers/diffuse.frag", gpu::TriangleWinding::none, faces),
                       bind("peers/mirror.frag", kAwayInFaces, faces)};
        camera_[i] = {bind("peers/diffuse.frag", gpu::TriangleWinding::none, picture),
                      bind("peers/mirror.frag", kBackFaceWinding, picture)};
        shadow_ = bind("", kAwayInFaces, {{}, true});
    }
}

/// Draws an object into the layers whose view it may intersect. One draw call covers a run of
/// neighbouring layers.
void CubeCapturePrototypeRenderer::draw_object(VkCommandBuffer commands,
                                               const BoundPrototypePipeline& program,
                                               std::size_t object, std::uint32_t first_view,
                                               std::uint32_t layers) const {
    const render::DrawRange& range = geometry_.ranges[object];
    const auto mirror = std::ranges::find(mirrors_, object);
    const vec3 centre = mirror == mirrors_.end() ? vec3(0) : range.bounds.centre();
    program.push_draw_constants(
        commands, DrawPushConstants{vec4(views_[first_view].eye, 0), materials_[object].albedo,
                                    materials_[object].emission, vec4(centre, 0), first_view,
                                    static_cast<float>(mirror - mirrors_.begin())});
    const auto meets = [&](std::uint32_t layer) {
        return render::may_show(views_[first_view + layer], range);
    };
    for (std::uint32_t layer = 0, end; layer < layers; layer = end + 1) {
        for (end = layer; end < layers && meets(end);) ++end;
        if (end > layer)
            vkCmdDrawIndexed(commands, range.index_count, end - layer, range.first_index, 0, layer);
    }
}

namespace {

/// Begins a rendering scope over whole images of one size, calls `body` and ends the scope.
template <typename Body>
void record_rendering_scope(VkCommandBuffer commands, VkExtent2D extent, std::uint32_t layers,
                            const std::vector<VkRenderingAttachmentInfo>& colours,
                            const VkRenderingAttachmentInfo& depth, Body&& body) {
    VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
    rendering.renderArea.extent = extent;
    rendering.layerCount = layers;
    rendering.colorAttachmentCount = static_cast<std::uint32_t>(colours.size());
    rendering.pColorAttachments = colours.data();
    rendering.pDepthAttachment = &depth;
    vkCmdBeginRendering(commands, &rendering);
    const VkViewport viewport{
        0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &rendering.renderArea);
    body();
    vkCmdEndRendering(commands);
    record_full_memory_barrier(commands);
}

} // namespace

/// Draws only the balls into the shadow map, because the walls of the room cast no shadow that
/// falls on a surface.
void CubeCapturePrototypeRenderer::draw_shadows(VkCommandBuffer commands) {
    record_rendering_scope(commands, shadow_map_.image_extent(), kShadowMapFaceCount, {},
                           make_cleared_attachment(shadow_faces_, 0), [&] {
                               shadow_.bind(commands);
                               for (const std::size_t mirror : mirrors_)
                                   draw_object(commands, shadow_, mirror, kLightViewIndex,
                                               kShadowMapFaceCount);
                           });
}

void CubeCapturePrototypeRenderer::draw_surfaces(VkCommandBuffer commands,
                                                 const PrototypeGraphicsPipelines& programs,
                                                 std::uint32_t first_view, std::uint32_t layers,
                                                 std::size_t except) const {
    programs.diffuse.bind(commands);
    for (std::size_t i = 0; i < geometry_.ranges.size(); ++i)
        if (!geometry_.ranges[i].mirror)
            draw_object(commands, programs.diffuse, i, first_view, layers);
    programs.mirror.bind(commands);
    for (const std::size_t mirror : mirrors_)
        if (mirror != except) draw_object(commands, programs.mirror, mirror, first_view, layers);
}

void CubeCapturePrototypeRenderer::draw() {
    const std::size_t now = ++frame_number_ % 2, before = 1 - now;
    peer_device_.run_commands("draw the prototype's frame", [&](VkCommandBuffer commands) {
        const VkDeviceSize zero = 0;
        const VkBuffer vertices = vertices_.handle();
        vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
        vkCmdBindIndexBuffer(commands, indices_.handle(), 0, VK_INDEX_TYPE_UINT32);
        draw_shadows(commands);
        for (std::uint32_t i = 0; i < mirrors_.size(); ++i)
            record_rendering_scope(
                commands, depth_.image_extent(), 6,
                {make_cleared_attachment(faces_[now][i][0], 0),
                 make_cleared_attachment(faces_[now][i][1], kNoSurfaceDistance)},
                make_cleared_attachment(depth_faces_, 0, false),
                [&] { draw_surfaces(commands, capture_[before], 1 + 6 * i, 6, mirrors_[i]); });
        record_rendering_scope(
            commands, view_.image_extent(), 1, {make_cleared_attachment(picture_, 0)},
            make_cleared_attachment(picture_depth_, 0, false),
            [&] { draw_surfaces(commands, camera_[now], 0, 1, geometry_.ranges.size()); });
    });
}

std::vector<PeerVector3> CubeCapturePrototypeRenderer::read() {
    peer_device_.run_commands("read the prototype's picture",
                              [&](VkCommandBuffer commands) { view_.copy(commands, pixels_); });
    return read_texel_colours_from_buffer(pixels_);
}

} // namespace peers
