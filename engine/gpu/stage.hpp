#pragma once

#include "gpu/pipeline.hpp"
#include "gpu/shader_cache.hpp"

#include <algorithm>
#include <bit>

/// Shader stages from which a pipeline is created.
namespace catoptric::gpu {

/// Returns the 32 bits that are passed to the shader for a constant.
inline std::uint32_t to_bits(const std::variant<std::uint32_t, float>& value) {
    return std::visit([](auto v) { return std::bit_cast<std::uint32_t>(v); }, value);
}

/// Bits of a shader's constants by their constant_id.
using ConstantBits = std::map<std::uint32_t, std::uint32_t>;

/// Returns the bits of those constants in the lists that `shader` has. A later list overrides an
/// earlier one: features that the device lacks, then `constants`, then `features`.
ConstantBits constant_bits(const Device& device, const ShaderReflection& shader,
                           const ShaderConstants& constants, const ShaderConstants& features);

/// One stage of a pipeline. Its module must outlive the call that creates the pipeline.
struct ShaderStage {
    /// `whole`: what the shader declares before its constants are set.
    ShaderStage(const Device& device, ShaderCache& shaders, const std::string& name,
                VkShaderStageFlagBits stage, ShaderReflection whole, const ConstantBits& constants);
    VkPipelineShaderStageCreateInfo create_info() const {
        VkPipelineShaderStageCreateInfo stage{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
        stage.stage = bit;
        stage.module = module;
        stage.pName = "main";
        return stage;
    }
    /// Returns the constant of this name, or null if the shader has none.
    const SpecialisationConstant* find_constant(const std::string& constant) const {
        const auto found = std::ranges::find(reflection.constants, constant,
                                             &SpecialisationConstant::name);
        return found == reflection.constants.end() ? nullptr : &*found;
    }

    VkShaderStageFlagBits bit;
    ShaderReflection reflection;
    UniqueShaderModule module;
};

} // namespace catoptric::gpu
