#include "study/reference_cache.hpp"
#include "session/technique_choice.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::app {

std::string find_sample_count(const TechniqueChoice& choice) {
    for (const auto& setting : choice.settings)
        if (choice.technique == "raytrace" && setting.name == "samples") return setting.text;
    return "1";
}

std::string set_reference_samples(const std::string& reference, const std::string& samples) {
    if (samples == "1" || parse_technique(reference).technique != "raytrace") return reference;
    return reference + (reference.find(':') == std::string::npos ? ":" : ",") +
           "samples=" + samples;
}

RunResult ReferenceCache::render_reference(const std::string& technique, int number) const {
    Request request = base_;
    request.techniques = {technique};
    request.model = RenderedWork::everything;
    request.warmup = std::min(request.warmup, number - 1);
    request.frames = number - request.warmup;
    return run(session_, request, watcher_);
}

const ReferencePicture& ReferenceCache::find_reference(const std::string& samples, int number) {
    const std::pair key(samples, choose_frame_to_render(number));
    const auto found = truths_.find(key);
    if (found != truths_.end()) return found->second;
    RunResult result = render_reference(set_reference_samples(reference_, samples), key.second);
    ReferencePicture made{std::move(result.parts.front()), {}};
    for (const FrameTimes& frame : result.frames) made.gpu_ms.push_back(frame.gpu_ms);
    return truths_.emplace(key, std::move(made)).first->second;
}

const std::vector<std::uint32_t>& ReferenceCache::find_mirror_hits(int number) {
    const std::vector<std::uint32_t>& known = find_reference("1", number).part.hits;
    if (!known.empty()) return known;
    // A reference that traces no rays has no hits, so a ray-traced picture provides them.
    std::vector<std::uint32_t>& traced = hits_[choose_frame_to_render(number)];
    if (traced.empty())
        traced = std::move(render_reference("raytrace:depth=1", choose_frame_to_render(number))
                               .parts.front()
                               .hits);
    return traced;
}

} // namespace catoptric::app
