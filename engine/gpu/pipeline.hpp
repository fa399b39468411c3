#pragma once

#include "gpu/device.hpp"
#include "gpu/pipeline_cache.hpp"
#include "gpu/shader.hpp"

#include <map>
#include <string>
#include <variant>
#include <vector>

namespace catoptric::gpu {

/// Values of specialisation constants, by the name they have in the shader.
using Constants = std::vector<std::pair<std::string, std::variant<std::uint32_t, float>>>;

/// How a triangle's corners run around it in the picture.
enum class Winding { none, clockwise, counterclockwise };

/// A raster pipeline as a pass body asks for it; attachments come from the pass. Depth is reversed:
/// greater is nearer.
struct RasterState {
    std::string vertex;
    std::string fragment; ///< empty: depth only
    Constants constants;
    Winding hidden = Winding::none; ///< triangles that run so are left out
    Constants features = {};        ///< of the scene: a shader that has not got one does without
    bool blended = false;           ///< over what is there, by alpha
};

struct ComputeState {
    std::string shader;
    Constants constants;
    Constants features = {}; ///< of the scene: a shader that has not got one does without
};

struct Attachments {
    std::vector<Format> colour;
    bool depth = false;
};

/// What Vulkan calls such a binding.
VkDescriptorType descriptor_type(BindingKind kind);

/// A pipeline with its layout and the bindings that its shaders use.
struct Pipeline {
    UniqueDescriptorSetLayout set_layout;
    UniquePipelineLayout layout;
    UniquePipeline pipeline;
    std::vector<Binding> bindings;
    std::uint32_t push_bytes = 0;
    VkShaderStageFlags stages = 0;
    VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_GRAPHICS;
};

/// Makes each pipeline once. References stay valid as long as this lives.
/// On a software driver the first use of a pipeline still compiles it inside the frame.
class Pipelines {
public:
    /// `variants`: shaders to use in place of others ("raytrace.comp" -> "raytrace.comp#naive"),
    /// for benchmarks that compare two builds of one shader.
    /// `cache`: a folder to keep compiled pipelines in; empty: none.
    explicit Pipelines(Device& device, std::map<std::string, std::string> variants = {},
                       const std::filesystem::path& cache = {})
        : device_(device), variants_(std::move(variants)), cache_(device, cache) {}
    const Pipeline& raster(const RasterState& state, const Attachments& attachments);
    const Pipeline& compute(const ComputeState& state);
    const PipelineCache& cache() const { return cache_; }
    std::size_t made() const { return rasters_.size() + computes_.size(); }
    double ms() const { return ms_; } ///< of the host, for all that were made

private:
    using Raster = std::pair<RasterState, Attachments>;
    using RasterView = std::pair<const RasterState&, const Attachments&>;
    /// An order of what was asked for, so that asking again makes no text of it.
    struct Before {
        using is_transparent = void;
        bool operator()(const RasterView& a, const RasterView& b) const;
        bool operator()(const ComputeState& a, const ComputeState& b) const;
    };

    const std::string& variant_of(const std::string& shader) const;
    Device& device_;
    std::map<std::string, std::string> variants_;
    PipelineCache cache_;
    std::map<Raster, Pipeline, Before> rasters_;
    std::map<ComputeState, Pipeline, Before> computes_;
    double ms_ = 0;
};

} // namespace catoptric::gpu
