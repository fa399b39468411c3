#include "study/reference_cache.hpp"
#include "session/technique_choice.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::app {

std::string sample_count(const TechniqueChoice& choice) {
    for (const auto& setting : choice.settings)
        if (choice.technique == "raytrace" && setting.name == "samples") return setting.text;
    return "1";
}

std::string reference_at(const std::string& reference, const std::string& samples) {
    if (samples == "1" || parse_technique(reference).technique != "raytrace") return reference;
    return reference + (reference.find(':') == std::string::npos ? ":" : ",") +
           "samples=" + samples;
}

Result ReferenceCache::rendered(const std::string& technique, int number) const {
    Request request = base_;
    request.techniques = {technique};
    request.model = Modelling::everything;
    request.warmup = std::min(request.warmup, number - 1);
    request.frames = number - request.warmup;
    return run(session_, request, watcher_);
}

const ReferencePicture& ReferenceCache::at(const std::string& samples, int number) {
    const std::pair key(samples, frame_of(number));
    const auto found = truths_.find(key);
    if (found != truths_.end()) return found->second;
    Result result = rendered(reference_at(reference_, samples), key.second);
    ReferencePicture made{std::move(result.parts.front()), {}};
    for (const FrameTimes& frame : result.frames) made.gpu_ms.push_back(frame.gpu_ms);
    return truths_.emplace(key, std::move(made)).first->second;
}

const std::vector<std::uint32_t>& ReferenceCache::hits(int number) {
    const std::vector<std::uint32_t>& known = at("1", number).part.hits;
    if (!known.empty()) return known;
    // A reference that traces no rays has no hits, so a ray-traced picture provides them.
    std::vector<std::uint32_t>& traced = hits_[frame_of(number)];
    if (traced.empty())
        traced = std::move(rendered("raytrace:depth=1", frame_of(number)).parts.front().hits);
    return traced;
}

} // namespace catoptric::app
