// Tests that each specialisation constant of shaders/lib/constants.glsl has the same number in all
// shaders.
#include "gpu/shader.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

namespace {

using namespace catoptric::gpu;

TEST(Constants, SpecialisationConstantsHaveOneNumberInAllShaders) {
    // OWN_CONSTANTS of the shaders: each shader numbers its own constants from here on.
    constexpr std::uint32_t kFirstOwnConstantId = 62;
    std::map<std::string, std::set<std::uint32_t>> ids;
    std::map<std::uint32_t, std::set<std::string>> names;
    for (const EmbeddedShader& shader : embedded_shaders()) {
        std::set<std::uint32_t> here;
        for (const SpecialisationConstant& constant :
             reflect_spirv(shader.name, shader.words).constants) {
            EXPECT_TRUE(here.insert(constant.id).second)
                << shader.name << ": " << constant.name << " has another's number";
            if (constant.id >= kFirstOwnConstantId) continue;
            ids[constant.name].insert(constant.id);
            names[constant.id].insert(constant.name);
        }
    }
    EXPECT_GE(ids.size(), 15U);
    for (const auto& [name, found] : ids) EXPECT_EQ(found.size(), 1U) << name;
    for (const auto& [id, found] : names) EXPECT_EQ(found.size(), 1U) << id;
}

} // namespace
