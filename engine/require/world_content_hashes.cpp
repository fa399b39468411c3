#include "require/world_content_hashes.hpp"
#include "scene/light.hpp"
#include "scene/material_facts.hpp"

#include "scene/light_kind.hpp"

#include <map>
#include <type_traits>

namespace catoptric::require {

namespace {

template <typename Value>
void hash_values(ContentHash& content_hash, const std::vector<Value>& values) {
    content_hash.add_values(std::span<const Value>(values));
}

/// Each image is hashed once, even if several materials use it.
class ImageHashes {
public:
    std::uint64_t operator[](const std::shared_ptr<const scene::Image>& image) {
        const auto [entry, is_new] = known_.try_emplace(image.get(), 0);
        if (!is_new || !image) return entry->second;
        ContentHash content_hash;
        content_hash.add(image->size);
        hash_values(content_hash, image->texels);
        return entry->second = content_hash.sum();
    }

private:
    std::map<const scene::Image*, std::uint64_t> known_;
};

void hash_texture(ContentHash& content_hash, const std::optional<scene::Texture>& texture,
                  ImageHashes& images) {
    content_hash.add(texture.has_value());
    if (!texture) return;
    content_hash.add(images[texture->image]).add(texture->wrap_u).add(texture->wrap_v);
    content_hash.add(texture->nearest).add(texture->srgb).add(texture->uv_set);
    content_hash.add(texture->u_row).add(texture->v_row);
}

} // namespace

std::uint64_t hash_mesh(const scene::Mesh& mesh) {
    ContentHash content_hash;
    hash_values(content_hash, mesh.positions), hash_values(content_hash, mesh.normals),
        hash_values(content_hash, mesh.triangles);
    hash_values(content_hash, mesh.uv[0]), hash_values(content_hash, mesh.uv[1]),
        hash_values(content_hash, mesh.colours);
    return content_hash.sum();
}

std::uint64_t hash_materials(const std::vector<scene::Material>& materials) {
    ContentHash content_hash;
    ImageHashes images;
    const auto add_member = [&](const auto& member) {
        using Member = std::remove_cvref_t<decltype(member)>;
        if constexpr (std::is_same_v<Member, std::optional<scene::Texture>>)
            hash_texture(content_hash, member, images);
        else if constexpr (std::is_same_v<Member, std::optional<vec3>>)
            content_hash.add(member.has_value()).add(member.value_or(vec3(0)));
        else if constexpr (!std::is_same_v<Member, std::string>) // no picture shows a name
            content_hash.add(member);
    };
    for (const scene::Material& material : materials)
        scene::visit_material_members(material, add_member);
    return content_hash.sum();
}

std::uint64_t hash_environment(const scene::Environment* environment) {
    if (environment == nullptr) return 0;
    ContentHash content_hash(1);
    content_hash.add(environment->studio).add(environment->size);
    hash_values(content_hash, environment->texels);
    content_hash.add(environment->scale).add(environment->rotation_degrees);
    return content_hash.sum();
}

std::uint64_t hash_point_light(const scene::PointLight& light) {
    ContentHash content_hash;
    scene::visit_light_members(light, [&](const auto& member) { content_hash.add(member); });
    return content_hash.sum();
}

} // namespace catoptric::require
