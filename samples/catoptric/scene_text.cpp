#include "scene_text.hpp"

#include "core/text.hpp"
#include "report/comparison.hpp"
#include "report/tables.hpp"
#include "scene/material_facts.hpp"
#include "table.hpp"

#include <fmt/format.h>

namespace catoptric::cli {

namespace {

using SceneCells = std::vector<std::vector<std::string>>;

std::string point_text(const dvec3& p) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", p.x, p.y, p.z);
}

/// Returns a colour as text: one number if all channels are equal, else three.
std::string colour_text(const vec3& c) {
    return c.x == c.y && c.y == c.z ? fmt::format("{:.3g}", c.x)
                                    : fmt::format("{:.3g} {:.3g} {:.3g}", c.x, c.y, c.z);
}

std::string bytes_text(std::uint64_t bytes) {
    return bytes < 1'000'000 ? fmt::format("{:.1f} kB", 1e-3 * static_cast<double>(bytes))
                             : fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(bytes));
}

std::string line(const std::string& name, const std::string& value) {
    return fmt::format("{:<12} {}\n", name, value);
}

/// Returns a table under its title; empty if it has no rows.
std::string table(const std::string& title, const SceneCells& cells) {
    return cells.size() < 2 ? "" : "\n" + title + "\n" + aligned(cells, 0);
}

/// The first factors, metallic and roughness, have columns of their own.
constexpr std::size_t kFactorColumns = 2;

std::string how(const app::MaterialInfo& material) {
    std::string text;
    const auto add = [&](const std::string& word) { text += (text.empty() ? "" : ", ") + word; };
    if (material.light != vec3(0)) add("lights " + colour_text(material.light));
    if (material.light == vec3(0) && material.glows) add("glows, lights nothing");
    if (material.is_masked) add("cut by alpha");
    if (!material.is_two_sided) add("front only");
    for (std::size_t i = kFactorColumns; i < material.factors.size(); ++i)
        if (const auto& factor = scene::kMaterialFactors[i];
            material.factors[i] != scene::Material().*factor.member)
            add(fmt::format("{} {:.3g}", factor.name, material.factors[i]));
    for (const std::string& texture : material.textures) add(texture);
    return text.empty() ? "-" : text;
}

SceneCells materials(const app::SceneInfo& info) {
    constexpr std::size_t kMost = 50;
    SceneCells cells{
        {"material", "is", "objects", "colour", "metallic", "roughness", "F0", "more"}};
    for (const app::MaterialInfo& material : info.materials) {
        if (cells.size() > kMost) {
            cells.push_back({fmt::format("... {} more: --json", info.materials.size() - kMost), "",
                             "", "", "", "", "", ""});
            break;
        }
        cells.push_back({printable(material.name), material.kind, std::to_string(material.objects),
                         colour_text(material.albedo), fmt::format("{:.3g}", material.factors[0]),
                         fmt::format("{:.3g}", material.factors[1]), colour_text(material.f0),
                         how(material)});
    }
    return cells;
}

std::string shape_text(const scene::Shape& shape) {
    std::string text = scene::name_of(shape.kind);
    text += shape.is_closed ? ", closed" : ", open";
    if (shape.fit)
        text += fmt::format(", radius {:.4g} within {:.2g}", shape.fit->radius, shape.tolerance);
    return text;
}

SceneCells mirrors(const app::SceneInfo& info) {
    SceneCells cells{{"mirror", "name", "shape", "screen", "reflects", "captured from"}};
    for (const app::MirrorInfo& mirror : info.mirrors)
        cells.push_back({std::to_string(mirror.number), printable(mirror.name),
                         shape_text(mirror.shape),
                         fmt::format("{:.1f} %", 100 * mirror.screen_share),
                         colour_text(mirror.reflectance) + (mirror.is_constant ? "" : " and up"),
                         point_text(mirror.capture_centre)});
    return cells;
}

