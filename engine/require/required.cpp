#include "require/content_hashes.hpp"
#include "require/culled_work.hpp"
#include "require/reach.hpp"

#include "core/content_hash.hpp"
#include "core/mirror_id.hpp"
#include "scene/transform.hpp"

#include <algorithm>

namespace catoptric::require {

struct WorkModelBuilder::Impl {
    VisibilityScene world;
    MirrorVisibility sight;
    ContentHashes content_hashes;
    VisibilityFindings findings;
    WorkModel model;
    /// Visible mirrors whose view of other mirrors has not been tested yet.
    std::vector<std::size_t> waiting;
    std::vector<bool> listed; ///< whether MirrorRequirements::sees of the mirror is up to date
    std::vector<Bounds<double>> viewers;  ///< viewers of one mirror
    std::vector<std::uint64_t> known_key; ///< key of the sentences in the model

    explicit Impl(const scene::Scene& rest) : world(rest) { model.is_everything = false; }

    void find_visible_mirrors(const PictureFrustum& picture, const scene::Scene& now);
    void find_capture_needs(std::size_t mirror, bool asks_all);
    FaceBits find_faces(const PictureFrustum& picture, std::size_t mirror);
    void find_shadow_maps(const PictureFrustum& picture);
};

/// Finds the mirrors that the camera sees, the mirrors that these can see, and so on.
void WorkModelBuilder::Impl::find_visible_mirrors(const PictureFrustum& picture,
                                                  const scene::Scene& now) {
    const std::size_t count = world.mirrors().size();
    model.mirrors.resize(count), findings.camera.resize(count), listed.resize(count);
    waiting.clear();
    for (std::size_t i = 0; i < count; ++i) {
        MirrorRequirements& needs = model.mirrors[i];
        findings.camera[i] = find_unseen_reason(world, picture, i);
        if (!findings.camera[i] && !may_picture_show(picture, world, i, now))
            findings.camera[i] = UnseenReason{UnseenReason::Cause::outside, 0};
        needs.seen_in = {};
        needs.is_seen = !findings.camera[i];
        if (needs.is_seen) waiting.push_back(i);
    }
    for (std::size_t next = 0; next < waiting.size() && waiting.size() < count; ++next)
        for (std::size_t i = 0; i < count; ++i) {
            MirrorRequirements& needs = model.mirrors[i];
            if (needs.is_seen || !sight.may_reach(world, waiting[next], i)) continue;
            needs.is_seen = true;
            needs.seen_in = MirrorId::from_index(waiting[next]);
            waiting.push_back(i);
        }
}

/// Finds what a mirror's capture shows, after find_visible_mirrors.
void WorkModelBuilder::Impl::find_capture_needs(std::size_t mirror, bool asks_all) {
    MirrorRequirements& needs = model.mirrors[mirror];
    needs.is_captured = needs.is_seen || asks_all;
    if (!needs.is_captured) {
        listed[mirror] = false;
        needs.sees.clear();
        needs.content_hashes = needs.still_hashes = {};
        needs.pieces = nullptr;
        return;
    }
    const ContentHashes::FaceHashes& faces = content_hashes.face_hashes(world, mirror);
    needs.content_hashes = faces.content_hashes, needs.still_hashes = faces.still_hashes,
    needs.pieces = faces.pieces;
    if (listed[mirror] && !sight.has_changed(mirror)) return;
    listed[mirror] = true;
    needs.sees.clear();
    for (std::size_t i = 0; i < model.mirrors.size(); ++i)
        if (sight.may_show(world, mirror, i)) needs.sees.push_back(static_cast<std::uint32_t>(i));
}

FaceBits WorkModelBuilder::Impl::find_faces(const PictureFrustum& picture, std::size_t mirror) {
    const VisibilityObject& thing = world.objects()[world.mirrors()[mirror]];
    const dvec3 flat = world.mesh_shapes()[thing.mesh].flat_normal;
    if (flat == dvec3(0) || thing.is_glass || !model.mirrors[mirror].is_captured) return kAllFaces;
    // The filter of a rough mirror's levels reads texels on both sides of the mirror's plane.
    if (thing.has_lobe) return kAllFaces;
    viewers.clear();
    // For an orthographic camera all faces are kept, because its rays start in a plane and not at
    // one eye point.
    if (!findings.camera[mirror] && picture.is_orthographic()) return kAllFaces;
    if (!findings.camera[mirror]) viewers.push_back({picture.eye(), picture.eye()});
    for (std::size_t i = 0; i < model.mirrors.size(); ++i)
        if (model.mirrors[i].is_captured && sight.may_reach(world, i, mirror))
            viewers.push_back(world.objects()[world.mirrors()[i]].box);
    const dvec3 normal = scene::transform_normal(scene::normal_matrix(thing.place), flat);
    return needed_faces(thing.box, normal, 4 * world.rounding_error(), viewers);
}

/// Finds whether each light may shine on something that is seen. If any capture is made, all
/// objects count as seen; else only those that the camera may see.
void WorkModelBuilder::Impl::find_shadow_maps(const PictureFrustum& picture) {
    model.lights.resize(world.lights().size());
    model.casters = content_hashes.shadow_casters(world);
    const bool all_around = std::ranges::any_of(model.mirrors, &MirrorRequirements::is_captured);
    for (std::size_t i = 0; i < model.lights.size(); ++i) {
        model.lights[i].content_hash = ContentHash(world.static_hash()).add(i).sum();
        model.lights[i].has_map = std::ranges::any_of(
            world.objects(), [&](const VisibilityObject& thing) {
                return !thing.box.empty() &&
                       may_light_reach(world.lights()[i], thing.box, world.rounding_error()) &&
                       (all_around || (thing.seen_by_camera && picture.may_contain_box(thing.box)));
            });
    }
}

WorkModelBuilder::WorkModelBuilder(const scene::Scene& rest)
    : impl_(std::make_unique<Impl>(rest)) {}
WorkModelBuilder::~WorkModelBuilder() = default;
WorkModelBuilder::WorkModelBuilder(WorkModelBuilder&&) noexcept = default;
WorkModelBuilder& WorkModelBuilder::operator=(WorkModelBuilder&&) noexcept = default;

const WorkModel& WorkModelBuilder::model(const WorkModelInput& input) {
    Impl& impl = *impl_;
    const PictureFrustum picture(input.camera, input.size);
    impl.world.update(input.now);
    impl.sight.update(impl.world);
    impl.content_hashes.update(impl.world, input.shadow_edge, input.has_soft_shadows);
    impl.find_visible_mirrors(picture, input.now);
    for (std::size_t i = 0; i < impl.model.mirrors.size(); ++i)
        impl.find_capture_needs(i, input.asks_all);
    for (std::size_t i = 0; i < impl.model.mirrors.size(); ++i)
        impl.model.mirrors[i].faces = input.asks_all || input.whole_cubes
                                          ? kAllFaces
                                          : impl.find_faces(picture, i);
    impl.find_shadow_maps(picture);
    set_key(impl.findings, impl.model);
    if (impl.findings.key != impl.known_key) {
        impl.known_key = impl.findings.key;
        impl.model.left_out = find_culled_work(impl.model, impl.findings, input.now);
    }
    return impl.model;
}

WorkModel make_required_model(const WorkModelInput& input) {
    return WorkModelBuilder(input.now).model(input);
}

} // namespace catoptric::require
