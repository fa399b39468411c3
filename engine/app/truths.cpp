#include "app/truths.hpp"

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

Result Truths::rendered(const std::string& technique) const {
    Request request = base_;
    request.techniques = {technique};
    return run(session_, request, watcher_);
}

const Truth& Truths::at(const std::string& samples) {
    const auto found = truths_.find(samples);
    if (found != truths_.end()) return found->second;
    Result result = rendered(reference_at(reference_, samples));
    Truth made{std::move(result.parts.front()), {}};
    for (const FrameTimes& frame : result.frames) made.gpu_ms.push_back(frame.gpu_ms);
    return truths_.emplace(samples, std::move(made)).first->second;
}

std::vector<std::uint32_t> Truths::hits() {
    const std::vector<std::uint32_t>& known = at("1").part.hits;
    if (!known.empty()) return known;
    // For a reference that traces no rays of its own.
    return std::move(rendered("raytrace:depth=1").parts.front().hits);
}

} // namespace catoptric::app
