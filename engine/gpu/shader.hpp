#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::gpu {

/// SPIR-V that was compiled at build time; `name` is the path below shaders/, "#variant" appended.
struct EmbeddedShader {
    std::string_view name;
    std::span<const std::uint32_t> words;
};
std::span<const EmbeddedShader> embedded_shaders();
/// Adds one of a program's own, before anything uses the table; name and words stay the caller's.
/// Throws `Failure::usage` for a name that is taken.
void add_shader(const EmbeddedShader& shader);
/// Of both kinds. Throws `Failure::internal` for a name that there is not.
const EmbeddedShader& find_shader(std::string_view name);

enum class BindingKind {
    uniform_buffer,
    storage_buffer,
    texel_buffer,
    sampled_image, ///< with a sampler of its own
    texture,       ///< without one
    sampler,
    storage_image
};
enum class ImageShape { flat, flat_array, cube, cube_array };

/// One resource that a shader's code really uses, in set 0.
struct Binding {
    std::string name; ///< of the variable, or of the block
    std::uint32_t binding = 0;
    BindingKind kind = BindingKind::storage_buffer;
    ImageShape shape = ImageShape::flat;
    std::uint32_t count = 1; ///< of an array of textures
};

struct Constant {
    std::string name;
    std::uint32_t id = 0; ///< constant_id
};

/// What the engine must know of a shader to make a pipeline and bind by name.
struct Reflection {
    std::vector<Binding> bindings;
    std::vector<Constant> constants;
    std::uint32_t push_bytes = 0;
    bool doubles = false; ///< needs a device that computes with them
};

/// Reads names, decorations and uses out of SPIR-V. Throws `internal` for a set other than 0 and
/// for an array of anything but textures (which shaders may index by constants only: not every
/// device can do more).
Reflection reflect(std::string_view name, std::span<const std::uint32_t> words);

} // namespace catoptric::gpu
