#include "render/mirror_shaders.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

/// The resources that a pass has declared so far.
struct PassReads {
    graph::PassBuilder& pass;
    std::vector<graph::ImageHandle> images = {};
    std::vector<graph::BufferHandle> buffers = {};

    void add_image(graph::ImageHandle image) {
        if (std::ranges::find(images, image) != images.end()) return;
        images.push_back(image);
        pass.reads(image, graph::ResourceUse::sampled);
    }
    void add_buffer(graph::BufferHandle buffer, graph::ResourceUse use) {
        if (std::ranges::find(buffers, buffer) != buffers.end()) return;
        buffers.push_back(buffer);
        pass.reads(buffer, use);
    }
    void add_captures(const MirrorCaptures& captures) {
        for (const CubeCaptureArray& cubes : captures.arrays) {
            add_image(cubes.colour);
            if (cubes.distance) add_image(*cubes.distance);
            if (cubes.surfaces) add_image(*cubes.surfaces);
        }
        if (captures.table) add_buffer(*captures.table, graph::ResourceUse::sampled);
    }
};

} // namespace

MirrorShaders use_same_shader(const GpuScene& scene, MirrorShader look) {
    return {{std::move(look)}, std::vector<std::uint32_t>(scene.mirror_count(), 0)};
}

void declare_shader_reads(graph::PassBuilder& pass, const ShadingLights& lighting,
                          const MirrorShaders& looks) {
    PassReads reads{pass};
    if (lighting.shadow_map) reads.add_image(*lighting.shadow_map);
    if (lighting.shadow_map && lighting.glass_depths) reads.add_image(*lighting.glass_depths);
    if (lighting.ambient_occlusion) reads.add_image(*lighting.ambient_occlusion);
    if (lighting.probes) {
        reads.add_image(lighting.probes->grid);
        reads.add_image(lighting.probes->light);
        reads.add_image(lighting.probes->distances);
    }
    for (const MirrorShader& look : looks.looks) {
        if (look.captures) reads.add_captures(*look.captures);
        for (const auto& [name, images] : look.images)
            for (const graph::ImageHandle& image : images) reads.add_image(image);
        for (const auto& [name, buffer] : look.buffers)
            reads.add_buffer(buffer, graph::ResourceUse::storage_read);
    }
}

} // namespace catoptric::render
