#include "render/capture_decider.hpp"

#include "core/content_hash.hpp"
#include "render/face_area.hpp"
#include "render/views.hpp"
#include "require/model.hpp"

#include <algorithm>

namespace catoptric::render {

namespace {

constexpr std::uint64_t kClearedCaptureFaceHash = 1; // `drawing` of a face that holds nothing

} // namespace

CaptureUpdateDecider::CaptureUpdateDecider(const GpuScene& scene, const require::WorkModel& model,
                                           const std::vector<CaptureOptions>& layout,
                                           const CaptureCache* before, bool compares)
    : gpu_scene_(scene), model_(model), layout_(layout), before_(before), compares_(compares) {
    if (before) changed_ = find_changed_captures(*before);
    ContentHash lit;
    for (std::uint32_t light = 0; light < scene.light_count(); ++light) {
        lit.add_values(std::span(scene.shadowless_backdrops_of_light(light)));
        for (std::uint32_t face = 0; face < scene.drawn_shadow_faces(light); ++face)
            lit.add(scene.list_views()[scene.shadow_view_index(light) + face]);
    }
    shadow_views_ = lit.sum();
}

bool CaptureUpdateDecider::had_same_capture_layout_before(std::uint32_t mirror) const {
    return before_ && layout_[mirror].face > 0 &&
           have_equal_capture_contents(before_->options[mirror], layout_[mirror]);
}

std::uint32_t CaptureUpdateDecider::frames_redraw_waited(std::uint32_t mirror) const {
    return had_same_capture_layout_before(mirror) ? before_->waited[mirror] : 0;
}

void CaptureUpdateDecider::decide_capture_face_work(std::uint32_t mirror, CaptureWorkOfFrame& work,
                                                    CaptureCache& kept) const {
    CaptureChangeKind change = CaptureChangeKind::none;
    std::vector<std::uint32_t>& saw = kept.saw[mirror];
    for (std::uint32_t face = 0; face < 6; ++face) {
        const std::vector<std::uint32_t> seen = mirrors_visible_in_capture_face(mirror, face);
        const CaptureFaceUpdateKind what = decide_capture_face_work(mirror, face, seen,
                                                                    kept.faces[mirror][face]);
        work.faces[mirror][face] = what;
        if (work.is_face_drawn(mirror, face))
            work.parts[mirror][face] = changed_part_of_capture_face(mirror, face, seen,
                                                                    kept.faces[mirror][face]);
        if (what == CaptureFaceUpdateKind::draw) change = CaptureChangeKind::some;
        if (what != CaptureFaceUpdateKind::compare) continue;
        change = std::max(change, CaptureChangeKind::unknown);
        saw.insert(saw.end(), seen.begin(), seen.end());
    }
    kept.changes[mirror] = change;
}

bool CaptureUpdateDecider::can_capture_redraw_wait(std::uint32_t mirror,
                                                   const CaptureWorkOfFrame& work) const {
    if (!had_same_capture_layout_before(mirror)) return false;
    for (std::uint32_t face = 0; face < 6; ++face)
        if (work.is_face_drawn(mirror, face) && before_->faces[mirror][face].content_hash == 0)
            return false;
    return true;
}

void CaptureUpdateDecider::postpone_capture_redraw(std::uint32_t mirror, CaptureWorkOfFrame& work,
                                                   CaptureCache& kept) const {
    for (std::uint32_t face = 0; face < 6; ++face) {
        if (!work.is_face_drawn(mirror, face)) continue;
        kept.faces[mirror][face] = before_->faces[mirror][face];
        kept.faces[mirror][face].is_behind = true;
        work.faces[mirror][face] = CaptureFaceUpdateKind::keep, work.parts[mirror][face] = {};
    }
    kept.changes[mirror] = CaptureChangeKind::none;
    kept.saw[mirror].clear();
    kept.waited[mirror] = before_->waited[mirror] + 1;
}

std::vector<std::uint32_t>
CaptureUpdateDecider::mirrors_visible_in_capture_face(std::uint32_t mirror,
                                                      std::uint32_t face) const {
    const shared::View& view =
        gpu_scene_.list_views()[gpu_scene_.capture_view_index(mirror) + face];
    std::vector<std::uint32_t> seen;
    for (const std::uint32_t other : model_.mirrors[mirror].sees)
        if (layout_[other].face > 0 &&
            may_view_show_box(
                view, gpu_scene_.list_draw_ranges()[gpu_scene_.object_index_of_mirror(other)]))
            seen.push_back(other);
    return seen;
}

CaptureFaceUpdateKind
CaptureUpdateDecider::decide_capture_face_work(std::uint32_t mirror, std::uint32_t face,
                                               const std::vector<std::uint32_t>& seen,
                                               CachedCaptureFace& now) const {
    const require::MirrorRequirements& needs = model_.mirrors[mirror];
    ContentHash shown =
        ContentHash(shadow_views_)
            .add(gpu_scene_.list_views()[gpu_scene_.capture_view_index(mirror) + face]);
    for (const std::uint32_t other : seen) shown.add(other);
    const std::uint64_t content_hash = ContentHash(shown).add(needs.content_hashes[face]).sum();
    now = had_same_capture_layout_before(mirror) ? before_->faces[mirror][face]
                                                 : CachedCaptureFace();
    const bool shows_same = now.drawing > 0 && now.content_hash == content_hash;
    const auto has_changed = [&](std::uint32_t other) { return changed_[other] != 0; };
    if (shows_same && !now.is_behind && std::ranges::none_of(seen, has_changed))
        return CaptureFaceUpdateKind::keep;
    if (!needs.is_captured || !(needs.faces >> face & 1)) {
        // Without a content hash, the face is drawn as soon as a ray needs it again.
        now.content_hash = 0, now.is_behind = false;
        if (now.drawing > 0) return CaptureFaceUpdateKind::keep;
        now.drawing = kClearedCaptureFaceHash;
        return CaptureFaceUpdateKind::clear;
    }
    now = {content_hash, drawing_number_of_capture_face(content_hash, seen), false,
           ContentHash(shown).add(needs.settings[face]).sum(), needs.pieces};
    return shows_same && compares_ ? CaptureFaceUpdateKind::compare : CaptureFaceUpdateKind::draw;
}

require::FacePart
CaptureUpdateDecider::changed_part_of_capture_face(std::uint32_t mirror, std::uint32_t face,
                                                   const std::vector<std::uint32_t>& seen,
                                                   const CachedCaptureFace& now) const {
    if (!had_same_capture_layout_before(mirror)) return {};
    const CachedCaptureFace& before = before_->faces[mirror][face];
    if (before.content_hash == 0 || before.is_behind || before.settings != now.settings ||
        !before.pieces || !now.pieces)
        return {};
    require::FacePart part = require::find_changed_part(before.pieces->faces[face],
                                                        now.pieces->faces[face]);
    const shared::View& view =
        gpu_scene_.list_views()[gpu_scene_.capture_view_index(mirror) + face];
    // All mirrors that the capture shows are checked, because a mirror that only moved looks
    // different before its own capture changes.
    for (const std::uint32_t other : seen)
        part = unite(
            part,
            face_part_showing_box(
                view, static_cast<int>(face),
                gpu_scene_.list_draw_ranges()[gpu_scene_.object_index_of_mirror(other)].bounds));
    return part.is_empty() ? require::FacePart() : part;
}

std::uint64_t
CaptureUpdateDecider::drawing_number_of_capture_face(std::uint64_t content_hash,
                                                     const std::vector<std::uint32_t>& seen) const {
    ContentHash number;
    number.add(content_hash);
    for (const std::uint32_t other : seen)
        for (std::uint32_t face = 0; face < 6; ++face)
            number.add(had_same_capture_layout_before(other) ? before_->faces[other][face].drawing
                                                             : 0);
    return std::max<std::uint64_t>(number.sum(), kClearedCaptureFaceHash + 1);
}

} // namespace catoptric::render
