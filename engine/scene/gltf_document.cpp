#include "scene/gltf_document.hpp"

#include "scene/repair.hpp"

#include <numbers>

namespace catoptric::scene::gltf {

namespace {

dvec3 colour(const std::vector<double>& factor, double otherwise) {
    return factor.empty() ? dvec3(otherwise) : dvec3(factor[0], factor[1], factor[2]);
}

double emissive_strength(const Item& material) {
    const std::optional<Item> extensions = material.object("extensions");
    if (!extensions) return 1;
    const std::optional<Item> strength = extensions->object("KHR_materials_emissive_strength");
    return strength ? strength->number("emissiveStrength", 1) : 1;
}

Material material_of(const Item& from, Notes& notes) {
    Material material{.name = from.name()};
    const std::optional<Item> pbr = from.object("pbrMetallicRoughness");
    const double metallic = pbr ? pbr->number("metallicFactor", 1) : 1;
    const double roughness = pbr ? pbr->number("roughnessFactor", 1) : 1;
    material.mirror = metallic == 1 && roughness == 0;
    if (!material.mirror && !(metallic == 0 && roughness == 1))
        notes.add("materials neither a perfect mirror (metallic 1, roughness 0) nor diffuse "
                  "(metallic 0, roughness 1), drawn as diffuse",
                  from.label());
    const std::vector<double> factor = pbr ? pbr->numbers("baseColorFactor", 4)
                                           : std::vector<double>();
    const dvec3 base = glm::clamp(colour(factor, 1), 0.0, 1.0);
    (material.mirror ? material.reflectance : material.albedo) = vec3(base);
    material.emission = vec3(emissive_strength(from) *
                             colour(from.numbers("emissiveFactor", 3), 0));
    material.two_sided = from.flag("doubleSided", false) && material.emission != vec3(0);
    from.require(is_radiance(material.emission),
                 "wanted an emission of at least 0 that fits a float, found another");
    return material;
}

std::optional<Camera> camera_of(const Item& from, Notes& notes) {
    const std::string type = from.text("type");
    if (type == "orthographic") {
        notes.add("orthographic cameras, left out", from.label());
        return std::nullopt;
    }
    const std::optional<Item> perspective = from.object("perspective");
    from.require(type == "perspective" && perspective,
                 "wanted a perspective or orthographic camera, "
                 "found neither");
    const double fov = perspective->number("yfov", 0);
    perspective->require(fov > 0 && fov < std::numbers::pi,
                         "yfov: wanted an angle between 0 and pi, found ", fov);
    return Camera{.name = from.name(), .vertical_fov_degrees = glm::degrees(fov)};
}

} // namespace

Document read(const Item& root, Context& context) {
    note_unread(root, context);
    Document document;
    root.each("materials", [&](const Item& item) {
        context.account.materials.add(1, item.place());
        document.materials.push_back(material_of(item, context.notes));
    });
    root.each("cameras", [&](const Item& item) {
        context.account.cameras.add(1, item.place());
        document.cameras.push_back(camera_of(item, context.notes));
    });
    document.meshes = read_meshes(root, document.materials, context);
    document.nodes = read_nodes(root, context);
    check_forest(root, document.nodes);
    document.roots = read_roots(root, document.nodes);
    read_animations(root, document.nodes, context);
    return document;
}

} // namespace catoptric::scene::gltf
