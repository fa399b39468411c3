#include "gpu/specialise.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <unordered_map>

#include <spirv-tools/optimizer.hpp>

namespace catoptric::gpu {

namespace {

using SpvConstantValues = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;

/// Registers passes that set the constants and remove the code that the constants switch off.
void register_constant_passes(spvtools::Optimizer& optimiser, const SpvConstantValues& values) {
    optimiser.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass());
}

/// Registers passes that inline all calls and keep variables in registers, because drivers do the
/// same in more time, in each process again. No pass reorders or merges operations of floats.
void register_inlining_passes(spvtools::Optimizer& optimiser) {
    optimiser.RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateSSARewritePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateBlockMergePass());
}

constexpr std::string_view kSubgroupPass = "remove-unused-subgroup-capability";

/// Removes the capability of subgroup operations if no such operation is left. The code that counts
/// work in fragment shaders has subgroup operations, which a device need not support there.
void remove_subgroup_capability(std::vector<std::uint32_t>& words) {
    constexpr std::size_t kSpirvHeaderWords = 5;
    // Numbers of SPIR-V: instruction OpCapability, its operand, and the instructions of subgroups.
    constexpr std::uint32_t kCapabilityInstruction = 17, kSubgroupCapability = 61,
                            kFirstSubgroupInstruction = 333, kLastSubgroupInstruction = 366;
    std::size_t capability = 0;
    for (std::size_t at = kSpirvHeaderWords; at < words.size();) {
        const std::uint32_t instruction = words[at] & 0xffffu, length = words[at] >> 16u;
        if (instruction >= kFirstSubgroupInstruction && instruction <= kLastSubgroupInstruction)
            return;
        if (instruction == kCapabilityInstruction && words[at + 1] == kSubgroupCapability)
            capability = at;
        at += std::max(length, 1u);
    }
    if (capability == 0) return;
    const auto first = words.begin() + static_cast<std::ptrdiff_t>(capability);
    words.erase(first, first + 2);
}

} // namespace

std::string specialisation_passes() {
    spvtools::Optimizer optimiser(SPV_ENV_VULKAN_1_3);
    register_constant_passes(optimiser, {});
    register_inlining_passes(optimiser);
    std::string names;
    for (const char* name : optimiser.GetPassNames()) names.append(name).append("\n");
    return names.append(kSubgroupPass).append("\n");
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
    register_constant_passes(optimiser, values);
    register_inlining_passes(optimiser);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the shader was validated when it was compiled
    std::vector<std::uint32_t> result;
    check(optimiser.Run(words.data(), words.size(), &result, options), Failure::internal,
          "shader '", name, "' cannot be specialised: ", said);
    remove_subgroup_capability(result);
    return result;
}

} // namespace catoptric::gpu
