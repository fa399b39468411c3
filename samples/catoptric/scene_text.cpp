#include "scene_text.hpp"

#include "core/text.hpp"
#include "report/comparison.hpp"
#include "report/tables.hpp"
#include "scene/material_facts.hpp"
#include "table.hpp"

#include <fmt/format.h>

namespace catoptric::cli {

namespace {

using SceneTableCells = std::vector<std::vector<std::string>>;

std::string format_point(const dvec3& p) {
    return fmt::format("{:.4g} {:.4g} {:.4g}", p.x, p.y, p.z);
}

/// Returns a colour as text: one number if all channels are equal, else three.
std::string format_colour(const vec3& c) {
    return c.x == c.y && c.y == c.z ? fmt::format("{:.3g}", c.x)
                                    : fmt::format("{:.3g} {:.3g} {:.3g}", c.x, c.y, c.z);
}

std::string format_bytes(std::uint64_t bytes) {
    return bytes < 1'000'000 ? fmt::format("{:.1f} kB", 1e-3 * static_cast<double>(bytes))
                             : fmt::format("{:.1f} MB", 1e-6 * static_cast<double>(bytes));
}

std::string format_info_line(const std::string& name, const std::string& value) {
    return fmt::format("{:<12} {}\n", name, value);
}

/// Empty if the table has no rows.
std::string titled_table(const std::string& title, const SceneTableCells& cells) {
    return cells.size() < 2 ? "" : "\n" + title + "\n" + align_columns(cells, 0);
}

/// The first factors, metallic and roughness, have columns of their own.
constexpr std::size_t kMaterialFactorColumns = 2;

std::string describe_material(const session::MaterialInfo& material) {
    std::string text;
    const auto add = [&](const std::string& word) { text += (text.empty() ? "" : ", ") + word; };
    if (material.light != vec3(0)) add("lights " + format_colour(material.light));
    if (material.light == vec3(0) && material.glows) add("glows, lights nothing");
    if (material.is_masked) add(material.is_blended ? "blended by alpha" : "cut by alpha");
    if (!material.is_two_sided) add("front only");
    for (std::size_t i = kMaterialFactorColumns; i < material.factors.size(); ++i)
        if (const auto& factor = scene::kMaterialFactors[i];
            material.factors[i] != scene::Material().*factor.member)
            add(fmt::format("{} {:.3g}", factor.name, material.factors[i]));
    for (const std::string& texture : material.textures) add(texture);
    return text.empty() ? "-" : text;
}

SceneTableCells material_cells(const session::SceneInfo& info) {
    constexpr std::size_t kMaxListedMaterials = 50;
    SceneTableCells cells{
        {"material", "is", "objects", "colour", "metallic", "roughness", "F0", "more"}};
    for (const session::MaterialInfo& material : info.materials) {
        if (cells.size() > kMaxListedMaterials) {
            cells.push_back(
                {fmt::format("... {} more: --json", info.materials.size() - kMaxListedMaterials),
                 "", "", "", "", "", "", ""});
            break;
        }
        cells.push_back({escape(material.name), material.kind, std::to_string(material.objects),
                         format_colour(material.albedo), fmt::format("{:.3g}", material.factors[0]),
                         fmt::format("{:.3g}", material.factors[1]), format_colour(material.f0),
                         describe_material(material)});
    }
    return cells;
}

std::string describe_shape(const scene::MirrorShape& shape) {
    std::string text = scene::shape_name(shape.kind);
    text += shape.is_closed ? ", closed" : ", open";
    if (shape.fit)
        text += fmt::format(", radius {:.4g} within {:.2g}", shape.fit->radius, shape.tolerance);
    return text;
}

SceneTableCells mirror_cells(const session::SceneInfo& info) {
    SceneTableCells cells{{"mirror", "name", "shape", "screen", "reflects", "captured from"}};
    for (const session::MirrorInfo& mirror : info.mirrors)
        cells.push_back({std::to_string(mirror.number), escape(mirror.name),
                         describe_shape(mirror.shape),
                         fmt::format("{:.1f} %", 100 * mirror.screen_share),
                         format_colour(mirror.reflectance) + (mirror.is_constant ? "" : " and up"),
                         format_point(mirror.capture_centre)});
    return cells;
}

SceneTableCells light_cells(const report::SceneFacts& facts) {
    SceneTableCells cells{{"light", "name", "at", "towards", "emits", "area"}};
    for (const report::LightFacts& light : measure::read_scene_contents(facts).lights)
        cells.push_back({light.kind, light.name.empty() ? "-" : escape(light.name),
                         light.is_parallel ? "-" : format_point(light.position),
                         light.direction == dvec3(0) ? "-" : format_point(light.direction),
                         format_colour(vec3(light.emission)),
                         light.kind == "mesh" ? fmt::format("{:.4g}", light.area) : "-"});
    return cells;
}

std::string describe_lens(const measure::CameraFacts& camera) {
    return camera.orthographic_height > 0
               ? fmt::format("{:.4g} high, orthographic", camera.orthographic_height)
               : fmt::format("{:.4g} degrees", camera.vertical_fov_degrees);
}

std::string describe_camera(const measure::CameraFacts& camera) {
    return fmt::format("{}: from {} to {}, {}", quote(camera.name), format_point(camera.eye),
                       format_point(camera.target), describe_lens(camera));
}

std::string describe_environment(const report::SceneFacts& facts) {
    const measure::SceneContents& contents = measure::read_scene_contents(facts);
    if (!contents.environment) return "none";
    const report::EnvironmentFacts& environment = *contents.environment;
    std::string text = escape(environment.name);
    if (environment.scale != 1) text += fmt::format(", times {:.4g}", environment.scale);
    if (environment.rotation_degrees != 0)
        text += fmt::format(", turned by {:.4g} degrees", environment.rotation_degrees);
    return text;
}

std::string describe_exposure(const SceneInfoFacts& words) {
    if (!words.exposure) return "auto; not told";
    // The exposure that `render` finds, for the camera that is given or added.
    const std::string how = words.auto_exposure
                                ? " (auto, by camera " + quote(words.info.facts.camera.name) + ")"
                                : "";
    return fmt::format("{:.4g} stops{}", *words.exposure, how);
}

SceneTableCells unsupported_cells(const report::SceneFacts& facts) {
    const report::ReportTable table = report::unsupported_table(facts);
    SceneTableCells cells{{"gap", "count", "pixels", "first", "instead"}};
    for (const std::vector<std::string>& row : table.rows) {
        cells.push_back(row);
        cells.back()[3] = escape(cells.back()[3]);
        if (measure::read_scene_contents(facts).unsupported[cells.size() - 2].pixel_share)
            cells.back()[2] += " %";
    }
    return cells;
}

} // namespace

std::string format_scene_info(const SceneInfoFacts& words) {
    const session::SceneInfo& info = words.info;
    const report::SceneFacts& facts = info.facts;
    std::string text = format_info_line("scene", escape(facts.name) + ", hash " + facts.hash);
    if (!words.scene_file.empty()) text += format_info_line("scene file", escape(words.scene_file));
    text += format_info_line(
        "triangles", fmt::format("{} shown, {} stored", facts.triangles, info.stored_triangles));
    text += format_info_line("objects", fmt::format("{} of {} meshes, {} of them instances",
                                                    info.objects, info.meshes, info.instances));
    text += format_info_line(
        "bytes", fmt::format("geometry {}, images {}, files {}", format_bytes(info.geometry_bytes),
                             format_bytes(info.image_bytes), format_bytes(info.file_bytes)));
    text += format_info_line("environment", describe_environment(facts));
    text += format_info_line("ambient", fmt::format("{:.4g}", words.ambient));
    text += format_info_line("exposure", describe_exposure(words));
    text += format_info_line("camera", describe_camera(facts.camera));
    for (std::size_t i = 0; i < info.cameras.size(); ++i)
        text += format_info_line(i == 0 ? "cameras" : "",
                                 fmt::format("{} {}", i, describe_camera(info.cameras[i])));
    text += titled_table("Materials", material_cells(info)) +
            titled_table("Mirrors", mirror_cells(info)) +
            titled_table("Lights", light_cells(facts));
    if (info.mirrors.empty()) {
        text += info.mirror_options.empty()
                    ? "\nNo mirror\n"
                    : "\nNo mirror; the smoothest surfaces become one with\n";
        for (const std::string& option : info.mirror_options) text += "  " + option + "\n";
    }
    return text + titled_table("Added, approximated, left out", unsupported_cells(facts));
}

} // namespace catoptric::cli
