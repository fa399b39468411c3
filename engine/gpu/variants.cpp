#include "gpu/variants.hpp"

namespace catoptric::gpu {

namespace {

constexpr std::array<ShaderVariant, kVariantCount> kShaderVariants{
    {{"groups",
      {"scattered", "in order"},
      "groups_in_order",
      "order of the ray tracer's work groups: scattered over the picture, or row by row"},
     {"hierarchy",
      {"texel", "storage"},
      "bvh_in_storage",
      "buffers that rays fetch nodes and triangles from"},
     {"pixels",
      {"blocks", "rows"},
      "pixels_in_rows",
      "shape of eight pixels that run together: 4x2, or 8x1"}}};

} // namespace

std::span<const ShaderVariant, kVariantCount> shader_variants() { return kShaderVariants; }

} // namespace catoptric::gpu
