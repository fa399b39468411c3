#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace catoptric::app {

/// What a row is judged against: the reference at the row's own sample count.
struct ReferencePicture {
    Part part;
    std::vector<double> gpu_ms;
};

/// "1" for rows that do not count samples.
std::string sample_count(const TechniqueChoice& choice);
/// The text of the reference with `samples` set; text without that knob stays as it is.
std::string reference_at(const std::string& reference, const std::string& samples);

/// The reference of a comparison, rendered once for each sample count and instant that is asked
/// for.
class ReferenceCache {
public:
    /// All must outlive this; `base` shows the session's scene.
    ReferenceCache(Session& session, const Request& base, const std::string& reference,
                   const Watcher& watcher)
        : session_(session), base_(base), reference_(reference), watcher_(watcher) {}

    /// Of a row's last frame. Valid as long as this. Throws as the watcher does.
    const ReferencePicture& at(const std::string& samples) { return at(samples, base_.total()); }
    /// Of its frame `number`, from 1.
    const ReferencePicture& at(const std::string& samples, int number);
    /// What one ray through each pixel centre meets: first mirror | second mirror << 16. Valid as
    /// long as this.
    const std::vector<std::uint32_t>& hits() { return hits(base_.total()); }
    const std::vector<std::uint32_t>& hits(int number);

private:
    /// The frame that stands for frame `number`: all of a still scene show the same.
    int frame_of(int number) const { return base_.animate ? number : base_.total(); }
    Result rendered(const std::string& technique, int number) const;

    Session& session_;
    const Request& base_;
    const std::string& reference_;
    const Watcher& watcher_;
    std::map<std::pair<std::string, int>, ReferencePicture> truths_; ///< by sample count and frame
    std::map<int, std::vector<std::uint32_t>> hits_;                 ///< by frame
};

} // namespace catoptric::app
