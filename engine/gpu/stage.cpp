#include "gpu/stage.hpp"

namespace catoptric::gpu {

namespace {

/// Returns the constants that switch shaders to substitutes for features that the device lacks. A
/// shader without such a constant is not affected.
ShaderConstantValues make_device_feature_constants(const GpuDevice& device) {
    ShaderConstantValues constants;
    if (device.needs_storage_buffers_for_texels()) constants.emplace_back("texels_in_storage", 1u);
    if (!device.has_float_filtering()) constants.emplace_back("distances_by_gather", 1u);
    if (!device.has_subgroups_in_fragments()) constants.emplace_back("counts_lanes", 0u);
    return constants;
}

} // namespace

ShaderConstantBits find_constant_bits(const GpuDevice& device, const ShaderReflection& shader,
                                      const ShaderConstantValues& constants,
                                      const ShaderConstantValues& features) {
    ShaderConstantBits bits;
    const ShaderConstantValues of_device = make_device_feature_constants(device);
    for (const ShaderConstantValues* list : {&of_device, &constants, &features})
        for (const auto& [constant, value] : *list) {
            const auto known = std::ranges::find(shader.constants, constant,
                                                 &SpecialisationConstant::name);
            if (known != shader.constants.end()) bits[known->id] = constant_value_as_bits(value);
        }
    return bits;
}

ShaderStage::ShaderStage(const GpuDevice& device, SpecialisedShaderCache& shaders,
                         const std::string& name, VkShaderStageFlagBits stage,
                         ShaderReflection whole, const ShaderConstantBits& constants)
    : bit(stage), reflection(std::move(whole)) {
    check(!reflection.doubles || device.supports_double_precision_shaders(), Failure::no_device,
          "shader '", name, "' computes with doubles, which device '",
          device.device_properties().name, "' cannot");
    check(!reflection.triangle_numbers || device.supports_primitive_id_in_fragments(),
          Failure::no_device, "shader '", name, "' reads the number of a triangle, which device '",
          device.device_properties().name,
          "' does not give; the technique raytrace with first=ray needs none");
    const std::vector<std::uint32_t> words = shaders.find_or_specialise(
        name, find_shader(name).words, constants);
    // Keeps only the bindings that the shader still uses with these constants.
    reflection.bindings = reflect_spirv(name, words).bindings;
    VkShaderModuleCreateInfo create{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    create.codeSize = words.size() * sizeof(std::uint32_t);
    create.pCode = words.data();
    VkShaderModule handle = VK_NULL_HANDLE;
    throw_unless_vk_success(vkCreateShaderModule(device.device_handle(), &create, nullptr, &handle),
                            "load shader '" + name + "'");
    module = {device.device_handle(), handle};
}

} // namespace catoptric::gpu
