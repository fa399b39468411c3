#include "render/sky_levels.hpp"

#include "core/content_hash.hpp"
#include "core/shader_math.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <deque>
#include <mutex>
#include <numbers>
#include <span>
#include <utility>

namespace catoptric::render {

namespace {

constexpr std::array<std::uint32_t, SKY_LEVEL_COUNT> kSkyLevelWidths{256, 128, 64, 32,
                                                                     32,  32,  32, 32};
constexpr std::array<std::uint32_t, SKY_LEVEL_COUNT> kSkyLevelLobeSamples{64,  128, 256, 512,
                                                                          512, 512, 512, 512};
constexpr float kLobeSampleBoxOverlap =
    2; ///< area of the box that a sample reads, divided by the area for which the sample stands
constexpr std::uint32_t kMinSkyBaseWidth = 64, kMaxSkyBaseWidth = 1024;

/// Equirectangular map with twice as many columns as rows.
struct SkyMap {
    std::uint32_t width = 0;
    std::vector<vec3> texels;
    std::uint32_t row_count() const { return width / 2; }
    const vec3& texel(std::uint32_t column, std::uint32_t row) const {
        return texels[std::size_t{row} * width + column];
    }
};

/// Returns the unit direction of a place in a map; both coordinates are in [0, 1].
vec3 sky_direction(float across, float down) {
    constexpr float kPi = std::numbers::pi_v<float>;
    const float azimuth = 2 * kPi * across - kPi, polar = kPi * down;
    return {std::sin(polar) * std::sin(azimuth), std::cos(polar),
            -std::sin(polar) * std::cos(azimuth)};
}

/// Reads a map, as shaders/lib/environment.glsl does. `uv`:
/// f32::direction_to_equirectangular_uv of the direction.
vec3 sample_map(const std::vector<vec3>& texels, uvec2 size, const vec2& uv) {
    const f32::EnvironmentMapPosition at = f32::environment_map_position_at_uv(uv.x, uv.y, size.x,
                                                                               size.y);
    const auto texel = [&](std::uint32_t column, std::uint32_t row) {
        return texels[std::size_t{row} * size.x + column];
    };
    return glm::mix(glm::mix(texel(at.left, at.above), texel(at.right, at.above), at.across),
                    glm::mix(texel(at.left, at.below), texel(at.right, at.below), at.across),
                    at.down);
}

/// Returns the environment at a width that is a power of two, with several samples a texel where
/// the environment is finer.
SkyMap make_base_map(const scene::Environment& environment) {
    SkyMap base;
    base.width = environment.studio ? kMaxSkyBaseWidth / 2
                                    : std::clamp(std::bit_ceil(environment.size.x),
                                                 kMinSkyBaseWidth, kMaxSkyBaseWidth);
    const std::uint32_t edge = environment.studio
                                   ? 1
                                   : std::max(1U,
                                              (environment.size.x + base.width - 1) / base.width);
    base.texels.reserve(std::size_t{base.width} * base.row_count());
    for (std::uint32_t row = 0; row < base.row_count(); ++row)
        for (std::uint32_t column = 0; column < base.width; ++column) {
            vec3 sum(0);
            for (std::uint32_t i = 0; i < edge * edge; ++i) {
                const float x = (float(i % edge) + .5f) / float(edge);
                const float y = (float(i / edge) + .5f) / float(edge);
                const vec3 direction = sky_direction((float(column) + x) / float(base.width),
                                                     (float(row) + y) / float(base.row_count()));
                sum += environment.studio
                           ? vec3(f32::studio_radiance(direction))
                           : sample_map(environment.texels, environment.size,
                                        f32::direction_to_equirectangular_uv(direction));
            }
            base.texels.push_back(sum / float(edge * edge));
        }
    return base;
}

/// Returns the map at half the width. Each texel is weighted by its solid angle.
SkyMap halve(const SkyMap& fine) {
    SkyMap half{fine.width / 2, {}};
    for (std::uint32_t row = 0; row < half.row_count(); ++row) {
        const auto weight = [&](std::uint32_t of) {
            return std::sin(std::numbers::pi_v<float> * (float(of) + .5f) /
                            float(fine.row_count()));
        };
        const float upper = weight(2 * row), lower = weight(2 * row + 1);
        for (std::uint32_t column = 0; column < half.width; ++column) {
            const vec3 above = fine.texel(2 * column, 2 * row) +
                               fine.texel(2 * column + 1, 2 * row);
            const vec3 below = fine.texel(2 * column, 2 * row + 1) +
                               fine.texel(2 * column + 1, 2 * row + 1);
            half.texels.push_back((upper * above + lower * below) / (2 * (upper + lower)));
        }
    }
    return half;
}

/// Reads the chain of ever smaller maps between two levels, as the mean of two neighbouring maps.
/// The first map of the chain is the finest.
vec3 sample_chain(const std::vector<SkyMap>& chain, float level, const vec3& direction) {
    const float last = static_cast<float>(chain.size() - 1);
    level = std::clamp(level, 0.f, last);
    const auto finer = static_cast<std::size_t>(std::min(level, last - 1));
    const vec2 uv = f32::direction_to_equirectangular_uv(direction);
    const auto read = [&](const SkyMap& map) {
        return sample_map(map.texels, {map.width, map.row_count()}, uv);
    };
    return glm::mix(read(chain[finer]), read(chain[finer + 1]), level - static_cast<float>(finer));
}

/// A sample of the lobe around the z axis.
struct LobeSample {
    vec3 direction;
    float level; ///< level of the chain, for texels of one steradian
};

std::vector<LobeSample> make_lobe_samples(float alpha, std::uint32_t count) {
    std::vector<LobeSample> samples;
    for (std::uint32_t i = 0; i < count; ++i) {
        float u, v;
        f32::hammersley_point(i, count, u, v);
        const vec3 drawn = f32::sample_lobe_seen_head_on(alpha, u, v);
        if (!(drawn.z > 0)) continue;
        const vec3 half_way = f32::half_vector_between(vec3(0, 0, 1), drawn);
        const float density = f32::ggx_density(alpha, half_way) / 4;
        samples.push_back(
            {drawn, .5f * std::log2(kLobeSampleBoxOverlap / (float(count) * density))});
    }
    return samples;
}

vec3 filter_sky_texel(const std::vector<SkyMap>& chain, const std::vector<LobeSample>& samples,
                      const vec3& normal) {
    constexpr float kPi = std::numbers::pi_v<float>;
    vec3 tangent, bitangent, sum(0);
    f32::tangent_frame(normal, tangent, bitangent);
    // The area of a texel at the equator. Near the poles, texels and the boxes that samples read
    // are narrower.
    const float texel_area = 2 * kPi * kPi / float(chain[0].width * chain[0].row_count());
    const float finest = .5f * std::log2(texel_area);
    float weights = 0;
    for (const auto& [local, level] : samples) {
        const vec3 direction = local.x * tangent + local.y * bitangent + local.z * normal;
        sum += local.z * sample_chain(chain, level - finest, direction);
        weights += local.z;
    }
    return sum / weights;
}

SkyLevels filter_environment(const scene::Environment& environment) {
    std::vector<SkyMap> chain{make_base_map(environment)};
    while (chain.back().width > 4) chain.push_back(halve(chain.back()));
    SkyLevels levels;
    levels.width = kSkyLevelWidths;
    for (std::size_t k = 0; k < SKY_LEVEL_COUNT; ++k) {
        levels.first[k] = static_cast<std::uint32_t>(levels.texels.size());
        const float roughness = static_cast<float>(k + 1) / SKY_LEVEL_COUNT;
        const std::vector<LobeSample> samples = make_lobe_samples(
            f32::roughness_to_alpha(roughness), kSkyLevelLobeSamples[k]);
        const std::uint32_t width = levels.width[k], height = width / 2;
        for (std::uint32_t row = 0; row < height; ++row)
            for (std::uint32_t column = 0; column < width; ++column)
                levels.texels.push_back(
                    filter_sky_texel(chain, samples,
                                     sky_direction((float(column) + .5f) / float(width),
                                                   (float(row) + .5f) / float(height))));
    }
    return levels;
}

/// Returns a hash of everything that the levels depend on.
std::uint64_t hash_environment_map(const scene::Environment& environment) {
    return ContentHash()
        .add(environment.studio)
        .add(environment.size)
        .add_values(std::span(environment.texels))
        .sum();
}

} // namespace

std::shared_ptr<const SkyLevels>
find_sky_levels(const std::shared_ptr<const scene::Environment>& environment) {
    constexpr std::size_t kMaxKeptEnvironments = 4; // half a megabyte each
    static std::mutex mutex;
    static std::deque<std::pair<std::uint64_t, std::shared_ptr<const SkyLevels>>> kept;
    const std::uint64_t hash = hash_environment_map(*environment);
    const std::scoped_lock lock(mutex);
    const auto known = std::ranges::find(kept, hash, [](const auto& pair) { return pair.first; });
    if (known != kept.end()) return known->second;
    kept.emplace_back(hash, std::make_shared<const SkyLevels>(filter_environment(*environment)));
    if (kept.size() > kMaxKeptEnvironments) kept.pop_front();
    return kept.back().second;
}

} // namespace catoptric::render
