#include "reference.hpp"

#include "measure/display.hpp"
#include "measure/flip.hpp"
#include "measure/masks.hpp"

namespace catoptric::view {

namespace {

app::TechniqueResult render_traced(app::Session& session, app::FrameSpec spec,
                                   const std::string& technique, std::uint64_t seed) {
    spec.techniques = {technique};
    spec.seed = seed;
    spec.keeps_history = true;
    return session.frame(spec).read();
}

} // namespace

std::vector<std::uint32_t> render_mirror_hits(app::Session& session, const app::FrameSpec& spec) {
    return render_traced(session, spec, "raytrace:depth=1,shadow=none", spec.seed).hits;
}

bool ProgressiveReference::render_one_pass(app::Session& session, const app::FrameSpec& spec) {
    if (passes_ == kMaxReferencePasses) return false;
    if (passes_ == 0) {
        app::TechniqueResult part = render_traced(session, spec, "raytrace:depth=16", spec.seed);
        hits_ = std::move(part.hits);
        centre_ = std::move(part.hdr);
        sum_ = measure::Picture(centre_.width, centre_.height);
        display_ = std::make_shared<measure::Picture>(std::move(part.display));
        passes_ = 1;
        return true;
    }
    const measure::Picture more = render_traced(session, spec, "raytrace:depth=16,samples=2",
                                                static_cast<std::uint64_t>(passes_))
                                      .hdr;
    measure::Picture mean = sum_;
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        sum_.pixels[i] += more.pixels[i];
        mean.pixels[i] = sum_.pixels[i] / static_cast<float>(passes_);
    }
    display_ = std::make_shared<measure::Picture>(measure::to_display(mean, spec.exposure));
    ++passes_;
    return true;
}

measure::Difference ProgressiveReference::compare_with_reference(const measure::Picture& hdr,
                                                                 double exposure) const {
    const std::vector<float> map = measure::flip(measure::to_unrounded_display(hdr, exposure),
                                                 measure::to_unrounded_display(centre_, exposure));
    return measure::difference(measure::apply_exposure(hdr, exposure),
                               measure::apply_exposure(centre_, exposure),
                               measure::mask_mirror_pixels(hits_), map);
}

} // namespace catoptric::view
