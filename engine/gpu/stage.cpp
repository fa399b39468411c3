#include "gpu/stage.hpp"

#include "gpu/specialise.hpp"

#include <map>

namespace catoptric::gpu {

namespace {

/// Returns the constants that switch shaders to substitutes for features that the device lacks. A
/// shader without such a constant is not affected.
Constants constants_of(const Device& device) {
    Constants constants;
    if (device.texels_in_storage()) constants.emplace_back("texels_in_storage", 1u);
    if (!device.filters_floats()) constants.emplace_back("distances_by_gather", 1u);
    return constants;
}

} // namespace

Stage::Stage(const Device& device, const std::string& name, VkShaderStageFlagBits stage,
             const Constants& constants, const Constants& features)
    : bit(stage) {
    const EmbeddedShader& shader = find_shader(name);
    reflection = reflect(name, shader.words);
    check(!reflection.doubles || device.doubles(), Failure::no_device, "shader '", name,
          "' computes with doubles, which device '", device.info().name, "' cannot");
    check(!reflection.triangle_numbers || device.numbers_triangles(), Failure::no_device,
          "shader '", name, "' reads the number of a triangle, which device '", device.info().name,
          "' does not give; the technique raytrace with first=ray needs none");
    std::map<std::uint32_t, std::uint32_t> values;
    const Constants of_device = constants_of(device);
    for (const Constants* list : {&of_device, &constants, &features})
        for (const auto& [constant, value] : *list)
            if (const Constant* known = find(constant)) values[known->id] = bits_of(value);
    const std::vector<std::uint32_t> words = specialise(name, shader.words, values);
    // Only the bindings that are still used with these constants.
    reflection.bindings = reflect(name, words).bindings;
    VkShaderModuleCreateInfo create{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    create.codeSize = words.size() * sizeof(std::uint32_t);
    create.pCode = words.data();
    VkShaderModule handle = VK_NULL_HANDLE;
    check_vk(vkCreateShaderModule(device.handle(), &create, nullptr, &handle),
             "load shader '" + name + "'");
    module = {device.handle(), handle};
}

} // namespace catoptric::gpu
