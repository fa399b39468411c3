#include "render/capture_decider.hpp"

#include "core/content_hash.hpp"
#include "render/face_area.hpp"
#include "render/views.hpp"
#include "require/model.hpp"

#include <algorithm>
#include <atomic>

namespace catoptric::render {

namespace {

constexpr std::uint64_t kClearedDrawing = 1; // `drawing` of a face that holds nothing

} // namespace

CaptureDecider::CaptureDecider(const GpuScene& scene, const require::WorkModel& model,
                               std::uint64_t number, const std::vector<CaptureOptions>& layout,
                               const CaptureCache* before, bool compares)
    : scene_(scene), model_(model), number_(number), layout_(layout), before_(before),
      compares_(compares) {
    static std::atomic<std::uint64_t> deciders = 0;
    decider_ = ++deciders;
    if (before) changed_ = find_changed(*before);
    ContentHash lit;
    for (std::uint32_t light = 0; light < scene.light_count(); ++light) {
        lit.add_values(std::span(scene.backdrops(light)));
        for (std::uint32_t face = 0; face < scene.drawn_shadow_faces(light); ++face)
            lit.add(scene.list_views()[scene.shadow_view(light) + face]);
    }
    shadow_views_ = lit.sum();
}

bool CaptureDecider::had_same_layout(std::uint32_t mirror) const {
    return before_ && layout_[mirror].face > 0 &&
           have_equal_contents(before_->options[mirror], layout_[mirror]);
}

std::uint32_t CaptureDecider::frames_waited(std::uint32_t mirror) const {
    return had_same_layout(mirror) ? before_->waited[mirror] : 0;
}

void CaptureDecider::decide(std::uint32_t mirror, CaptureWork& work, CaptureCache& kept) const {
    CaptureChange change = CaptureChange::none;
    std::vector<std::uint32_t>& saw = kept.saw[mirror];
    for (std::uint32_t face = 0; face < 6; ++face) {
        const std::vector<std::uint32_t> seen = visible_mirrors(mirror, face);
        const FaceUpdate what = decide(mirror, face, seen, kept.faces[mirror][face]);
        work.faces[mirror][face] = what;
        if (work.is_drawn(mirror, face))
            work.parts[mirror][face] = changed_part(mirror, face, seen, kept.faces[mirror][face]);
        if (what == FaceUpdate::draw) change = CaptureChange::some;
        if (what != FaceUpdate::compare) continue;
        change = std::max(change, CaptureChange::unknown);
        saw.insert(saw.end(), seen.begin(), seen.end());
    }
    kept.changes[mirror] = change;
}

bool CaptureDecider::has_turn(std::uint32_t mirror) const {
    return (number_ + mirror) % std::max(layout_[mirror].every, 1u) == 0;
}

bool CaptureDecider::can_wait(std::uint32_t mirror, const CaptureWork& work) const {
    if (!had_same_layout(mirror)) return false;
    for (std::uint32_t face = 0; face < 6; ++face)
        if (work.is_drawn(mirror, face) && before_->faces[mirror][face].content_hash == 0)
            return false;
    return true;
}

void CaptureDecider::postpone(std::uint32_t mirror, CaptureWork& work, CaptureCache& kept) const {
    for (std::uint32_t face = 0; face < 6; ++face) {
        if (!work.is_drawn(mirror, face)) continue;
        kept.faces[mirror][face] = before_->faces[mirror][face];
        kept.faces[mirror][face].is_behind = true;
        work.faces[mirror][face] = FaceUpdate::keep, work.parts[mirror][face] = {};
    }
    kept.changes[mirror] = CaptureChange::none;
    kept.saw[mirror].clear();
    kept.waited[mirror] = before_->waited[mirror] + 1;
}

std::vector<std::uint32_t> CaptureDecider::visible_mirrors(std::uint32_t mirror,
                                                           std::uint32_t face) const {
    const shared::View& view = scene_.list_views()[scene_.capture_view(mirror) + face];
    std::vector<std::uint32_t> seen;
    if (model_.is_everything) return seen;
    for (const std::uint32_t other : model_.mirrors[mirror].sees)
        if (layout_[other].face > 0 &&
            may_show(view, scene_.draw_ranges()[scene_.mirror_object(other)]))
            seen.push_back(other);
    return seen;
}

FaceUpdate CaptureDecider::decide(std::uint32_t mirror, std::uint32_t face,
                                  const std::vector<std::uint32_t>& seen, CachedFace& now) const {
    if (model_.is_everything) { // drawn whatever it shows, so each drawing has a number of its own
        ContentHash drawing;
        drawing.add(decider_), drawing.add(mirror), drawing.add(face);
        now = {.content_hash = std::max<std::uint64_t>(drawing.sum(), 1),
               .drawing = std::max<std::uint64_t>(drawing.sum(), kClearedDrawing + 1)};
        return FaceUpdate::draw;
    }
    const require::MirrorRequirements& needs = model_.mirrors[mirror];
    ContentHash shown =
        ContentHash(shadow_views_).add(scene_.list_views()[scene_.capture_view(mirror) + face]);
    for (const std::uint32_t other : seen) shown.add(other);
    const std::uint64_t content_hash = ContentHash(shown).add(needs.content_hashes[face]).sum();
    now = had_same_layout(mirror) ? before_->faces[mirror][face] : CachedFace();
    const bool shows_same = now.drawing > 0 && now.content_hash == content_hash;
    const auto has_changed = [&](std::uint32_t other) { return changed_[other] != 0; };
    if (shows_same && !now.is_behind && std::ranges::none_of(seen, has_changed))
        return FaceUpdate::keep;
    if (!needs.is_captured || !(needs.faces >> face & 1)) {
        // Without a content hash, the face is drawn as soon as a ray needs it again.
        now.content_hash = 0, now.is_behind = false;
        if (now.drawing > 0) return FaceUpdate::keep;
        now.drawing = kClearedDrawing;
        return FaceUpdate::clear;
    }
    now = {content_hash, drawing_number(content_hash, seen), false,
           ContentHash(shown).add(needs.still_hashes[face]).sum(), needs.pieces};
    return shows_same && compares_ ? FaceUpdate::compare : FaceUpdate::draw;
}

require::FacePart CaptureDecider::changed_part(std::uint32_t mirror, std::uint32_t face,
                                               const std::vector<std::uint32_t>& seen,
                                               const CachedFace& now) const {
    if (!had_same_layout(mirror)) return {};
    const CachedFace& before = before_->faces[mirror][face];
    if (before.content_hash == 0 || before.is_behind || before.still_hash != now.still_hash ||
        !before.pieces || !now.pieces)
        return {};
    require::FacePart part = require::find_changed_part(before.pieces->faces[face],
                                                        now.pieces->faces[face]);
    const shared::View& view = scene_.list_views()[scene_.capture_view(mirror) + face];
    // All mirrors that the capture shows are checked, because a mirror that only moved looks
    // different before its own capture changes.
    for (const std::uint32_t other : seen)
        part = unite(part, part_showing(view, static_cast<int>(face),
                                        scene_.draw_ranges()[scene_.mirror_object(other)].bounds));
    return part.is_empty() ? require::FacePart() : part;
}

std::uint64_t CaptureDecider::drawing_number(std::uint64_t content_hash,
                                             const std::vector<std::uint32_t>& seen) const {
    ContentHash number;
    number.add(content_hash);
    for (const std::uint32_t other : seen)
        for (std::uint32_t face = 0; face < 6; ++face)
            number.add(had_same_layout(other) ? before_->faces[other][face].drawing : 0);
    return std::max<std::uint64_t>(number.sum(), kClearedDrawing + 1);
}

} // namespace catoptric::render
