#pragma once

#include "core/frame_facts.hpp"
#include "core/mirror_id.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

/// The work that a picture of a scene requires: the captures, faces and shadow maps of each mirror
/// and light that must be rendered. For culled work the model gives the reason and the saving. The
/// code only computes numbers about a scene and needs no device.
namespace catoptric::require {

/// Input of a model: the scene at one instant, the camera, the picture's size and the settings that
/// decide what the picture requires.
struct WorkModelInput {
    const scene::Scene& now; ///< the scene at the instant (scene::scene_at)
    const scene::Camera& camera;
    uvec2 size{512, 512};
    /// Edge in texels of the coarsest shadow map in use. The coarser the map, the further shadows
    /// reach.
    std::uint32_t shadow_edge = 1;
    /// Whether lamps cast soft shadows. A look-up may then read any place of a lamp's shadow map.
    bool has_soft_shadows = false;
    /// Whether a search reads the captures of all mirrors, visible or not (`captures=all`).
    bool asks_all = false;
    /// Whether a technique reads whole cubes, not only the directions that a mirror can reflect to.
    bool whole_cubes = false;
};

/// Six bits, one per face of a capture, in the order of render::make_cube_views.
using FaceBits = std::uint8_t;
struct MovingParts; // parts of a capture's faces that movers change
inline constexpr FaceBits kAllFaces = 0x3f;

struct MirrorRequirements {
    bool is_seen = true; ///< whether the camera or a visible mirror sees the mirror
    /// The mirror in which this mirror is seen; none: the camera sees it, or nothing does.
    MirrorId seen_in;
    /// Whether the mirror's capture may be read: by searches of the mirror's own pixels, by rays
    /// continued from other mirrors, or by any search with WorkModelInput::asks_all.
    bool is_captured = true;
    /// Faces of its capture that hold directions which may be read.
    FaceBits faces = kAllFaces;
    /// For each face of the capture, a content hash of the shown surfaces and of their lighting,
    /// except reflections in mirrors. The bytes of a face stay the same while this hash, the view
    /// of the face and the views of the shadow maps stay the same.
    std::array<std::uint64_t, 6> content_hashes{};
    /// Content hashes of the same data without the movers and shadows that `pieces` lists.
    std::array<std::uint64_t, 6> still_hashes{};
    std::shared_ptr<const MovingParts> pieces; ///< null: movers are not listed one by one
    std::vector<std::uint32_t>
        /// The other mirrors that its capture shows, numbered from 0, in ascending order.
        sees;
};

struct LightRequirements {
    bool has_map = true;            ///< whether something visible may lie in a shadow of the light
    std::uint64_t content_hash = 0; ///< content hash of the light and of all that never moved
};

/// A mover that casts shadows. A face of a shadow map stays valid while three things stay the same:
/// LightRequirements::content_hash, the face's view, and the content hashes of its possible
/// casters.
struct ShadowCaster {
    std::uint32_t object = 0;
    std::uint64_t content_hash = 0; ///< content hash of its shape and place
};

using catoptric::CulledWork;

struct WorkModel {
    bool is_everything = true;
    std::vector<MirrorRequirements> mirrors; ///< entry n-1 belongs to mirror n
    std::vector<LightRequirements> lights;   ///< lights in the order of scene::list_lights
    std::vector<ShadowCaster> casters;
    std::vector<CulledWork> left_out;
};

/// Returns the model that culls no work and keeps no captures.
WorkModel make_everything_model(const WorkModelInput& input);
/// Returns the model with only the work that the picture requires. All faces have one content hash
/// that covers the whole scene, because a single picture does not tell which objects move.
/// O(vertices). Use WorkModelBuilder for many pictures of one scene.
WorkModel make_required_model(const WorkModelInput& input);

/// Computes the models of successive pictures of one scene whose meshes stay the same. Content
/// hashes tell which captures show an object that moved. Equal hashes stand for equal bytes only
/// within one object of this class.
class WorkModelBuilder {
public:
    /// Takes the scene as loaded: every object in its place at rest, and the list of motions.
    /// O(vertices + texels of images).
    explicit WorkModelBuilder(const scene::Scene& rest);
    ~WorkModelBuilder();
    WorkModelBuilder(WorkModelBuilder&&) noexcept;
    WorkModelBuilder& operator=(WorkModelBuilder&&) noexcept;

    /// Returns the model of a picture. The reference is valid until the next call. O(objects) if
    /// nothing has changed; else also mirrors * (walls + movers + their shadows). Figures are in
    /// docs/require.md.
    const WorkModel& model(const WorkModelInput& input);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// Returns the model as text: a line for each mirror and light, then the culled work with its
/// reasons. `scene` supplies the names.
std::string describe_model(const WorkModel& model, const scene::Scene& scene);

} // namespace catoptric::require
