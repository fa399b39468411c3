#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"

#include <map>
#include <string>
#include <vector>

namespace catoptric::app {

/// What a row is judged against: the reference at the row's own sample count.
struct Truth {
    Part part;
    std::vector<double> gpu_ms;
};

/// "1" for rows that do not count samples.
std::string sample_count(const TechniqueChoice& choice);
/// The text of the reference with `samples` set; text without that knob stays as it is.
std::string reference_at(const std::string& reference, const std::string& samples);

/// The reference of a comparison, rendered once for each sample count that is asked for.
class Truths {
public:
    /// All must outlive this; `base` shows the session's scene.
    Truths(Session& session, const Request& base, const std::string& reference,
           const Watcher& watcher)
        : session_(session), base_(base), reference_(reference), watcher_(watcher) {}

    /// Valid as long as this. Throws as the watcher does.
    const Truth& at(const std::string& samples);
    /// What one ray through each pixel centre meets: first mirror | second mirror << 16.
    std::vector<std::uint32_t> hits();

private:
    Result rendered(const std::string& technique) const;

    Session& session_;
    const Request& base_;
    const std::string& reference_;
    const Watcher& watcher_;
    std::map<std::string, Truth> truths_;
};

} // namespace catoptric::app
