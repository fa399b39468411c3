#pragma once

#include "session/run.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::app {

/// Picture that a row is judged against: the reference at the row's own sample count.
struct ReferencePicture {
    TechniqueResult part;
    std::vector<double> gpu_ms;
};

/// Returns the sample count of a row as text; "1" for rows without the knob `samples`.
std::string find_sample_count(const TechniqueChoice& choice);
/// Returns the text of the reference with `samples` set, or the text unchanged if it has no such
/// knob.
std::string set_reference_samples(const std::string& reference, const std::string& samples);

/// The reference of a comparison, rendered once for each sample count and instant on demand.
class ReferenceCache {
public:
    /// All objects passed by reference must outlive the cache. `base` describes the scene that the
    /// session shows.
    ReferenceCache(Session& session, const Request& base, const std::string& reference,
                   const Watcher& watcher)
        : session_(session), base_(base), reference_(reference), watcher_(watcher) {}

    /// Returns the reference of a row's last frame. Valid as long as the cache. Throws as the
    /// watcher does.
    const ReferencePicture& find_reference(const std::string& samples) {
        return find_reference(samples, base_.total());
    }
    /// Returns the reference of a row's frame `number`, from 1.
    const ReferencePicture& find_reference(const std::string& samples, int number);
    /// Returns what one ray through each pixel centre meets: first mirror | second mirror << 16.
    /// Valid as long as the cache.
    const std::vector<std::uint32_t>& find_mirror_hits() { return find_mirror_hits(base_.total()); }
    const std::vector<std::uint32_t>& find_mirror_hits(int number);

private:
    /// Returns the frame that is rendered for frame `number`. All frames of a still scene are
    /// equal, so the last frame is rendered for each of them.
    int choose_frame_to_render(int number) const { return base_.animate ? number : base_.total(); }
    RunResult render_reference(const std::string& technique, int number) const;

    Session& session_;
    const Request& base_;
    const std::string& reference_;
    const Watcher& watcher_;
    std::map<std::pair<std::string, int>, ReferencePicture> truths_; ///< by sample count and frame
    /// First hits of the reference's camera rays, by frame number.
    std::map<int, std::vector<std::uint32_t>> hits_;
};

} // namespace catoptric::app
