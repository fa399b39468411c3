#pragma once

#include "render/captures.hpp"
#include "scene/flat_mirror.hpp"

#include <memory>
#include <string>
#include <vector>

namespace catoptric::render {

/// A fragment shader and the resources that it reads.
struct MirrorShader {
    std::string fragment; ///< fragment shader; empty: the mirror is black
    std::string variant;  ///< suffix of `fragment`, where no cause of error is removed
    gpu::ShaderConstants constants;
    std::shared_ptr<const MirrorCaptures> captures;
    /// Further images that the mirror's shader samples (nearest), by their names in the shader. An
    /// entry has one image, or one for each array of captures.
    std::vector<std::pair<std::string, std::vector<graph::ImageHandle>>> images;
    std::vector<std::pair<std::string, graph::BufferHandle>>
        buffers;               ///< further buffers that the mirror's shader reads
    bool blank = false;        ///< black, because the captures of the frame before do not exist
    std::uint32_t ablated = 0; ///< causes of error that fragment#ablate removes
    vec4 shown{0};             ///< drawn part of a mirrored view: shared::DrawParameters::shown
};

/// A part of a mirror with its own shader.
struct PartShader {
    std::uint32_t mirror = 0; ///< number of the mirror, from 0
    std::uint32_t look = 0;   ///< index into MirrorShaders::looks
    std::vector<scene::TriangleRun> triangles;
};

/// The shader of each mirror, chosen from a list.
struct MirrorShaders {
    static constexpr std::uint32_t kByPart = ~0u;
    std::vector<MirrorShader> looks;
    std::vector<std::uint32_t> of_mirror; ///< index into `looks`; kByPart: see `parts`
    std::vector<PartShader> parts;        ///< triangles in no part are not drawn
};

MirrorShaders use_same_shader(const GpuScene& scene, MirrorShader look);

/// Declares that a pass reads the resources of these shaders and of the lighting, each once.
void declare_shader_reads(graph::PassBuilder& pass, const ShadingLights& lighting,
                          const MirrorShaders& looks);

/// The tracer that completes surfaces that are no mirrors, where the shadow map leaves their light
/// open or they reflect.
struct ShadingTracer {
    std::uint32_t number = 0;  ///< number of the tracer, from 1; 0: none
    bool traces_lobes = false; ///< rough surfaces reflect as well
};

} // namespace catoptric::render