SceneCells lights(const report::SceneFacts& facts) {
    SceneCells cells{{"light", "name", "at", "towards", "emits", "area"}};
    for (const report::LightFacts& light : facts.lights)
        cells.push_back({light.kind, light.name.empty() ? "-" : printable(light.name),
                         light.is_parallel ? "-" : point_text(light.position),
                         light.direction == dvec3(0) ? "-" : point_text(light.direction),
                         colour_text(vec3(light.emission)),
                         light.kind == "mesh" ? fmt::format("{:.4g}", light.area) : "-"});
    return cells;
}

std::string lens_text(const measure::CameraFacts& camera) {
    return camera.orthographic_height > 0
               ? fmt::format("{:.4g} high, orthographic", camera.orthographic_height)
               : fmt::format("{:.4g} degrees", camera.vertical_fov_degrees);
}

std::string camera_text(const measure::CameraFacts& camera) {
    return fmt::format("{}: from {} to {}, {}", in_quotes(camera.name), point_text(camera.eye),
                       point_text(camera.target), lens_text(camera));
}

std::string environment_text(const report::SceneFacts& facts) {
    if (!facts.environment) return "none";
    const report::EnvironmentFacts& environment = *facts.environment;
    std::string text = printable(environment.name);
    if (environment.scale != 1) text += fmt::format(", times {:.4g}", environment.scale);
    if (environment.rotation_degrees != 0)
        text += fmt::format(", turned by {:.4g} degrees", environment.rotation_degrees);
    return text;
}

std::string exposure_text(const SceneWords& words) {
    if (!words.exposure) return "auto; not told";
    // The exposure that `render` finds, for the camera that is given or added.
    const std::string how = words.auto_exposure ? " (auto, by camera " +
                                                      in_quotes(words.info.facts.camera.name) + ")"
                                                : "";
    return fmt::format("{:.4g} stops{}", *words.exposure, how);
}

SceneCells unsupported(const report::SceneFacts& facts) {
    const report::Table table = report::unsupported_table(facts);
    SceneCells cells{{"gap", "count", "pixels", "first", "instead"}};
    for (const std::vector<std::string>& row : table.rows) {
        cells.push_back(row);
        cells.back()[3] = printable(cells.back()[3]);
        if (facts.unsupported[cells.size() - 2].pixel_share) cells.back()[2] += " %";
    }
    return cells;
}

} // namespace

std::string scene_text(const SceneWords& words) {
    const app::SceneInfo& info = words.info;
    const report::SceneFacts& facts = info.facts;
    std::string text = line("scene", printable(facts.name) + ", hash " + facts.hash);
    if (!words.scene_file.empty()) text += line("scene file", printable(words.scene_file));
    text += line("triangles",
                 fmt::format("{} shown, {} stored", facts.triangles, info.stored_triangles));
    text += line("objects", fmt::format("{} of {} meshes, {} of them instances", info.objects,
                                        info.meshes, info.instances));
    text += line("bytes",
                 fmt::format("geometry {}, images {}, files {}", bytes_text(info.geometry_bytes),
                             bytes_text(info.image_bytes), bytes_text(info.file_bytes)));
    text += line("environment", environment_text(facts));
    text += line("ambient", fmt::format("{:.4g}", words.ambient));
    text += line("exposure", exposure_text(words));
    text += line("camera", camera_text(facts.camera));
    for (std::size_t i = 0; i < info.cameras.size(); ++i)
        text += line(i == 0 ? "cameras" : "",
                     fmt::format("{} {}", i, camera_text(info.cameras[i])));
    text += table("Materials", materials(info)) + table("Mirrors", mirrors(info)) +
            table("Lights", lights(facts));
    if (info.mirrors.empty()) {
        text += info.mirror_options.empty()
                    ? "\nNo mirror\n"
                    : "\nNo mirror; the smoothest surfaces become one with\n";
        for (const std::string& option : info.mirror_options) text += "  " + option + "\n";
    }
    return text + table("Added, approximated, left out", unsupported(facts));
}

} // namespace catoptric::cli
