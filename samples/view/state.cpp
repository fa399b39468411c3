#include "state.hpp"

#include "shared.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace catoptric::view {

const char* mode_name(ViewMode mode) {
    constexpr std::array kViewModeNames{"plan",    "split",   "difference",
                                        "answers", "numbers", "causes"};
    return kViewModeNames.at(static_cast<std::size_t>(mode));
}

const std::vector<CauseLabel>& cause_labels() {
    static const std::vector<CauseLabel> kCauseLabels{
        {shared::kAblateDistance, "captured distance"},
        {shared::kAblateDirection, "looked-up direction"},
        {shared::kAblateHiddenPoints, "hidden surfaces"},
        {shared::kAblateTexelColour, "texels"},
        {shared::kAblateMirrorReflections, "mirrors in captures"},
        {shared::kAblateShadows, "shadow map"}};
    return kCauseLabels;
}

bool needs_host_picture(const ViewState& state) {
    const bool compares = state.mode == ViewMode::split || state.mode == ViewMode::difference;
    return state.mode == ViewMode::numbers || state.mode == ViewMode::causes ||
           (compares && state.against == ComparisonPicture::reference);
}

ShownPictures choose_shown_pictures(const ViewState& state) {
    ShownPictures shown{
        {technique_text(state.plan)}, session::WindowPictures::Arrangement::one, 0, 0};
    switch (state.mode) {
    case ViewMode::plan: break;
    case ViewMode::answers:
        shown.techniques = {technique_text(set_knob(state.plan, "show", "state"))};
        break;
    case ViewMode::numbers:
    case ViewMode::causes: shown.first = session::WindowPictures::kCanvasPicture; break;
    case ViewMode::split:
    case ViewMode::difference:
        shown.kind = state.mode == ViewMode::split
                         ? session::WindowPictures::Arrangement::split
                         : session::WindowPictures::Arrangement::difference;
        if (state.against == ComparisonPicture::reference) {
            shown.second = session::WindowPictures::kCanvasPicture;
        } else if (const std::string other = technique_text(state.other);
                   other != shown.techniques[0]) {
            shown.techniques.push_back(other);
            shown.second = 1;
        }
        break;
    }
    return shown;
}

double advance_time(const ScenePlayback& motion, double seconds) {
    return motion.plays ? motion.time + motion.speed * seconds : motion.time;
}

vec3 mirror_colour(std::uint32_t mirror) {
    if (mirror == 0) return vec3(0);
    // Hues are a golden angle apart. Every other group of eight is paler.
    const float hue = std::fmod(static_cast<float>(mirror - 1) * .381966f, 1.f) * 6;
    const float low = (mirror - 1) / 8 % 2 == 0 ? .1f : .45f;
    const auto channel = [&](float shift) {
        const float at = std::fmod(hue + shift, 6.f);
        return low + (1 - low) * std::clamp(std::abs(at - 3) - 1, 0.f, 1.f);
    };
    return {channel(0), channel(4), channel(2)};
}

measure::Picture mirror_number_picture(const std::vector<std::uint32_t>& hits, uvec2 size) {
    measure::Picture picture(static_cast<int>(size.x), static_cast<int>(size.y));
    for (std::size_t i = 0; i < std::min(hits.size(), picture.pixels.size()); ++i)
        picture.pixels[i] = mirror_colour(hits[i] & 0xFFFFU);
    return picture;
}

measure::Picture difference_picture(const measure::Picture& a, const measure::Picture& b,
                                    float gain) {
    measure::Picture picture(a.width, a.height);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i)
        picture.pixels[i] = glm::min(glm::abs(a.pixels[i] - b.pixels[i]) * gain, vec3(1));
    return picture;
}

} // namespace catoptric::view
