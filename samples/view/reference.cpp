#include "reference.hpp"

#include "measure/display.hpp"
#include "measure/flip.hpp"
#include "measure/masks.hpp"
#include "study/reference_cache.hpp"

namespace catoptric::view {

namespace {

constexpr std::uint64_t kFirstReferenceSeed = 1'000'000;

session::TechniqueResult render_ray_traced(session::Session& session, session::FrameSpec spec,
                                           const std::string& technique, std::uint64_t seed) {
    spec.techniques = {technique};
    spec.seed = seed;
    spec.keeps_history = true;
    return session.frame(spec).read();
}

} // namespace

std::vector<std::uint32_t> render_mirror_hits(session::Session& session,
                                              const session::FrameSpec& spec) {
    return render_ray_traced(session, spec, "raytrace:depth=1,shadow=none", spec.seed).hits;
}

/// Adds a picture to the mean that is displayed.
void ProgressiveReference::add_pass(const measure::Picture& picture, double exposure) {
    measure::Picture mean = sum_;
    ++summed_;
    for (std::size_t i = 0; i < mean.pixels.size(); ++i) {
        sum_.pixels[i] += picture.pixels[i];
        mean.pixels[i] = sum_.pixels[i] / static_cast<float>(summed_);
    }
    display_ = std::make_shared<measure::Picture>(measure::to_display(mean, exposure));
    if (has_noise_) judged_ = std::move(mean);
}

bool ProgressiveReference::render_pass(session::Session& session, const session::FrameSpec& spec) {
    if (passes_ == kMaxPasses) return false;
    const auto pass = static_cast<std::uint64_t>(passes_);
    if (passes_++ > 0) {
        // A row with random rays has the seed 0 unless the user sets a seed, so the reference takes
        // other seeds.
        const std::string technique = has_noise_ ? "raytrace:depth=16,rays=16,seed=" +
                                                       std::to_string(kFirstReferenceSeed + pass)
                                                 : "raytrace:depth=16,samples=2";
        add_pass(render_ray_traced(session, spec, technique, pass).hdr, spec.exposure);
        return true;
    }
    has_noise_ = study::is_noisy("raytrace:depth=16,rays=16", session.scene());
    session::TechniqueResult part = render_ray_traced(session, spec, "raytrace:depth=16",
                                                      spec.seed);
    hits_ = std::move(part.hits);
    judged_ = std::move(part.hdr);
    sum_ = measure::Picture(judged_.width, judged_.height);
    display_ = std::make_shared<measure::Picture>(std::move(part.display));
    return true;
}

measure::Difference ProgressiveReference::compare(const measure::Picture& hdr,
                                                  double exposure) const {
    const std::vector<float> map = measure::flip(measure::to_unrounded_display(hdr, exposure),
                                                 measure::to_unrounded_display(judged_, exposure));
    return measure::difference(measure::apply_exposure(hdr, exposure),
                               measure::apply_exposure(judged_, exposure),
                               measure::mask_mirrors(hits_), map);
}

} // namespace catoptric::view
