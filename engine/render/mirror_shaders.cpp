#include "render/mirror_shaders.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

/// The resources that a pass has declared so far.
struct PassReads {
    graph::PassBuilder& pass;
    std::vector<graph::ImageHandle> images = {};
    std::vector<graph::BufferHandle> buffers = {};

    void add(graph::ImageHandle image) {
        if (std::ranges::find(images, image) != images.end()) return;
        images.push_back(image);
        pass.reads(image, graph::ResourceUse::sampled);
    }
    void add(graph::BufferHandle buffer, graph::ResourceUse use) {
        if (std::ranges::find(buffers, buffer) != buffers.end()) return;
        buffers.push_back(buffer);
        pass.reads(buffer, use);
    }
    void add(const Captures& captures) {
        for (const CubeArray& cubes : captures.arrays) {
            add(cubes.colour);
            if (cubes.distance) add(*cubes.distance);
            if (cubes.surfaces) add(*cubes.surfaces);
        }
        if (captures.table) add(*captures.table, graph::ResourceUse::sampled);
    }
};

} // namespace

MirrorShaders use_one_shader(const GpuScene& scene, MirrorShader look) {
    return {{std::move(look)}, std::vector<std::uint32_t>(scene.mirror_count(), 0)};
}

void declare_shader_reads(graph::PassBuilder& pass, const Lighting& lighting,
                          const MirrorShaders& looks) {
    PassReads reads{pass};
    if (lighting.shadow_map) reads.add(*lighting.shadow_map);
    for (const MirrorShader& look : looks.looks) {
        if (look.captures) reads.add(*look.captures);
        for (const auto& [name, images] : look.images)
            for (const graph::ImageHandle& image : images) reads.add(image);
        for (const auto& [name, buffer] : look.buffers)
            reads.add(buffer, graph::ResourceUse::storage_read);
    }
}

} // namespace catoptric::render
