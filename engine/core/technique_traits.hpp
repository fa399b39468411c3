#pragma once

#include <string_view>

namespace catoptric {

/// What a technique is like, as data. All code outside the technique's own file reads this and
/// compares no name.
struct TechniqueTraits {
    /// How the technique uses captures. `own`: its passes draw captures that no other technique
    /// reads. `shared`: each mirror has one capture a frame, which all techniques may read, and
    /// mirrors in it show the captures of the last frame.
    enum class Captures { none, own, shared };
    /// Why two pictures of one scene differ. `rays`: rays leave surfaces in drawn directions.
    /// `history`: a picture also holds what frames before drew.
    enum class Noise { none, rays, history };
    /// The part of the seed report that the technique repeats.
    enum class SeedPart { none, bounces, last_captures, parallax, rays };

    Captures captures = Captures::none;
    bool draws_mirrored_views = false;
    bool traces_rays = false;
    bool draws_whole_picture = false; ///< alone, it declares the picture without a rasterised view

    Noise noise = Noise::none;
    /// Knobs of Noise::rays by name; empty: there is no such knob. `seed`: of the drawn directions.
    /// `rays`: number of directions from lobes of rough surfaces, where 0 draws none. `samples`:
    /// camera rays of each pixel.
    std::string_view seed = {}, rays = {}, samples = {};
    struct Choice {
        std::string_view knob, choice;
    };
    Choice paths = {};      ///< with this choice, rays leave diffuse surfaces, too
    Choice unshadowed = {}; ///< with this choice, no rays go to the environment

    SeedPart seed_part = SeedPart::none;

    /// Returns whether rays alone draw the picture.
    bool is_ray_traced() const {
        return traces_rays && captures == Captures::none && !draws_mirrored_views;
    }
    /// Returns whether it draws a mirror of any shape beside mirrors of other techniques. A history
    /// is that of a whole picture.
    bool draws_any_mirror() const {
        return captures == Captures::shared || (is_ray_traced() && noise != Noise::history);
    }
    /// Returns whether pictures with other seeds can be drawn, whose mean has less noise.
    bool has_drawable_noise() const { return noise == Noise::rays && !seed.empty(); }
};

} // namespace catoptric
