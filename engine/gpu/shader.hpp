#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::gpu {

/// SPIR-V that was compiled at build time. `name` is the path below shaders/, with "#variant"
/// appended.
struct EmbeddedShader {
    std::string_view name;
    std::span<const std::uint32_t> words;
};
std::span<const EmbeddedShader> embedded_shaders();
/// Adds a shader of the calling program. Must be called before any shader is used. Name and words
/// are not copied. Throws `Failure::usage` if the name is taken.
void add_shader(const EmbeddedShader& shader);
/// Returns the embedded or added shader of this name. Throws `Failure::internal` if there is none.
const EmbeddedShader& find_shader(std::string_view name);

enum class BindingKind {
    uniform_buffer,
    storage_buffer,
    texel_buffer,
    sampled_image, ///< combined with a sampler
    texture,       ///< a texture without a sampler
    sampler,
    storage_image
};
enum class ImageViewType { flat, flat_array, cube, cube_array };

/// One resource in set 0 that the shader's code uses.
struct ShaderBinding {
    std::string name; ///< of the variable or of the block
    std::uint32_t binding = 0;
    BindingKind kind = BindingKind::storage_buffer;
    ImageViewType shape = ImageViewType::flat;
    std::uint32_t count = 1; ///< length of an array of textures
};

struct SpecialisationConstant {
    std::string name;
    std::uint32_t id = 0; ///< constant_id
};

/// The properties of a shader that the engine needs to make a pipeline and to bind by name.
struct ShaderReflection {
    std::vector<ShaderBinding> bindings;
    std::vector<SpecialisationConstant> constants;
    std::uint32_t push_bytes = 0;
    bool doubles = false;          ///< needs a device that computes with doubles
    bool has_inputs = false;       ///< reads what the stage before passes on: vertices
    bool triangle_numbers = false; ///< needs a device that numbers triangles (gl_PrimitiveID)
};

/// Reads names, decorations and uses out of SPIR-V. Throws `internal` for a set other than 0 and
/// for an array of anything but textures. Shaders may index such arrays by constants only, because
/// not every device can do more.
ShaderReflection reflect_spirv(std::string_view name, std::span<const std::uint32_t> words);

} // namespace catoptric::gpu
