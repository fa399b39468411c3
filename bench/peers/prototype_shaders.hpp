#pragma once

#include "gpu/shader.hpp"

namespace peers {

/// Returns the shaders of the prototypes, named "peers/FILE#VARIANT" (shaders.cmake), for
/// gpu::add_shader.
std::span<const catoptric::gpu::EmbeddedShader> prototype_shaders();

} // namespace peers
