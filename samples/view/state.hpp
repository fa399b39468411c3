#pragma once

#include "app/screen.hpp"
#include "app/session.hpp"
#include "camera.hpp"
#include "plan_state.hpp"

#include <optional>
#include <string>
#include <vector>

/// All that the window shows and the user changes, as plain data.
namespace catoptric::view {

enum class Mode {
    plan,       ///< the plan's picture
    split,      ///< the plan left of the divider, the other right of it
    difference, ///< how far they are apart
    answers,    ///< what searches answered: hit, unknown, miss
    numbers,    ///< which mirror each pixel shows
    causes,     ///< what taking a cause of error away changes
};
inline constexpr int kModes = 6;
const char* name_of(Mode mode);

/// What the plan is compared with.
enum class Against { other, reference };

/// Scene time, in seconds.
struct Motion {
    double time = 0;
    bool plays = false;
    double speed = 1;
};
inline constexpr double kStep = 1.0 / 60;

struct State {
    PlanState plan, other;
    Mode mode = Mode::plan;
    Against against = Against::other;
    double divider = .5;      ///< share of the picture's width
    int gain = 4;             ///< of differences: 1, 2, 4 ... 64
    std::uint32_t cause = 16; ///< shared::kMend...
    scene::Camera camera;
    bool flies = false;
    Motion motion;
    app::Modelling model = app::Modelling::required;
    double exposure = 0;
    bool judges = false; ///< error figures against the traced reference are found at rest
    bool shows_panels = true, shows_keys = false;
    std::uint32_t chosen = 0; ///< mirror whose technique is edited; 0: all
    bool edits_other = false; ///< of two plans
    std::string said;         ///< to the user, until something else is
};

/// What one frame renders and what of it is shown.
struct Shown {
    std::vector<std::string> techniques;
    app::Showing::Kind kind = app::Showing::Kind::one;
    std::size_t first = 0, second = 0; ///< of app::Showing
};

/// Whether the mode shows a picture that is made beside the frames: of the reference, of numbers or
/// of a cause.
bool wants_canvas(const State& state);
Shown shown(const State& state);

/// Cause of error, for the user; names of shared::kMend...
struct Cause {
    std::uint32_t bit;
    const char* name;
};
const std::vector<Cause>& causes();

/// The scene's time after a frame that took so long.
double advanced(const Motion& motion, double seconds);
/// A colour for each mirror's number, told apart; black for 0. As the screen shows it.
vec3 colour_of(std::uint32_t mirror);
/// Of what camera rays met first (app::Part::hits).
measure::Picture numbers_picture(const std::vector<std::uint32_t>& hits, uvec2 size);
/// How far two displays are apart, times `gain`.
measure::Picture difference_picture(const measure::Picture& a, const measure::Picture& b,
                                    float gain);

} // namespace catoptric::view
