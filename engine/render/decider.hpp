#pragma once

#include "render/capture_cache.hpp"

#include <cstdint>
#include <vector>

namespace catoptric::render {

/// Tells what a frame has to do with its captures, mirror by mirror.
class Decider {
public:
    /// `layout`: of the frame's captures; `before`: of the frame before, null: there was none. Both
    /// and the others must outlive this. `compares`: what may have changed is compared.
    Decider(const GpuScene& scene, const require::Model& model,
            const std::vector<CaptureOptions>& layout, const CaptureCache* before, bool compares);

    /// Whether the frame before has a capture of the mirror as this one wants it.
    bool was_there(std::uint32_t mirror) const;
    /// Frames for which the mirror has been put off until the frame before.
    std::uint32_t waited(std::uint32_t mirror) const;

    /// What is drawn of the mirror, compared and kept; six faces of `work`, and `kept` of it.
    void decide(std::uint32_t mirror, CaptureWork& work, CaptureCache& kept) const;
    /// Whether what is to be drawn can stay as it was: it shows what was there once, and was kept
    /// up since then.
    bool can_wait(std::uint32_t mirror, const CaptureWork& work) const;
    /// After `decide`: what was to be drawn stays as it was.
    void put_off(std::uint32_t mirror, CaptureWork& work, CaptureCache& kept) const;

private:
    /// The other mirrors that the face shows by their captures.
    std::vector<std::uint32_t> seen_by(std::uint32_t mirror, std::uint32_t face) const;
    FaceWork decide(std::uint32_t mirror, std::uint32_t face,
                    const std::vector<std::uint32_t>& seen, CachedFace& now) const;
    /// Of a face that is drawn: all that may be another than it was.
    require::FacePart changing(std::uint32_t mirror, std::uint32_t face,
                               const std::vector<std::uint32_t>& seen, const CachedFace& now) const;
    /// By what it is made from, to the captures that it shows.
    std::uint64_t drawing(std::uint64_t content_hash, const std::vector<std::uint32_t>& seen) const;

    const GpuScene& scene_;
    const require::Model& model_;
    const std::vector<CaptureOptions>& layout_;
    const CaptureCache* before_;
    bool compares_;
    std::vector<char> changed_;
    std::uint64_t shadow_views_ = 0; ///< of all lights
};

} // namespace catoptric::render
