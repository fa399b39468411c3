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
using ShaderConstants = std::vector<std::pair<std::string, std::variant<std::uint32_t, float>>>;

/// The order of a triangle's corners in the picture.
enum class TriangleWinding { none, clockwise, counterclockwise };

/// How a pass combines colours with its first attachment: it replaces them, covers them by alpha,
/// or adds to them. If it does not replace them, it writes no other attachment and no depth.
enum class Blending { none, cover, sum };

/// A raster pipeline as a pass body asks for it. Attachments come from the pass. Depth is reversed:
/// greater is nearer.
struct RasterState {
    std::string vertex;
    std::string fragment; ///< empty: the pipeline writes depth only
    ShaderConstants constants;
    TriangleWinding hidden = TriangleWinding::none; ///< triangles of this winding are culled
    ShaderConstants features = {}; ///< constants of the scene; ignored by shaders that lack them
    Blending blending = Blending::none;
    bool keeps_colour = false; ///< the first attachment stays as it is
};

struct ComputeState {
    std::string shader;
    ShaderConstants constants;
    ShaderConstants features = {}; ///< constants of the scene; ignored by shaders that lack them
};

struct AttachmentFormats {
    std::vector<TexelFormat> colour;
    bool depth = false;
};

VkDescriptorType descriptor_type(BindingKind kind);

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
    explicit PipelineStore(Device& device, std::map<std::string, std::string> variants = {},
                           const std::filesystem::path& cache = {},
                           const std::filesystem::path& shaders = {});
    ~PipelineStore();
    const Pipeline& raster_pipeline(const RasterState& state, const AttachmentFormats& attachments);
    const Pipeline& compute_pipeline(const ComputeState& state);
    const PipelineCache& pipeline_cache() const { return cache_; }
    std::size_t pipeline_count() const { return rasters_.size() + computes_.size(); }
    double compile_ms() const { return ms_; } ///< milliseconds of the host, for all pipelines made

private:
    using RasterKey = std::pair<RasterState, AttachmentFormats>;
    using RasterKeyView = std::pair<const RasterState&, const AttachmentFormats&>;
    /// An order of the requests, so that a lookup builds no name.
    struct RequestLess {
        using is_transparent = void;
        bool operator()(const RasterKeyView& a, const RasterKeyView& b) const;
        bool operator()(const ComputeState& a, const ComputeState& b) const;
    };

    /// Returns the stage of this shader or of its variant with these constants.
    const ShaderStage& shader_stage(const std::string& shader, VkShaderStageFlagBits bit,
                                    const ShaderConstants& constants,
                                    const ShaderConstants& features);
    Device& device_;
    std::map<std::string, std::string> variants_;
    PipelineCache cache_;
    ShaderCache shaders_;
    /// Pipelines that differ in attachments or fixed functions share stages. Keyed by the shader's
    /// name and the bits of its constants by constant_id.
    std::map<std::pair<std::string, std::map<std::uint32_t, std::uint32_t>>,
             std::unique_ptr<ShaderStage>>
        stages_;
    std::map<RasterKey, Pipeline, RequestLess> rasters_;
    std::map<ComputeState, Pipeline, RequestLess> computes_;
    double ms_ = 0;
};

} // namespace catoptric::gpu
