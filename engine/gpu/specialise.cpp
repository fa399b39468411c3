#include "gpu/specialise.hpp"

#include "core/error.hpp"

#include <string>
#include <unordered_map>

#include <spirv-tools/optimizer.hpp>

namespace catoptric::gpu {

namespace {

using SpvConstantValues = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;

void register_specialisation_passes(spvtools::Optimizer& optimiser,
                                    const SpvConstantValues& values) {
    optimiser.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
}

} // namespace

std::string list_specialisation_passes() {
    spvtools::Optimizer optimiser(SPV_ENV_VULKAN_1_3);
    register_specialisation_passes(optimiser, {});
    std::string names;
    for (const char* name : optimiser.GetPassNames()) names.append(name).append("\n");
    return names;
}

std::vector<std::uint32_t>
specialise_shader(std::string_view name, std::span<const std::uint32_t> words,
                  const std::map<std::uint32_t, std::uint32_t>& constants) {
    SpvConstantValues values;
    for (const auto& [id, bits] : constants) values[id] = {bits};
    spvtools::Optimizer optimiser(SPV_ENV_VULKAN_1_3);
    std::string said;
    optimiser.SetMessageConsumer([&](spv_message_level_t, const char*, const spv_position_t&,
                                     const char* message) { said = message; });
    register_specialisation_passes(optimiser, values);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the shader was validated when it was compiled
    std::vector<std::uint32_t> result;
    check(optimiser.Run(words.data(), words.size(), &result, options), Failure::internal,
          "shader '", name, "' cannot be specialised: ", said);
    return result;
}

} // namespace catoptric::gpu
