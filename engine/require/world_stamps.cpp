#include "require/world_stamps.hpp"

#include <map>

namespace catoptric::require {

namespace {

template <typename Value>
void add(Stamp& stamp, const std::vector<Value>& values) {
    stamp.add_all(std::span<const Value>(values));
}

/// Of images, each looked at once however many materials show it.
class Images {
public:
    std::uint64_t operator[](const std::shared_ptr<const scene::Image>& image) {
        const auto [entry, is_new] = known_.try_emplace(image.get(), 0);
        if (!is_new || !image) return entry->second;
        Stamp stamp;
        stamp.add(image->size);
        add(stamp, image->texels);
        return entry->second = stamp.value();
    }

private:
    std::map<const scene::Image*, std::uint64_t> known_;
};

void add(Stamp& stamp, const std::optional<scene::Texture>& texture, Images& images) {
    stamp.add(texture.has_value());
    if (!texture) return;
    stamp.add(images[texture->image]).add(texture->wrap_u).add(texture->wrap_v);
    stamp.add(texture->nearest).add(texture->srgb).add(texture->uv_set);
    stamp.add(texture->u_row).add(texture->v_row);
}

} // namespace

std::uint64_t stamp_of(const scene::Mesh& mesh) {
    Stamp stamp;
    add(stamp, mesh.positions), add(stamp, mesh.normals), add(stamp, mesh.triangles);
    add(stamp, mesh.uv[0]), add(stamp, mesh.uv[1]), add(stamp, mesh.colours);
    return stamp.value();
}

std::uint64_t stamp_of(const std::vector<scene::Material>& materials) {
    Stamp stamp;
    Images images;
    for (const scene::Material& m : materials) {
        stamp.add(m.albedo).add(m.emission).add(m.mirror).add(m.reflectance).add(m.two_sided);
        stamp.add(m.front_only).add(m.unlit).add(m.metallic).add(m.roughness);
        stamp.add(m.dielectric_f0).add(m.dielectric_f90).add(m.alpha).add(m.alpha_cutoff);
        add(stamp, m.albedo_texture, images), add(stamp, m.emission_texture, images);
        add(stamp, m.roughness_texture, images);
        stamp.add(scene::light_of(m));
    }
    return stamp.value();
}

std::uint64_t stamp_of(const scene::Environment* environment) {
    if (environment == nullptr) return 0;
    Stamp stamp(1);
    stamp.add(environment->studio).add(environment->size);
    add(stamp, environment->texels);
    stamp.add(environment->scale).add(environment->rotation_degrees);
    return stamp.value();
}

std::uint64_t stamp_of(const scene::PointLight& light) {
    Stamp stamp;
    stamp.add(light.position).add(light.normal).add(light.area).add(light.emission);
    stamp.add(light.closed).add(light.axes).add(light.cosines);
    stamp.add(light.axis).add(light.range).add(light.cos_inner).add(light.cos_outer);
    return stamp.add(light.directional).value();
}

} // namespace catoptric::require
