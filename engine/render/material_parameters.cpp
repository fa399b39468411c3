#include "render/material_parameters.hpp"

#include "core/error.hpp"
#include "core/shader_math.hpp"
#include "core/text.hpp"
#include "render/facets.hpp"
#include "scene/nested_glass.hpp"
#include "scene/texel.hpp"
#include "scene/topology.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <unordered_map>

namespace catoptric::render {

namespace {

constexpr std::size_t kMaterialTableTexels = shared::kSrgbTableWords +
                                             shared::kLobeTableEdge * shared::kLobeTableEdge;

std::uint32_t to_unorm16(float value) {
    return static_cast<std::uint32_t>(std::lround(std::clamp(value, 0.f, 1.f) * 65535));
}

/// Computes the albedo of rough lobes by roughness (rows) and by the root of the cosine (columns),
/// because the albedo changes most at grazing angles. Each entry is two 16-bit fractions of 1:
/// f32::lobe_albedo_terms. Takes about 0.1 s.
std::vector<std::uint32_t> compute_lobe_albedos() {
    constexpr std::uint32_t kLobeTableEdgeTexels = shared::kLobeTableEdge;
    constexpr int kLobeSampleGridEdge = 64;
    // Least cosine, because no direction is sampled at a cosine of 0.
    constexpr float kMinLobeCosine = 1e-4f;
    std::vector<std::uint32_t> words;
    for (std::uint32_t y = 0; y < kLobeTableEdgeTexels; ++y)
        for (std::uint32_t x = 0; x < kLobeTableEdgeTexels; ++x) {
            const float root = static_cast<float>(x) / (kLobeTableEdgeTexels - 1);
            float head_on, grazing;
            f32::lobe_albedo_terms(
                f32::roughness_to_alpha(static_cast<float>(y) / (kLobeTableEdgeTexels - 1)),
                std::max(root * root, kMinLobeCosine), kLobeSampleGridEdge, head_on, grazing);
            words.push_back(to_unorm16(head_on) | to_unorm16(grazing) << 16);
        }
    return words;
}

/// Returns compute_lobe_albedos, which the first call computes.
const std::vector<std::uint32_t>& lobe_albedo_table() {
    static const std::vector<std::uint32_t> kTable = compute_lobe_albedos();
    return kTable;
}

std::uint32_t flag_if_set(bool is_set, std::uint32_t flag) { return is_set ? flag : 0; }

shared::MaterialParameters make_parameters(const scene::Material& material,
                                           const DrawRange& range) {
    shared::MaterialParameters detail{};
    detail.flags = flag_if_set(range.varies, shared::kMaterialVariesFlag) |
                   flag_if_set(range.first_attribute.has_value(),
                               shared::kMaterialHasAttributesFlag) |
                   flag_if_set(material.mirror, shared::kMaterialConstantReflectanceFlag) |
                   flag_if_set(material.unlit, shared::kMaterialUnlitFlag) |
                   flag_if_set(range.turns, shared::kMaterialTwoSidedFlag) |
                   flag_if_set(range.glass, shared::kMaterialGlassFlag) |
                   flag_if_set(range.blended, shared::kMaterialBlendedFlag);
#define COPY_FACTOR(name, extension, key, gltf_default, largest) detail.name = material.name;
    MATERIAL_FACTORS(COPY_FACTOR)
#undef COPY_FACTOR
    detail.alpha = material.alpha, detail.alpha_cutoff = material.alpha_cutoff;
    detail.f0 = material.dielectric_f0, detail.f90 = material.dielectric_f90;
    return detail;
}

} // namespace

MaterialLists::MaterialLists(std::size_t slots)
    : detail_words_("details", gpu::BufferUsage::quads, slots),
      attributes_("attributes", gpu::BufferUsage::texels, slots),
      texels_("texels", gpu::BufferUsage::words, slots) {}

shared::TextureUse MaterialLists::texture_use(const std::optional<scene::Texture>& texture) const {
    shared::TextureUse use{};
    if (!texture) return use;
    const auto at = std::ranges::find(images_, texture->image) - images_.begin();
    use.first = first_texels_[static_cast<std::size_t>(at)];
    use.size = texture->image->size.x | texture->image->size.y << 16;
    use.how = static_cast<std::uint32_t>(texture->wrap_u) |
              static_cast<std::uint32_t>(texture->wrap_v) << 2 |
              flag_if_set(texture->nearest, shared::kTextureNearestFlag) |
              flag_if_set(texture->srgb, shared::kTextureSrgbFlag) |
              flag_if_set(texture->uv_set == 1, shared::kTextureSecondUvFlag);
    use.u_row = texture->u_row, use.v_row = texture->v_row;
    return use;
}

void MaterialLists::fill_texels(const scene::Scene& now, std::uint64_t most) {
    std::vector<std::shared_ptr<const scene::Image>> images;
    std::uint64_t count = kMaterialTableTexels;
    for (const scene::Object& object : now.objects) {
        const scene::Material& material = now.materials[object.material];
        for (const auto* texture : {&material.albedo_texture, &material.emission_texture,
                                    &material.roughness_texture, &material.normal_texture}) {
            if (!*texture || std::ranges::find(images, (*texture)->image) != images.end()) continue;
            images.push_back((*texture)->image);
            count += images.back()->texels.size();
            check(count <= most, Failure::exhausted, "scene '", now.name, "': its images up to ",
                  quote(images.back()->name), " take ", count, " texels, the device allows ", most);
        }
    }
    if (images == images_ && has_lobes_ == has_lobe_table_ && texels_filled_) return;
    has_lobe_table_ = has_lobes_, texels_filled_ = true;
    std::vector<std::uint32_t> texels;
    texels.reserve(count);
    for (std::uint32_t byte = 0; byte < shared::kSrgbTableWords; ++byte)
        texels.push_back(std::bit_cast<std::uint32_t>(scene::linear_from_srgb(byte)));
    if (has_lobes_)
        texels.insert(texels.end(), lobe_albedo_table().begin(), lobe_albedo_table().end());
    else
        texels.resize(kMaterialTableTexels);
    first_texels_ = {};
    for (const auto& image : images) {
        first_texels_.push_back(static_cast<std::uint32_t>(texels.size()));
        texels.insert(texels.end(), image->texels.begin(), image->texels.end());
    }
    images_ = std::move(images);
    texels_.set(texels);
}

namespace {

/// Returns the flag of an open sheet or of a solid body of glass; 0: the glass is a thin shell.
/// `closed`: whether meshes are closed, as far as known.
std::uint32_t glass_body_flag(const scene::Scene& now, const scene::Object& object,
                              std::map<std::size_t, bool>& closed) {
    const auto [entry, is_new] = closed.try_emplace(object.mesh, false);
    const scene::Mesh& mesh = now.meshes[object.mesh];
    if (is_new) entry->second = scene::is_closed_surface(mesh.positions, mesh.triangles);
    if (!entry->second) return shared::kMaterialOpenSheetFlag;
    return now.materials[object.material].solid ? shared::kMaterialSolidFlag : 0;
}

} // namespace

shared::MaterialParameters MaterialLists::object_parameters(const scene::Scene& now,
                                                            const SceneUnits& space,
                                                            const scene::Material& material,
                                                            const DrawRange& range,
                                                            const DeviceVertices& vertices) const {
    shared::MaterialParameters detail = make_parameters(material, range);
    detail.ior = material.ior;
    detail.absorption = material.absorption / space.to_scene_length(1);
    detail.max_specular_roughness = now.mirror_max_roughness;
    detail.flags |= flag_if_set(now.has_multiple_scattering && range.has_lobe,
                                shared::kMaterialMultipleScatteringFlag);
    // The difference may be negative as an unsigned number, because draws count vertices from the
    // start of their own buffer. Adding it wraps around to the right value.
    if (range.first_attribute)
        detail.first_attribute = *range.first_attribute - vertices.first_vertex(range.storage);
    detail.albedo = texture_use(material.albedo_texture);
    detail.emission = texture_use(material.emission_texture);
    detail.rough = texture_use(material.roughness_texture);
    detail.normal = texture_use(material.normal_texture);
    detail.normal_scale = material.normal_scale;
    return detail;
}

void MaterialLists::fill(const scene::Scene& now, const SceneUnits& space,
                         const FrameGeometry& geometry, const DeviceVertices& vertices,
                         std::uint64_t most) {
    has_lobes_ = std::ranges::any_of(geometry.ranges, &DrawRange::has_lobe);
    has_glass_ = std::ranges::any_of(geometry.ranges, &DrawRange::glass);
    has_tinted_shadows_ = std::ranges::any_of(geometry.ranges, &DrawRange::tints);
    has_clear_coats_ = std::ranges::any_of(geometry.ranges, &DrawRange::clear_coat);
    has_blended_ = std::ranges::any_of(geometry.ranges, &DrawRange::blended);
    fill_texels(now, most);
    std::vector<shared::MaterialParameters> details;
    std::unordered_map<std::string, std::uint32_t> known; // index by the bytes of the parameters
    indices_.assign(geometry.ranges.size(), 0);
    has_varying_colours_ = has_masks_ = has_normal_textures_ = has_ranked_glass_ = false;
    std::vector<std::uint32_t> ranks(geometry.ranges.size());
    if (has_glass_) ranks = scene::rank_nested_glass(now);
    std::vector<std::size_t> order(geometry.ranges.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater(),
                             [&](std::size_t i) { return ranks[i]; });
    std::map<std::size_t, bool> leaves, closed; // by mesh
    for (const std::size_t i : order) {
        const DrawRange& range = geometry.ranges[i];
        const scene::Material& material = now.materials[now.objects[i].material];
        shared::MaterialParameters detail = object_parameters(now, space, material, range,
                                                              vertices);
        if (range.glass) {
            detail.flags |= glass_body_flag(now, now.objects[i], closed);
            if (ranks[i] > 0 && details.size() < shared::kMaxRankedGlass) {
                detail.flags |= shared::kMaterialRankedFlag;
                has_ranked_glass_ = true;
            }
        }
        has_normal_textures_ = has_normal_textures_ || range.has_normal_texture;
        has_varying_colours_ = has_varying_colours_ || range.varies || range.turns;
        if (material.albedo != vec3(0) && !(range.mirror && !range.lit)) {
            const std::size_t mesh = now.objects[i].mesh;
            const auto [entry, is_new] = leaves.try_emplace(mesh, false);
            if (is_new) entry->second = normals_differ_from_facets(now.meshes[mesh]);
            const bool differs = entry->second || range.has_normal_texture;
            detail.flags |= flag_if_set(differs, shared::kMaterialTestsFacetSideFlag);
            has_varying_colours_ = has_varying_colours_ || differs;
        }
        has_masks_ = has_masks_ || range.masked;
        std::array<char, 4 * shared::kWordsPerMaterial> bytes{}; // all bytes except the padding
        std::memcpy(bytes.data(), &detail, bytes.size());
        const auto [entry, is_new] = known.try_emplace(std::string(bytes.data(), bytes.size()) +
                                                           std::to_string(ranks[i]),
                                                       static_cast<std::uint32_t>(details.size()));
        if (is_new) details.push_back(detail);
        indices_[i] = entry->second;
    }
    if (details.empty()) details.emplace_back(); // buffers must not be empty
    detail_words_.set(details);
    attributes_.set(geometry.attributes.empty() ? std::vector<shared::VertexAttribute>(1)
                                                : geometry.attributes);
}

std::size_t MaterialLists::write(gpu::Device& device, std::size_t slot) {
    return detail_words_.write(device, slot) + attributes_.write(device, slot) +
           texels_.write(device, slot);
}

void MaterialLists::bind(graph::PassCommands& commands, std::size_t slot) const {
    commands.bind("detail_quads", detail_words_.buffer(slot));
    commands.bind("attribute_texels", attributes_.buffer(slot));
    commands.bind("texture_words", texels_.buffer(slot));
}

} // namespace catoptric::render
