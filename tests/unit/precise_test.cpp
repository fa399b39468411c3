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
enum Op : std::uint32_t {
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
constexpr std::uint32_t kNoContraction = 42, kFma = 50; // kFma: number in GLSL.std.450
constexpr std::array kFusible{kFNegate, kFAdd, kFSub, kFMul, kVectorTimesScalar, kDot};

/// Functions whose results are compared bit for bit between devices.
constexpr std::array<std::string_view, 6> kExact{"make_ray_shear(", "product_error(",
                                                 "edge_function(",  "choose_shorter_edges(",
                                                 "triangle_test(",  "barycentric("};

struct Count {
    int fixed = 0;   ///< number of instructions that must not be fused
    int fusible = 0; ///< number of instructions that may be fused
};

/// Counts the fusible instructions of a SPIR-V module, for each function of kExact.
std::map<std::string_view, Count> precise_count(std::span<const std::uint32_t> words) {
    std::map<std::uint32_t, std::string_view> names;
    std::set<std::uint32_t> fixed;
    std::map<std::string_view, Count> result;
    Count* here = nullptr;
    for (std::size_t i = 5; i < words.size(); i += words[i] >> 16) {
        const std::uint32_t op = words[i] & 0xffff, *operands = words.data() + i + 1;
        if (op == kName) names[operands[0]] = reinterpret_cast<const char*>(operands + 1);
        if (op == kDecorate && operands[1] == kNoContraction) fixed.insert(operands[0]);
        if (op == kFunction) {
            const auto exact = std::ranges::find_if(
                kExact, [&](auto start) { return names[operands[1]].starts_with(start); });
            here = exact == kExact.end() ? nullptr : &result[*exact];
        }
        if (here != nullptr && op == kExtInst && operands[3] == kFma) ++here->fusible;
        if (here != nullptr && std::ranges::find(kFusible, op) != kFusible.end())
            ++(fixed.contains(operands[1]) ? here->fixed : here->fusible);
    }
    return result;
}

TEST(Precise, TriangleTestAllowsNoFusedInstructions) {
    int shaders = 0;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        const std::map<std::string_view, Count> functions = precise_count(shader.words);
        if (!functions.contains("triangle_test(")) continue;
        ++shaders;
        for (const std::string_view name : kExact) {
            ASSERT_TRUE(functions.contains(name)) << shader.name << ' ' << name;
            EXPECT_EQ(functions.at(name).fusible, 0) << shader.name << ' ' << name;
        }
        EXPECT_GE(functions.at("triangle_test(").fixed, 20) << shader.name;
        EXPECT_GE(functions.at("product_error(").fixed, 15) << shader.name;
        EXPECT_GE(functions.at("edge_function(").fixed, 3) << shader.name;
    }
    EXPECT_GE(shaders, 3) << "the ray tracer, its variants, what hybrid traces";
}

} // namespace
} // namespace catoptric::gpu
