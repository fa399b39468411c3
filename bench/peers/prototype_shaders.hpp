#pragma once

#include "gpu/shader.hpp"

namespace peers {

/// Those of the prototypes, "peers/FILE#BUILD" (shaders.cmake), for gpu::add_shader.
std::span<const catoptric::gpu::EmbeddedShader> prototype_shaders();

} // namespace peers
