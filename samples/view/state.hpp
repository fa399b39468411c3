#pragma once

#include "camera.hpp"
#include "plan_state.hpp"
#include "roughness.hpp"
#include "session/screen.hpp"
#include "session/session.hpp"

#include <optional>
#include <string>
#include <vector>

/// The state that the window shows and the user changes, as plain data.
namespace catoptric::view {

enum class ViewMode {
    plan,       ///< shows the plan's picture
    split,      ///< the plan left of the divider, the comparison right of it
    difference, ///< shows the difference of the two pictures
    answers,    ///< answers of searches: hit, unknown, miss
    numbers,    ///< number of the mirror that each pixel shows
    causes,     ///< change of the picture when a cause of error is removed
};
inline constexpr int kViewModeCount = 6;
const char* mode_name(ViewMode mode);

enum class ComparisonPicture { other, reference };

/// Scene time, in seconds.
struct ScenePlayback {
    double time = 0;
    bool plays = false;
    double speed = 1;
};
inline constexpr double kFrameStepSeconds = 1.0 / 60;

struct ViewState {
    EditedPlan plan, other;
    ViewMode mode = ViewMode::plan;
    ComparisonPicture against = ComparisonPicture::other;
    double divider = .5;      ///< position as a share of the picture's width
    int gain = 4;             ///< factor on differences: 1, 2, 4 ... 64
    std::uint32_t cause = 16; ///< the cause of error to remove, a bit of shared::kAblate...
    scene::Camera camera;
    bool flies = false;
    ScenePlayback motion;
    session::RenderedWork model = session::RenderedWork::required;
    double exposure = 0;
    bool judges = false; ///< whether errors against the traced reference are measured at rest
    bool shows_panels = true, shows_keys = false;
    MirrorRoughness roughness; ///< roughness of mirrors whose roughness the user set
    std::uint32_t chosen = 0;  ///< number of the mirror whose technique is edited; 0: all
    bool edits_other = false;  ///< whether the controls edit `other` instead of `plan`
    std::string said;          ///< message to the user, until the next message
};

/// The techniques that one frame renders, and the pictures that it shows.
struct ShownPictures {
    std::vector<std::string> techniques;
    session::WindowPictures::Arrangement kind = session::WindowPictures::Arrangement::one;
    std::size_t first = 0, second = 0; ///< indices of the pictures for session::WindowPictures
};

/// Returns whether the mode shows a picture that is made outside the frames: the reference, mirror
/// numbers, or a cause of error.
bool needs_host_picture(const ViewState& state);
ShownPictures choose_shown_pictures(const ViewState& state);

/// Bits are shared::kAblate...
struct CauseLabel {
    std::uint32_t bit;
    const char* name;
};
const std::vector<CauseLabel>& cause_labels();

/// Returns the scene's time after a frame of this duration. All times are in seconds.
double advance_time(const ScenePlayback& motion, double seconds);
/// Returns a distinct display colour for each mirror number; black for 0.
vec3 mirror_colour(std::uint32_t mirror);
/// Returns a picture of mirror numbers from the first hits of camera rays
/// (session::TechniqueResult::hits).
measure::Picture mirror_number_picture(const std::vector<std::uint32_t>& hits, uvec2 size);
/// Returns the difference of two displayed pictures times `gain`.
measure::Picture difference_picture(const measure::Picture& a, const measure::Picture& b,
                                    float gain);

} // namespace catoptric::view
