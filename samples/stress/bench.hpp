#pragma once

#include "core/error.hpp"
#include "report/stress.hpp"
#include "session/access.hpp"
#include "session/run.hpp"
#include "session/watcher.hpp"

#include <random>

namespace catoptric::stress {

/// Renders pictures of test scenes for one property, and adds measured results to the property's
/// row.
class Bench {
public:
    Bench(session::Engine& engine, const session::Watcher& watcher, uvec2 size, std::uint64_t seed,
          report::StressRow& row)
        : bench_engine_(engine), watcher_(watcher), size_(size), random_(seed), row_(row) {}

    /// Returns a request for the scene as its first camera sees it, for the picture after `frames`
    /// frames at rest. These are defaults: a property may change any field.
    session::Request make_request(const scene::Scene& scene, const std::string& technique,
                                  int frames = 4) const;
    session::TechniqueResult render_technique(const session::Request& request);
    /// Renders one frame of a property's own loop. Throws if the user stopped the run.
    session::Frame render_frame(session::Session& session, const session::FrameSpec& spec,
                                const session::FrameHooks& hooks = {}) {
        throw_if_stopped(watcher_);
        return session::Access::render_frame(session, spec, hooks);
    }
    /// Compiles the plan of the request's frame without rendering.
    void plan_technique(const session::Request& request);
    session::TechniqueResult render_technique(const scene::Scene& scene,
                                              const std::string& technique, int frames = 4) {
        return render_technique(make_request(scene, fit_captures(technique), frames));
    }

    /// Returns whether pictures are so small that default captures and shadow maps are much finer
    /// than their pixels.
    bool has_small_pictures() const { return std::max(size_.x, size_.y) < 128; }
    /// Returns the technique, for small pictures with smaller captures and shadow maps than the
    /// default: the defaults would take most of the time. Options in the text stay.
    std::string fit_captures(const std::string& technique) const;

    void add_case(std::string what, double measured, double limit) {
        row_.cases.push_back({std::move(what), measured, limit, false});
    }
    /// Adds a measured value with a limit. A value beyond the limit means that the picture looks
    /// worse, but is not wrong. `seen`: what a user then sees.
    void add_warning(std::string what, double measured, double limit, std::string seen) {
        row_.cases.push_back({std::move(what), measured, limit, true, std::move(seen)});
    }
    /// Adds the mean FLIP of two pictures. Keeps both pictures if it is above the limit. With
    /// `seen` the case only warns, as add_warning.
    void add_flip(const std::string& what, const session::TechniqueResult& found,
                  const session::TechniqueResult& wanted, double limit,
                  const std::string& seen = {});
    /// Adds the number of pixels that are NaN or infinite, with limit 0.
    void add_nonfinite(const std::string& what, const session::TechniqueResult& part);
    /// Adds a part that the device does not allow. It is reported and has no measured value.
    void add_skipped(std::string what, const Error& error) {
        row_.not_run.push_back({std::move(what), error.what()});
    }
    /// Adds a case with limit 0, which passes if `work` succeeds. If `work` throws an error about a
    /// limit of the device, the part counts as not run. Returns whether `work` succeeded.
    bool add_attempt(const std::string& what, const std::function<void()>& work);
    /// Adds a case with limit 0, which passes if `work` throws an error of this kind whose text
    /// contains `limit`.
    void add_expected_error(const std::string& what, Failure failure, const std::string& limit,
                            const std::function<void()>& work);

    /// Returns whether an error ends the whole run: a signal arrived, the device is lost or lacks a
    /// feature, or memory ran out below the device's limit. Other errors are results of the
    /// property.
    bool ends_run(const Error& error) const;

    session::Engine& bench_engine() { return bench_engine_; }
    uvec2 picture_size() const { return size_; }
    /// Returns the picture size with both edges raised to `edge`, for figures that are shares or
    /// means of few pixels: in smaller pictures they would measure chance.
    uvec2 size_at_least(std::uint32_t edge) const { return max(size_, uvec2(edge)); }
    /// Returns a random number in [low, high).
    double random(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }

private:
    session::Engine& bench_engine_;
    const session::Watcher& watcher_;
    uvec2 size_;
    std::mt19937_64 random_;
    report::StressRow& row_;
};

/// Returns whether an error reports that a resource is exhausted, with a text that states the
/// device's limit.
bool is_refusal(const Error& error);
/// Returns the number of pixels with a NaN or infinity.
std::size_t count_nonfinite(const measure::Picture& picture);
/// Returns the largest channel of all pixels, or NaN if a pixel is not finite.
double brightest_channel(const measure::Picture& picture);
std::size_t count_different(const measure::Picture& a, const measure::Picture& b);

} // namespace catoptric::stress
