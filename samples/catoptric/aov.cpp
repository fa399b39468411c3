#include "aov.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace catoptric::cli {

namespace {

struct AovRow {
    const char* name;
    std::vector<const char*> channels;
    const char* help;
};

/// Returns a row for each layer, in the order of PictureAov. Names of channels have one letter
/// after the layer's name, because Blender reads no others.
const std::vector<AovRow>& aov_rows() {
    static const std::vector<AovRow> kRows{
        {"distance", {"distance.Z"}, "way along the ray, in the file's units; inf: no surface"},
        {"normal",
         {"normal.X", "normal.Y", "normal.Z"},
         "unit shading normal in world space; 0,0,0: no surface"},
        {"object", {"object.V"}, "number of the object from 1, see 'info --json'; 0: no surface"},
        {"mirror", {"mirror.V"}, "number of the mirror from 1, as in 'info'; 0: no mirror"},
        {"tier", {"tier.V"}, "how the mirror's reflection was made, see the numbers below"},
        {"roughness", {"roughness.V"}, "roughness of the material, 0 to 1; 0: no surface"}};
    return kRows;
}

/// Floats hold all integers up to this one exactly.
constexpr std::uint32_t kMaxExactInteger = 1U << 24U;

std::vector<float> to_floats(const std::vector<std::uint32_t>& numbers) {
    std::vector<float> values;
    values.reserve(numbers.size());
    for (const std::uint32_t number : numbers) {
        check(number <= kMaxExactInteger, Failure::exhausted, "--aov: wanted at most ",
              kMaxExactInteger, " objects, whose numbers a float holds, found number ", number);
        values.push_back(static_cast<float>(number));
    }
    return values;
}

std::vector<float> aov_values(PictureAov aov, int channel, const session::FirstSurfaces& surfaces,
                              const std::optional<session::ReflectionTiers>& tiers) {
    std::vector<float> values;
    switch (aov) {
    case PictureAov::distance: return surfaces.distance;
    case PictureAov::normal:
        for (const vec3& normal : surfaces.normal) values.push_back(normal[channel]);
        return values;
    case PictureAov::object: return to_floats(surfaces.object);
    case PictureAov::mirror: return to_floats(surfaces.mirror);
    case PictureAov::tier:
        for (std::size_t i = 0; i < surfaces.mirror.size(); ++i)
            values.push_back(static_cast<float>(tiers.value().tier_at(i, surfaces.mirror[i])));
        return values;
    case PictureAov::roughness: break;
    }
    return surfaces.roughness;
}

} // namespace

std::vector<PictureAov> parse_aovs(const std::string& text) {
    std::vector<std::string> names;
    for (const AovRow& row : aov_rows()) names.emplace_back(row.name);
    names.emplace_back("all");
    std::vector<bool> is_wanted(names.size());
    for (const std::string& word : split(text, ","))
        is_wanted[parse_choice("--aov", word, names)] = true;
    std::vector<PictureAov> aovs;
    for (std::size_t i = 0; i < aov_rows().size(); ++i)
        if (is_wanted[i] || is_wanted.back()) aovs.push_back(static_cast<PictureAov>(i));
    return aovs;
}

std::string describe_aovs() {
    std::string text;
    for (const AovRow& row : aov_rows()) text += fmt::format("  {:<13} {}\n", row.name, row.help);
    const std::vector<session::TierInfo>& tiers = session::reflection_tiers();
    for (std::size_t i = 0; i < tiers.size(); ++i)
        text += fmt::format("  {} {:<11} {}\n", i, tiers[i].name, tiers[i].help);
    return text;
}

std::vector<measure::ExtraChannel>
aov_channels(const std::vector<PictureAov>& aovs, const session::FirstSurfaces& surfaces,
             const std::optional<session::ReflectionTiers>& tiers) {
    std::vector<measure::ExtraChannel> channels;
    for (const PictureAov aov : aovs) {
        const AovRow& row = aov_rows()[static_cast<std::size_t>(aov)];
        for (std::size_t i = 0; i < row.channels.size(); ++i)
            channels.push_back(
                {row.channels[i], aov_values(aov, static_cast<int>(i), surfaces, tiers)});
    }
    return channels;
}

} // namespace catoptric::cli
