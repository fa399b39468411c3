#pragma once

#include "gpu/device.hpp"
#include "gpu/pipeline_cache.hpp"
#include "gpu/shader.hpp"
#include "gpu/shader_cache.hpp"

#include <map>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace catoptric::gpu {

/// Values of specialisation constants, by their names in the shader.
using ShaderConstantValues =
    std::vector<std::pair<std::string, std::variant<std::uint32_t, float>>>;

/// The order of a triangle's corners in the picture.
enum class TriangleWinding { none, clockwise, counterclockwise };

/// How a pass combines colours with its first attachment: it replaces them, covers them by alpha,
/// or adds to them. If it does not replace them, it writes no other attachment and no depth.
enum class Blending { none, cover, sum };

/// A raster pipeline as a pass body asks for it. Attachments come from the pass. Depth is reversed:
/// greater is nearer.
struct RasterPipelineState {
    std::string vertex;
    std::string fragment; ///< fragment shader; empty: the pipeline writes depth only
    ShaderConstantValues constants;
    TriangleWinding hidden = TriangleWinding::none; ///< triangles of this winding are culled
    ShaderConstantValues features =
        {}; ///< constants of the scene; ignored by shaders that lack them
    Blending blending = Blending::none;
    bool keeps_colour = false; ///< the first attachment stays as it is
};

struct ComputePipelineState {
    std::string shader;
    ShaderConstantValues constants;
    ShaderConstantValues features =
        {}; ///< constants of the scene; ignored by shaders that lack them
};

struct AttachmentFormats {
    std::vector<TexelFormat> colour;
    bool depth = false;
};

/// Returns Vulkan's descriptor type of a binding.
VkDescriptorType descriptor_type_of_binding(ShaderBindingKind kind);

/// A pipeline with its layout and the bindings that its shaders use.
struct Pipeline {
    UniqueDescriptorSetLayout set_layout;
    UniquePipelineLayout layout;
    UniquePipeline pipeline;
    std::vector<ShaderBinding> bindings;
    std::uint32_t push_bytes = 0;
    VkShaderStageFlags stages = 0;
    VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
};

struct ShaderStage;

/// Makes each pipeline once, and each stage of a pipeline once. References stay valid as long as
/// this object lives. On a software driver the first use of a pipeline still compiles it inside the
/// frame.
class PipelineStore {
public:
    /// `variants`: shaders to use in place of others ("raytrace.comp" -> "raytrace.comp#naive"),
    /// for benchmarks that compare two builds of one shader.
    /// `cache`: folder for compiled pipelines; empty: none. `shaders`: folder for specialised
    /// shaders; empty: none.
    explicit PipelineStore(GpuDevice& device, std::map<std::string, std::string> variants = {},
                           const std::filesystem::path& cache = {},
                           const std::filesystem::path& shaders = {});
    ~PipelineStore();
    const Pipeline& find_or_make_raster_pipeline(const RasterPipelineState& state,
                                                 const AttachmentFormats& attachments);
    const Pipeline& find_or_make_compute_pipeline(const ComputePipelineState& state);
    const PipelineCache& pipeline_cache() const { return cache_; }
    std::size_t count_compiled_pipelines() const { return rasters_.size() + computes_.size(); }
    double total_compile_ms() const {
        return ms_;
    } ///< milliseconds of the host, for all pipelines made

private:
    using RasterPipelineKey = std::pair<RasterPipelineState, AttachmentFormats>;
    using RasterPipelineKeyView = std::pair<const RasterPipelineState&, const AttachmentFormats&>;
    /// An order of the requests, so that a lookup builds no name.
    struct PipelineRequestLess {
        using is_transparent = void;
        bool operator()(const RasterPipelineKeyView& a, const RasterPipelineKeyView& b) const;
        bool operator()(const ComputePipelineState& a, const ComputePipelineState& b) const;
    };

    /// Returns the stage of this shader or of its variant with these constants.
    const ShaderStage& find_or_make_shader_stage(const std::string& shader,
                                                 VkShaderStageFlagBits bit,
                                                 const ShaderConstantValues& constants,
                                                 const ShaderConstantValues& features);
    GpuDevice& pipeline_device_;
    std::map<std::string, std::string> variants_;
    PipelineCache cache_;
    SpecialisedShaderCache shaders_;
    /// Pipelines that differ in attachments or fixed functions share stages. Keyed by the shader's
    /// name and the bits of its constants by constant_id.
    std::map<std::pair<std::string, std::map<std::uint32_t, std::uint32_t>>,
             std::unique_ptr<ShaderStage>>
        stages_;
    std::map<RasterPipelineKey, Pipeline, PipelineRequestLess> rasters_;
    std::map<ComputePipelineState, Pipeline, PipelineRequestLess> computes_;
    double ms_ = 0;
};

} // namespace catoptric::gpu
