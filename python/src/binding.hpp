#pragma once

#include <catoptric/picture.hpp>
#include <catoptric/scene.hpp>
#include <catoptric/session.hpp>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

/// The Python module `_catoptric`, which binds the public interface of the library.
namespace catoptric::python {

namespace nb = nanobind;

void bind_pictures(nb::module_& module);
void bind_scenes(nb::module_& module);
void bind_frames(nb::module_& module);
void bind_comparisons(nb::module_& module);

/// A picture as an array: shape (height, width, 3), float32, row-major.
using PictureArray = nb::ndarray<nb::numpy, float, nb::shape<-1, -1, 3>, nb::c_contig>;
/// An argument that is a picture. Other element types are converted.
using PictureArgument =
    nb::ndarray<const float, nb::shape<-1, -1, 3>, nb::c_contig, nb::device::cpu>;
using MapArray = nb::ndarray<nb::numpy, float, nb::ndim<2>, nb::c_contig>;

/// Returns an array that shares the picture's memory. `owner` is the object that keeps the picture.
PictureArray share_picture(measure::Picture& picture, nb::handle owner);
/// Returns an array that owns the picture's memory.
PictureArray own_picture(measure::Picture&& picture);
/// Returns a copy of the array. Throws `usage` if the array is too large for a picture.
measure::Picture copy_picture(const PictureArgument& array);

/// An engine for several Python threads. Only one thread may use an engine at a time, so each call
/// locks it. The mutex is recursive, because a signal handler of Python may run within a call. A
/// thread must not wait for the mutex while it has the GIL.
struct SharedEngine {
    explicit SharedEngine(const session::EngineOptions& options) : engine(options) {}
    session::Engine engine;
    std::recursive_mutex mutex;
};
using SharedEnginePointer = std::shared_ptr<SharedEngine>;

/// Runs `work` with the engine locked and the GIL released.
template <typename Work>
auto run_on_engine(SharedEngine& shared, Work&& work) {
    const nb::gil_scoped_release released;
    const std::scoped_lock lock(shared.mutex);
    return work(shared.engine);
}

/// Ends long work when a Python signal handler raises an exception, such as KeyboardInterrupt.
class SignalWatch {
public:
    session::Watcher watcher() {
        session::Watcher watcher;
        watcher.on_frame = [this](int, int) { run_signal_handlers(); };
        watcher.stop = &stop_;
        return watcher;
    }
    /// Raises the handler's exception, if there is one. The caller has the GIL.
    void rethrow() {
        if (error_) throw nb::python_error(*error_);
    }

private:
    void run_signal_handlers() {
        constexpr auto kLongestWait = std::chrono::milliseconds(50); // fast frames check rarely
        const auto now = std::chrono::steady_clock::now();
        if (error_ || now - last_ < kLongestWait) return;
        last_ = now;
        const nb::gil_scoped_acquire acquired;
        if (PyErr_CheckSignals() == 0) return;
        error_ = std::make_unique<nb::python_error>();
        stop_ = 2; // SIGINT
    }
    std::atomic<int> stop_ = 0;
    std::chrono::steady_clock::time_point last_{};
    std::unique_ptr<nb::python_error> error_;
};

/// Settings of a frame or comparison that have a default of the scene.
struct SceneDefaults {
    scene::Camera camera;
    double ambient = 0;
    double exposure = 0;
    bool auto_exposure = false; ///< the file gives no exposure
};
/// Returns the defaults of the command line. Throws `usage` if the scene has no camera and none is
/// given.
SceneDefaults choose_defaults(const scene::Scene& scene, const std::optional<scene::Camera>& camera,
                              std::optional<double> ambient, std::optional<double> exposure);

/// `name`: "everything" or "required".
session::RenderedWork parse_model(const std::string& name);

/// Returns the size of a picture from (width, height). Throws `usage` for a side below 1.
uvec2 parse_size(const std::pair<std::int64_t, std::int64_t>& size);

} // namespace catoptric::python
