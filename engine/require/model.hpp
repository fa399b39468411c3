#pragma once

#include "../core/export.hpp"
#include "../core/mirror_id.hpp"
#include "../scene/scene.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// What a picture of a scene requires: of each mirror and light what has to be rendered, and for
/// each thing that is left out why, what that saves and what error it can cost. Pure: numbers about
/// a scene, no device.
namespace catoptric::require {

/// What is asked: a picture of the scene at one instant.
struct Question {
    const scene::Scene& now; ///< as it stands at the instant (scene::at)
    const scene::Camera& camera;
    uvec2 size{512, 512};
    /// Texels of the coarsest shadow map in use: the coarser, the further shadows reach.
    std::uint32_t shadow_edge = 1;
    /// Some search asks every mirror's capture, seen or not (`captures=all`).
    bool asks_all = false;
    /// Some technique reads whole cubes, whatever direction a mirror can ask for.
    bool whole_cubes = false;
};

/// Six bits, one a face of a capture, as render::cube_views has them.
using Faces = std::uint8_t;
struct Pieces; // of what moves in a capture's faces: require/pieces.hpp
inline constexpr Faces kAllFaces = 0x3f;

struct MirrorNeeds {
    bool is_seen = true; ///< by the camera, or by a mirror that is
    MirrorId seen_in;    ///< the mirror through which; none: the camera sees it, or nobody
    /// Somebody may look into its capture: in searches of its own pixels, and of rays that go on
    /// from other mirrors, and with Question::asks_all whoever is seen.
    bool is_captured = true;
    /// Of its capture, whose directions somebody may ask for.
    Faces faces = kAllFaces;
    std::uint32_t edge = 0; ///< texels along an edge that are enough; 0: as many as the row asks
    /// Of what each face shows but for mirrors, and how it is lit: while the number and the views
    /// of face and shadow maps stay, so do the bytes.
    std::array<std::uint64_t, 6> content_hashes{};
    /// Of the same but for what `pieces` has.
    std::array<std::uint64_t, 6> settings{};
    std::shared_ptr<const Pieces> pieces; ///< null: they are not told apart
    std::vector<std::uint32_t>
        sees; ///< the other mirrors that its capture shows, from 0, ascending
};

struct LightNeeds {
    bool has_map = true;            ///< something that is seen may lie in a shadow of its
    std::uint64_t content_hash = 0; ///< of the light and of all that has never moved
};

/// A thing that moves and casts shadows. A face of a shadow map stays while LightNeeds::stamp, the
/// face's view and the stamps of those that it may show do.
struct Caster {
    std::uint32_t object = 0;
    std::uint64_t content_hash = 0; ///< of its shape and where it is
};

/// A thing that is not done, for the user to read.
struct CulledWork {
    std::string what;
    std::string why;
    std::string saves;
    double error = 0; ///< the most that a displayed pixel can differ for it, of 1; 0: nothing
};

struct Model {
    bool is_everything = true;
    std::vector<MirrorNeeds> mirrors; ///< entry n-1 of mirror n
    std::vector<LightNeeds> lights;   ///< as scene::lights has them
    std::vector<Caster> casters;
    std::vector<CulledWork> left_out;
};

/// Nothing is left out and nothing kept.
CATOPTRIC_API Model everything(const Question& question);
/// Only what the picture requires; with one stamp for everything, since nothing is known of what
/// moves. O(vertices): for many pictures of one scene take Requirements.
CATOPTRIC_API Model required(const Question& question);

/// The same for picture after picture of one scene, whose meshes stay. ContentHashes are told apart
/// by what moves, and equal ones stand for equal bytes within one object of this class.
class Requirements {
public:
    /// The scene at rest, motions with it. O(vertices), texels of images.
    CATOPTRIC_API explicit Requirements(const scene::Scene& rest);
    CATOPTRIC_API ~Requirements();
    CATOPTRIC_API Requirements(Requirements&&) noexcept;
    CATOPTRIC_API Requirements& operator=(Requirements&&) noexcept;

    /// O(objects) where nothing has changed, else with mirrors * (walls + movers + their shadows)
    /// (docs/require.md has figures). The model is this object's, until it is asked again.
    CATOPTRIC_API const Model& of(const Question& question);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// What the model says, a line for each mirror and light, then what was left out and why.
/// `scene`: for names.
CATOPTRIC_API std::string to_text(const Model& model, const scene::Scene& scene);

} // namespace catoptric::require
