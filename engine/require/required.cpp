#include "core/stamp.hpp"
#include "require/model.hpp"

namespace catoptric::require {

namespace {

/// Of all that can be seen anywhere.
std::uint64_t stamp_of(const scene::Scene& now) {
    Stamp stamp;
    for (const scene::Object& object : now.objects) {
        const scene::Material& material = now.materials[object.material];
        stamp.add(object.mesh)
            .add(object.world_from_object)
            .add(material.albedo)
            .add(material.emission);
        stamp.add(material.mirror).add(material.reflectance).add(object.mirror);
    }
    for (const scene::PointLight& light : scene::lights(now))
        stamp.add(light.position)
            .add(light.normal)
            .add(light.emission)
            .add(light.area)
            .add(light.axis);
    return stamp.value();
}

} // namespace

Model required(const Question& question) {
    Model model = everything(question);
    model.is_everything = false;
    const std::uint64_t stamp = stamp_of(question.now);
    for (std::uint32_t i = 0; i < model.mirrors.size(); ++i) {
        model.mirrors[i].stamps.fill(stamp);
        for (std::uint32_t other = 0; other < model.mirrors.size(); ++other)
            if (other != i) model.mirrors[i].sees.push_back(other);
    }
    for (LightNeeds& light : model.lights) light.stamp = stamp;
    return model;
}

} // namespace catoptric::require
