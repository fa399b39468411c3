#include "render/sky.hpp"

#include "core/error.hpp"
#include "render/environment_cells.hpp"
#include "render/gpu_scene.hpp"
#include "render/sky_levels.hpp"
#include "scene/surroundings.hpp"
#include "shared.h"

#include <algorithm>

namespace catoptric::render {

namespace {

constexpr std::uint32_t kNoEnvironment = 0, kMapEnvironment = 1, kStudioEnvironment = 2;

shared::Sky make_sky(const scene::Environment& environment) {
    shared::Sky sky{};
    sky.size = environment.size;
    sky.scale = static_cast<float>(environment.scale);
    const double angle = glm::radians(environment.rotation_degrees);
    sky.turn = vec2(std::cos(angle), std::sin(angle));
    std::ranges::transform(scene::irradiance_coefficients(environment), sky.irradiance,
                           [](const dvec3& coefficient) { return vec3(coefficient); });
    return sky;
}

/// Appends the environment, filtered for rough surfaces, to the texels.
void append_sky_levels(const std::shared_ptr<const scene::Environment>& environment,
                       shared::Sky& sky, std::vector<vec4>& texels) {
    const std::shared_ptr<const SkyLevels> levels = find_sky_levels(environment);
    for (std::size_t k = 0; k < SKY_LEVEL_COUNT; ++k) {
        sky.level_first[k] = static_cast<std::uint32_t>(texels.size()) + levels->first[k];
        sky.level_width[k] = levels->width[k];
    }
    for (const vec3& texel : levels->texels) texels.emplace_back(texel, 1.0f);
}

void append_bright_cells(const scene::Environment& environment, shared::Sky& sky,
                         std::vector<vec4>& texels) {
    const EnvironmentCells cells = find_bright_cells(environment);
    sky.cell_first = static_cast<std::uint32_t>(texels.size());
    sky.cell_count = static_cast<std::uint32_t>(cells.texels.size());
    sky.cell_threshold = cells.threshold, sky.cell_density = cells.density;
    texels.insert(texels.end(), cells.texels.begin(), cells.texels.end());
}

} // namespace

DeviceEnvironment::DeviceEnvironment(std::size_t slots)
    : sky_("sky", gpu::BufferUsage::uniform, slots),
      texels_("sky.texels", gpu::BufferUsage::texels, slots),
      vertices_("sky.vertices", gpu::BufferUsage::vertex, slots),
      indices_("sky.indices", gpu::BufferUsage::index, slots) {
    sky_.set(std::vector(1, shared::Sky{}));
}

void DeviceEnvironment::set(const std::shared_ptr<const scene::Environment>& environment,
                            bool has_lobes, bool casts_shadows) {
    if (environment_ == environment && has_levels_ == has_lobes && has_cells_ == casts_shadows)
        return;
    if (environment && !environment->studio) {
        const auto [width, height] = std::pair(environment->size.x, environment->size.y);
        check(width > 0 && height > 0 && environment->texels.size() == std::size_t{width} * height,
              Failure::bad_data, "environment '", environment->name, "': wanted ", width, "x",
              height, " texels, at least one, found ", environment->texels.size());
    }
    environment_ = environment, has_levels_ = has_lobes, has_cells_ = casts_shadows;
    kind_ = !environment          ? kNoEnvironment
            : environment->studio ? kStudioEnvironment
                                  : kMapEnvironment;
    shared::Sky sky = environment ? make_sky(*environment) : shared::Sky{};
    std::vector<vec4> texels;
    if (kind_ == kMapEnvironment)
        for (const vec3& texel : environment->texels) texels.emplace_back(texel, 1.0f);
    if (environment && has_lobes) append_sky_levels(environment, sky, texels);
    if (kind_ == kMapEnvironment && casts_shadows) append_bright_cells(*environment, sky, texels);
    sky_.set(std::vector(1, sky));
    texels_.set(texels);
    if (kind_ == kNoEnvironment) return;
    vertices_.set(
        std::vector<shared::Vertex>{{{-1, -1, 0}, {}}, {{3, -1, 0}, {}}, {{-1, 3, 0}, {}}});
    indices_.set(std::vector<std::uint32_t>{0, 1, 2});
}

std::size_t DeviceEnvironment::write(gpu::Device& device, std::size_t slot) {
    std::size_t writes = 0;
    for (DeviceList* buffer : {&sky_, &texels_, &vertices_, &indices_})
        writes += buffer->write(device, slot);
    return writes;
}

void DeviceEnvironment::bind(graph::PassCommands& commands, std::size_t slot) const {
    commands.bind("sky", sky_.buffer(slot));
    commands.bind("sky_texels", texels_.buffer(slot));
}

void DeviceEnvironment::bind_vertices(graph::PassCommands& commands, std::size_t slot) const {
    commands.bind_geometry(vertices_.buffer(slot), indices_.buffer(slot));
}

void draw_sky(graph::PassCommands& commands, const GpuScene& scene, std::uint32_t first_view,
              std::uint32_t layers, const gpu::ShaderConstants& store) {
    if (!scene.has_sky()) return;
    commands.bind_pipeline(gpu::RasterState{.vertex = "sky.vert",
                                            .fragment = "sky.frag",
                                            .constants = store,
                                            .features = scene.feature_constants(first_view)});
    commands.push_constants(shared::DrawParameters{.first_view = first_view});
    scene.bind_sky_vertices(commands);
    commands.draw(0, 3, 0, layers);
}

} // namespace catoptric::render
