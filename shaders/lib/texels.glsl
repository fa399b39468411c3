// Texel lists: lists that each invocation reads at a different index. Texel lists are uniform texel buffers, because a
// software driver reads storage buffers lane by lane (docs/performance.md). On devices that allow few texels in a
// buffer (gpu::Device::texels_in_storage), the same data is bound as storage buffers.
#ifndef CATOPTRIC_TEXELS_GLSL
#define CATOPTRIC_TEXELS_GLSL

#include "lib/constants.glsl"

layout(constant_id = TEXELS_IN_STORAGE_CONSTANT) const uint texels_in_storage = 0u;

#define STORED_TEXELS 64 // offset from a texel buffer's binding number to that of the storage buffer with the same data

// Declares a texel list of type `vector` (vec4, uvec4 or uint), which the engine binds as `name` and name_at(i) reads.
// With `stored`, the list is in a storage buffer on every device.
#define TEXEL_LIST(number, name, vector, sampler, stored)                                                              \
    layout(set = 0, binding = number) uniform sampler name;                                                            \
    layout(set = 0, binding = number + STORED_TEXELS, std430) readonly buffer name##_in_storage {                      \
        vector name##_stored[];                                                                                        \
    };                                                                                                                 \
    vector name##_at(uint i) {                                                                                         \
        if (texels_in_storage != 0u || stored) return name##_stored[i];                                                \
        return vector(texelFetch(name, int(i)));                                                                       \
    }

#endif
