// Table of the unsupported features of a scene.
#include "report/tables.hpp"
#include "report/text.hpp"

#include <algorithm>
#include <iterator>

namespace catoptric::report {

namespace {

struct Words {
    std::string_view id, text;
};

constexpr Words kWords[] = {
    {"normal-texture", "surfaces are as smooth as their triangles"},
    {"occlusion-texture", "left out"},
    {"clearcoat", "left out"},
    {"sheen", "left out"},
    {"anisotropy", "left out"},
    {"iridescence", "left out"},
    {"blend-as-mask", "there or not there, cut at half their alpha"},
    {"specular-left-out", "drawn without a highlight: its diffuse part alone"},
    {"indirect-left-out", "light from one diffuse surface to another is not computed; --ambient "
                          "stands in for it"},
    {"environment-unshadowed", "lit by the whole environment, whatever stands in its way"},
    {"rough-metal", "drawn as diffuse with the metal's colour"},
    {"rough-glass", "drawn as diffuse"},
    {"glass-as-diffuse", "its diffuse part is drawn"},
    {"glass-shadow", "glass casts the full shadow of an opaque surface"},
    {"smooth-dielectric", "reflects the environment alone where rays are not traced; "
                          "--dielectric-mirrors makes mirrors of them"},
    {"skin", "posed by its joints at rest"},
    {"morph", "weights at their defaults"},
    {"points-lines", "left out"},
    {"other-animations", "left out; --animation chooses another"},
    {"missing-image", "drawn with the factor alone"},
    {"missing-material", "drawn grey"},
    {"lights-left-out", "the strongest are kept"},
    {"material-extension", "left out"},
    {"added-studio", "lit by a built-in environment, since nothing else lights"},
    {"added-camera", "seen from the front right and above, a closed room from inside"},
};

} // namespace

std::string gap_in_words(const std::string& id) {
    const auto* const known = std::ranges::find(kWords, id, &Words::id);
    return known == std::end(kWords) ? "" : std::string(known->text);
}

Table unsupported_table(const SceneFacts& scene) {
    Table table{"Added, approximated, left out",
                {{"What", false}, {"Count"}, {"Pixels, %"}, {"First", false}, {"Instead", false}},
                {},
                {},
                "What the scene says that is not shown so, and what was added to it, the largest "
                "share of the picture first. Pixels: share of the picture that shows such a "
                "material first; none where pixels cannot tell."};
    for (const UnsupportedFeatureFacts& gap : scene.unsupported)
        table.rows.push_back(
            {gap.id, std::to_string(gap.count),
             gap.pixel_share ? fixed(100 * *gap.pixel_share, 1) : std::string(kNothing), gap.first,
             gap_in_words(gap.id)});
    return table;
}

} // namespace catoptric::report
