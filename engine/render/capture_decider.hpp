#pragma once

#include "render/capture_cache.hpp"
#include "require/model.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::render {

/// Decides for each mirror whether a frame keeps, clears, draws or compares the faces of the
/// mirror's capture.
class CaptureDecider {
public:
    /// `number`: of the frame in its sequence. `layout`: options of this frame's captures.
    /// `before`: captures of the frame before; null: there are none. All references must outlive
    /// this object. `compares`: captures that may have changed are compared.
    CaptureDecider(const GpuScene& scene, const require::WorkModel& model, std::uint64_t number,
                   const std::vector<CaptureOptions>& layout, const CaptureCache* before,
                   bool compares);

    /// Returns whether the frame before left a capture of the mirror with the same options.
    bool had_same_layout(std::uint32_t mirror) const;
    /// Returns for how many frames, up to the frame before, the redraw of the mirror's capture has
    /// waited.
    std::uint32_t frames_waited(std::uint32_t mirror) const;

    /// Fills the mirror's entries in `work` and `kept`.
    void decide(std::uint32_t mirror, CaptureWork& work, CaptureCache& kept) const;
    /// Returns whether the frame is one of those in which the mirror's capture may be drawn again
    /// (CaptureOptions::every).
    bool has_turn(std::uint32_t mirror) const;
    /// Returns whether drawing a mirror's capture again can wait for a later frame. For this, every
    /// face to be drawn must still have valid old contents.
    bool can_wait(std::uint32_t mirror, const CaptureWork& work) const;
    /// Cancels the redraw that `decide` asked for; the old contents stay.
    void postpone(std::uint32_t mirror, CaptureWork& work, CaptureCache& kept) const;

private:
    /// Returns the other mirrors whose captures the face shows.
    std::vector<std::uint32_t> visible_mirrors(std::uint32_t mirror, std::uint32_t face) const;
    FaceUpdate decide(std::uint32_t mirror, std::uint32_t face,
                      const std::vector<std::uint32_t>& seen, CachedFace& now) const;
    /// Returns the part of a drawn face that may differ from its old contents.
    require::FacePart changed_part(std::uint32_t mirror, std::uint32_t face,
                                   const std::vector<std::uint32_t>& seen,
                                   const CachedFace& now) const;
    /// Returns the number of a face's picture, from the content hash and the captures that the face
    /// shows.
    std::uint64_t drawing_number(std::uint64_t content_hash,
                                 const std::vector<std::uint32_t>& seen) const;

    const GpuScene& scene_;
    const require::WorkModel& model_;
    std::uint64_t number_;
    std::uint64_t decider_ = 0; // of all in this process: frames aside repeat the frame's number
    const std::vector<CaptureOptions>& layout_;
    const CaptureCache* before_;
    bool compares_;
    std::vector<char> changed_;
    /// Content hash of the shadow views and backdrops of all lights.
    std::uint64_t shadow_views_ = 0;
};

} // namespace catoptric::render
