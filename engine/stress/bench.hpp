#pragma once

#include "app/run.hpp"
#include "app/watcher.hpp"
#include "core/error.hpp"
#include "report/stress.hpp"

#include <random>

namespace catoptric::stress {

/// What a property judges with: pictures of scenes, and the row that its figures go to.
class Bench {
public:
    Bench(app::Engine& engine, const app::Watcher& watcher, uvec2 size, std::uint64_t seed,
          report::StressRow& row)
        : engine_(engine), watcher_(watcher), size_(size), random_(seed), row_(row) {}

    /// Seen by the scene's first camera; the picture after `frames` frames at rest. Fields of
    /// `request` that a property needs otherwise are set by it: `asked` is this bench's default for
    /// it.
    app::Request asked(const scene::Scene& scene, const std::string& technique,
                       int frames = 4) const;
    app::Part render(const app::Request& request);
    /// One frame of a property's own loop.
    app::Frame frame(app::Session& session, const app::FrameSpec& spec) {
        watcher_.check_stopped();
        return session.frame(spec);
    }
    /// Compiles the plan of the request's frame and renders nothing.
    void plan(const app::Request& request);
    app::Part render(const scene::Scene& scene, const std::string& technique, int frames = 4) {
        return render(asked(scene, technique, frames));
    }

    /// A figure and its limit.
    void add(std::string what, double measured, double limit) {
        row_.cases.push_back({std::move(what), measured, limit, false});
    }
    /// The same where more looks worse but is not wrong.
    void add_quality(std::string what, double measured, double limit) {
        row_.cases.push_back({std::move(what), measured, limit, true});
    }
    /// Mean FLIP of two pictures; both are kept where it is above the limit.
    void add_flip(const std::string& what, const app::Part& found, const app::Part& wanted,
                  double limit, bool is_quality = false);
    /// Pixels that are no numbers; limit 0.
    void add_nonfinite(const std::string& what, const app::Part& part);
    /// What the device does not allow: it is told, and has no figure.
    void add_not_run(std::string what, const Error& error) {
        row_.not_run.push_back({std::move(what), error.what()});
    }
    /// That `work` is done (limit 0), or ends in an error that says what the device allows: then it
    /// is not run. True when it was done.
    bool add_done_or_refused(const std::string& what, const std::function<void()>& work);
    /// That `work` ends in an error of this kind whose text names `limit`; limit 0.
    void add_refused(const std::string& what, Failure failure, const std::string& limit,
                     const std::function<void()>& work);

    /// Whether an error is nothing that a property found: a signal came, the device is gone or
    /// lacks something, or memory ran out below what the device allows.
    bool ends_run(const Error& error) const;

    app::Engine& engine() { return engine_; }
    uvec2 size() const { return size_; }
    /// In [low, high).
    double random(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) * 0x1p-53;
    }

private:
    app::Engine& engine_;
    const app::Watcher& watcher_;
    uvec2 size_;
    std::mt19937_64 random_;
    report::StressRow& row_;
};

/// Out of something, with a text that says how much of it the device allows.
bool is_refusal(const Error& error);
/// Pixels with a NaN or infinity.
std::size_t nonfinite(const measure::Picture& picture);
/// The largest channel of all; NaN where some pixel is no number.
double brightest(const measure::Picture& picture);
std::size_t different_pixels(const measure::Picture& a, const measure::Picture& b);

} // namespace catoptric::stress
