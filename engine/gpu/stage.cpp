#include "gpu/stage.hpp"

namespace catoptric::gpu {

namespace {

/// Returns the constants that switch shaders to substitutes for features that the device lacks. A
/// shader without such a constant is not affected.
ShaderConstants feature_constants(const Device& device) {
    ShaderConstants constants;
    if (device.texels_in_storage()) constants.emplace_back("texels_in_storage", 1u);
    if (!device.filters_floats()) constants.emplace_back("distances_by_gather", 1u);
    if (!device.has_fragment_subgroups()) constants.emplace_back("counts_lanes", 0u);
    return constants;
}

} // namespace

ConstantBits constant_bits(const Device& device, const ShaderReflection& shader,
                           const ShaderConstants& constants, const ShaderConstants& features) {
    ConstantBits bits;
    const ShaderConstants of_device = feature_constants(device);
    for (const ShaderConstants* list : {&of_device, &constants, &features})
        for (const auto& [constant, value] : *list) {
            const auto known = std::ranges::find(shader.constants, constant,
                                                 &SpecialisationConstant::name);
            if (known != shader.constants.end()) bits[known->id] = to_bits(value);
        }
    return bits;
}

ShaderStage::ShaderStage(const Device& device, ShaderCache& shaders, const std::string& name,
                         VkShaderStageFlagBits stage, ShaderReflection whole,
                         const ConstantBits& constants)
    : bit(stage), reflection(std::move(whole)) {
    check(!reflection.doubles || device.has_doubles(), Failure::no_device, "shader '", name,
          "' computes with doubles, which device '", device.info().name, "' cannot");
    check(!reflection.triangle_numbers || device.has_primitive_id(), Failure::no_device, "shader '",
          name, "' reads the number of a triangle, which device '", device.info().name,
          "' does not give; the technique raytrace with first=ray needs none");
    const std::vector<std::uint32_t> words = shaders.specialised(name, find_shader(name).words,
                                                                 constants);
    // Keeps only the bindings that the shader still uses with these constants.
    reflection.bindings = reflect_spirv(name, words).bindings;
    VkShaderModuleCreateInfo create{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    create.codeSize = words.size() * sizeof(std::uint32_t);
    create.pCode = words.data();
    VkShaderModule handle = VK_NULL_HANDLE;
    check_vk(vkCreateShaderModule(device.handle(), &create, nullptr, &handle),
             "load shader '" + name + "'");
    module = {device.handle(), handle};
}

} // namespace catoptric::gpu
