#include "core/error.hpp"
#include "core/file.hpp"
#include "scene/obj_text.hpp"
#include "scene/repair.hpp"

namespace catoptric::scene::obj {

namespace {

vec3 colour(const Line& line) {
    const std::vector<double> rgb = numbers(line, words(line), 0, 3);
    return vec3(dvec3(rgb[0], rgb[1], rgb[2]));
}

vec3 reflectance(const Line& line) { return glm::clamp(colour(line), 0.0f, 1.0f); }

vec3 radiance(const Line& line) {
    const vec3 emission = colour(line);
    check(is_radiance(emission), Failure::bad_data, line.where,
          ": 'Ke' wants radiance of at least 0 that fits a float, found '", line.rest, "'");
    return emission;
}

void add_statement(std::vector<Material>& materials, const Line& line) {
    if (line.keyword == "newmtl")
        materials.push_back({.name = std::string(line.rest)});
    else if (materials.empty())
        return; // nothing to say it of
    else if (line.keyword == "Kd")
        materials.back().albedo = reflectance(line);
    else if (line.keyword == "Ks")
        materials.back().reflectance = reflectance(line);
    else if (line.keyword == "Ke")
        materials.back().emission = radiance(line);
    else if (line.keyword == "illum")
        materials.back().mirror = numbers(line, words(line), 0, 1)[0] == 3;
}

} // namespace

std::vector<Material> read_materials(const std::filesystem::path& path) {
    std::vector<Material> materials;
    for_each_line(path.string(), read_file(path),
                  [&](const Line& line) { add_statement(materials, line); });
    // Ks of anything but a perfect mirror is a highlight, which this engine has not
    for (Material& material : materials)
        if (!material.mirror) material.reflectance = vec3(1);
    return materials;
}

} // namespace catoptric::scene::obj
