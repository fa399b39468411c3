// Tests that shaders do not allow fused multiply-adds in the triangle test. A compiler may fuse a
// product and a sum into one rounding unless the SPIR-V instruction is decorated with
// NoContraction. Two devices could then disagree about a triangle's edge. Software drivers never
// fuse, so a missing decoration does not show in their pictures. Therefore the test reads the
// shaders' code.
#include "gpu/shader.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string>

namespace catoptric::gpu {
namespace {

// Instruction and decoration numbers from the SPIR-V 1.6 specification, sections 3.20 and 3.49.
enum SpirvOpcode : std::uint32_t {
    kName = 5,
    kExtInst = 12,
    kFunction = 54,
    kDecorate = 71,
    kFNegate = 127,
    kFAdd = 129,
    kFSub = 131,
    kFMul = 133,
    kVectorTimesScalar = 142,
    kDot = 148
};
constexpr std::uint32_t kNoContractionDecoration = 42,
                        kFmaOpcode = 50; // kFmaOpcode: number in GLSL.std.450
constexpr std::array kFusibleOpcodes{kFNegate, kFAdd, kFSub, kFMul, kVectorTimesScalar, kDot};

/// Functions whose results are compared bit for bit between devices.
constexpr std::array<std::string_view, 6> kExactFunctions{
    "make_ray_shear(",       "product_rounding_error(",        "exact_product_difference(",
    "choose_shorter_edges(", "intersect_triangle_watertight(", "normalise_barycentric("};

struct FusibleInstructionCount {
    int fixed = 0;   ///< number of instructions that must not be fused
    int fusible = 0; ///< number of instructions that may be fused
};

/// Counts the fusible instructions of a SPIR-V module, for each function of kExactFunctions.
std::map<std::string_view, FusibleInstructionCount>
count_fusible_instructions(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, std::string_view> names;
    std::set<std::uint32_t> fixed;
    std::map<std::string_view, FusibleInstructionCount> result;
    FusibleInstructionCount* here = nullptr;
    for (std::size_t i = 5; i < words.size(); i += words[i] >> 16) {
        const std::uint32_t op = words[i] & 0xffff, *operands = words.data() + i + 1;
        if (op == kName) names[operands[0]] = reinterpret_cast<const char*>(operands + 1);
        if (op == kDecorate && operands[1] == kNoContractionDecoration) fixed.insert(operands[0]);
        if (op == kFunction) {
            const auto exact = std::ranges::find_if(
                kExactFunctions, [&](auto start) { return names[operands[1]].starts_with(start); });
            here = exact == kExactFunctions.end() ? nullptr : &result[*exact];
        }
        if (here != nullptr && op == kExtInst && operands[3] == kFmaOpcode) ++here->fusible;
        if (here != nullptr && std::ranges::find(kFusibleOpcodes, op) != kFusibleOpcodes.end())
            ++(fixed.contains(operands[1]) ? here->fixed : here->fusible);
    }
    return result;
}

TEST(Precise, TriangleTestAllowsNoFusedInstructions) {
    int shaders = 0;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        const std::map<std::string_view, FusibleInstructionCount> functions =
            count_fusible_instructions(shader.words);
        if (!functions.contains("intersect_triangle_watertight(")) continue;
        ++shaders;
        for (const std::string_view name : kExactFunctions) {
            ASSERT_TRUE(functions.contains(name)) << shader.name << ' ' << name;
            EXPECT_EQ(functions.at(name).fusible, 0) << shader.name << ' ' << name;
        }
        EXPECT_GE(functions.at("intersect_triangle_watertight(").fixed, 20) << shader.name;
        EXPECT_GE(functions.at("product_rounding_error(").fixed, 15) << shader.name;
        EXPECT_GE(functions.at("exact_product_difference(").fixed, 3) << shader.name;
    }
    EXPECT_GE(shaders, 3) << "the ray tracer, its variants, what hybrid traces";
}

} // namespace
} // namespace catoptric::gpu
