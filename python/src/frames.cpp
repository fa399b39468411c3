// Engines, sessions and frames.
#include "binding.hpp"

#include <catoptric/error.hpp>

#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <tuple>

namespace catoptric::python {

namespace {

struct RenderedFrame {
    session::TechniqueResult result;
    session::FrameTimes times;
    int frames = 1;       ///< number of frames that were rendered for it
    bool settled = false; ///< whether further frames would show the same
};

class PythonSession {
public:
    PythonSession(SharedEnginePointer shared, const scene::Scene& scene)
        : shared_(std::move(shared)) {
        session_ = run_on_engine(*shared_, [&](session::Engine& engine) {
            return std::make_unique<session::Session>(engine, scene);
        });
    }
    PythonSession(const PythonSession&) = delete;
    PythonSession& operator=(const PythonSession&) = delete;
    ~PythonSession() {
        run_on_engine(*shared_, [&](session::Engine&) { session_.reset(); });
    }

    const scene::Scene& scene() const { return session_->scene(); }

    void forget() {
        run_on_engine(*shared_, [&](session::Engine&) { session_->forget(); });
    }

    RenderedFrame frame(const session::FrameSpec& spec, int frames) {
        if (frames < 1)
            throw UsageError("frames: wanted at least 1, found " + std::to_string(frames));
        SignalWatch watch;
        const session::Watcher watcher = watch.watcher();
        RenderedFrame rendered{.frames = frames};
        run_on_engine(*shared_, [&](session::Engine&) {
            for (int k = 1; k <= frames && *watcher.stop == 0; ++k) {
                const session::Frame frame = session_->frame(spec);
                rendered.times = frame.times();
                if (k == frames) rendered.result = frame.read();
                watcher.on_frame(k, frames);
            }
        });
        watch.rethrow();
        return rendered;
    }

    RenderedFrame render(const session::FrameSpec& spec) {
        SignalWatch watch;
        RenderedFrame rendered;
        try {
            run_on_engine(*shared_, [&](session::Engine&) {
                session::Request request;
                static_cast<session::FrameSpec&>(request) = spec;
                request.frames += request.warmup; // as `catoptric render`
                request.warmup = 0;
                request.until_settled = true;
                session::RunResult run = session::run(*session_, request, watch.watcher());
                rendered = {std::move(run.parts.front()), std::move(run.frames.back()),
                            static_cast<int>(run.frames.size()), run.settled};
            });
        } catch (const Error&) {
            watch.rethrow();
            throw;
        }
        return rendered;
    }

private:
    SharedEnginePointer shared_;
    std::unique_ptr<session::Session> session_;
};

using Size = std::pair<std::int64_t, std::int64_t>;
using OptionalCamera = std::optional<scene::Camera>;
using OptionalNumber = std::optional<double>;

session::FrameSpec make_frame_spec(const scene::Scene& scene, const std::string& technique,
                                   const Size& size, const OptionalCamera& camera, double time,
                                   OptionalNumber exposure, OptionalNumber ambient,
                                   std::uint64_t seed, const std::string& model) {
    const SceneDefaults defaults = choose_defaults(scene, camera, ambient, exposure);
    session::FrameSpec spec;
    spec.techniques = {technique};
    spec.camera = defaults.camera;
    spec.size = parse_size(size);
    spec.time = time;
    spec.ambient = defaults.ambient;
    spec.exposure = defaults.exposure;
    spec.seed = seed;
    spec.model = parse_model(model);
    return spec;
}

using PassList = std::vector<std::tuple<std::string, double>>;

PassList passes(const RenderedFrame& frame) {
    PassList passes;
    for (const session::PassTime& pass : frame.times.passes)
        passes.emplace_back(pass.name, pass.ms());
    return passes;
}

void bind_engine(nb::module_& module) {
    nb::class_<session::DeviceInfo>(module, "Device", "A Vulkan device of this machine.")
        .def_ro("name", &session::DeviceInfo::name)
        .def_ro("driver", &session::DeviceInfo::driver)
        .def_ro("api", &session::DeviceInfo::api, "The version of Vulkan.")
        .def_ro("type", &session::DeviceInfo::type,
                "'discrete', 'integrated', 'cpu' or another type.")
        .def_ro("threads", &session::DeviceInfo::threads, "The number of threads of a cpu device.")
        .def_ro("missing", &session::DeviceInfo::missing,
                "Features that the engine needs and the device lacks. Empty: usable.")
        .def("__repr__",
             [](const session::DeviceInfo& device) { return "Device('" + device.name + "')"; });
    module.def(
        "devices", [] { return session::devices(); },
        "Returns the Vulkan devices of this machine.\n\n"
        "Raises:\n"
        "    NoDevice: No Vulkan driver is installed. The text names the package.");
    nb::class_<SharedEngine>(module, "Engine",
                             "A Vulkan device with the pipelines compiled for it.\n\n"
                             "Calls from several threads wait for each other.")
        .def(nb::new_(
                 [](const std::string& device, bool validate, const std::filesystem::path& cache) {
                     const nb::gil_scoped_release released;
                     return std::make_shared<SharedEngine>(session::EngineOptions{
                         .device = device, .validate = validate, .cache = cache});
                 }),
             nb::arg("device") = "", nb::kw_only(), nb::arg("validate") = false,
             nb::arg("cache") = "",
             "Opens a device.\n\n"
             "Args:\n"
             "    device: The index or a part of the name of a device. Empty: a discrete, else an\n"
             "        integrated, else a cpu device.\n"
             "    validate: Whether Vulkan's validation layer checks the calls.\n"
             "    cache: A folder that keeps compiled pipelines. Empty: none.\n\n"
             "Raises:\n"
             "    NoDevice: No Vulkan driver is installed, or no device has the needed features.")
        .def_prop_ro("device", [](const SharedEngine& shared) { return shared.engine.device(); })
        .def_prop_ro(
            "usable", [](const SharedEngine& shared) { return shared.engine.usable(); },
            "False once the device was lost.")
        .def_prop_ro(
            "warning", [](const SharedEngine& shared) { return shared.engine.warning(); },
            "A sentence for the user, such as on an unusable cache. Empty: none.");
}

void bind_frame(nb::module_& module) {
    using Frame = RenderedFrame;
    nb::class_<Frame>(module, "Frame",
                      "A rendered picture and its times.\n\n"
                      "On a device of type 'cpu', GPU times are times of the driver's threads.")
        .def_prop_ro(
            "hdr",
            [](nb::handle_t<Frame> self) {
                return share_picture(nb::cast<Frame&>(self).result.hdr, self);
            },
            "The picture: linear light, shape (height, width, 3), float32. Shares the frame's "
            "memory.")
        .def_prop_ro(
            "display",
            [](nb::handle_t<Frame> self) {
                return share_picture(nb::cast<Frame&>(self).result.display, self);
            },
            "The picture with exposure, as a display shows it: sRGB values that are multiples of "
            "1/255,\nshape (height, width, 3), float32. Shares the frame's memory.")
        .def_prop_ro("technique", [](const Frame& f) { return f.result.label; })
        .def_prop_ro(
            "gpu_ms", [](const Frame& f) { return f.times.gpu_ms; },
            "The time from the first to the last timestamp, milliseconds.")
        .def_prop_ro(
            "frame_ms", [](const Frame& f) { return f.times.frame_ms(); },
            "The time of host and device work, milliseconds. Waiting is not included.")
        .def_prop_ro(
            "wall_ms", [](const Frame& f) { return f.times.wall_ms; },
            "The time from submit until the device has finished, milliseconds.")
        .def_prop_ro("passes", &passes,
                     "The passes in order of execution: name and time in milliseconds.")
        .def_prop_ro(
            "scene_passes", [](const Frame& f) { return f.result.scene_passes; },
            "The number of renders of the scene. A cube map counts once.")
        .def_prop_ro(
            "memory_bytes", [](const Frame& f) { return f.result.memory_bytes; },
            "The size of the frame's images, bytes.")
        .def_prop_ro(
            "notes", [](const Frame& f) { return f.result.notes; },
            "Sentences on what differs from what was asked for.")
        .def_ro("frames", &Frame::frames, "The number of frames rendered for this picture.")
        .def_ro("settled", &Frame::settled,
                "Whether further frames would show the same picture. Only set by `render`.")
        .def("__repr__", [](const Frame& f) {
            return "Frame('" + f.result.label + "', " + std::to_string(f.result.hdr.width) + "x" +
                   std::to_string(f.result.hdr.height) + ", " + std::to_string(f.times.gpu_ms) +
                   " ms)";
        });
}

/// Defines a method with the arguments of make_frame_spec, and with further arguments. `more_text`
/// documents the further arguments.
template <typename Function, typename... Argument>
void define_frame(nb::class_<PythonSession>& session, const char* name, Function function,
                  const std::string& summary, const std::string& more_text,
                  const Argument&... more) {
    const std::string text =
        summary +
        "Args:\n"
        "    technique: A technique or a plan, such as 'parallax:face=64'.\n"
        "    size: Width and height, pixels.\n"
        "    camera: None: the scene's first camera.\n"
        "    time: Seconds into the scene's motion.\n"
        "    exposure: Stops, for `display`. None: the file's exposure, or 0.\n"
        "    ambient: Light that reaches all surfaces. None: 0 with an environment, else 0.05.\n"
        "    seed: The seed of sample patterns that are not a regular grid.\n"
        "    model: 'required': only what the picture needs is rendered. 'everything': each frame\n"
        "        captures each mirror.\n" +
        more_text +
        "\nRaises:\n"
        "    UsageError: An unknown technique or knob, or a value out of range.\n"
        "    DeviceLost: The device was lost. Make another engine.";
    session.def(name, function, nb::arg("technique") = "secant", nb::kw_only(),
                nb::arg("size") = Size(512, 512), nb::arg("camera") = nb::none(),
                nb::arg("time") = 0.0, nb::arg("exposure") = nb::none(),
                nb::arg("ambient") = nb::none(), nb::arg("seed") = 1, nb::arg("model") = "required",
                more..., text.c_str());
}

} // namespace

uvec2 parse_size(const std::pair<std::int64_t, std::int64_t>& size) {
    constexpr std::int64_t kMaxSide = 1 << 20; // the engine checks the limits of the device
    if (std::min(size.first, size.second) < 1 || std::max(size.first, size.second) > kMaxSide)
        throw UsageError("size: wanted (width, height) with sides from 1 to 1048576 pixels, found "
                         "(" +
                         std::to_string(size.first) + ", " + std::to_string(size.second) + ")");
    return uvec2(static_cast<unsigned>(size.first), static_cast<unsigned>(size.second));
}

session::RenderedWork parse_model(const std::string& name) {
    if (name == "everything") return session::RenderedWork::everything;
    if (name == "required") return session::RenderedWork::required;
    throw UsageError("model: wanted 'everything' or 'required', found '" + name + "'");
}

void bind_frames(nb::module_& module) {
    bind_engine(module);
    bind_frame(module);
    nb::class_<PythonSession> session(module, "Session",
                                      "A scene on a device. Uploaded data, compiled pipelines and "
                                      "history stay from frame to frame.");
    session.def(nb::init<SharedEnginePointer, const scene::Scene&>(), nb::arg("engine"),
                nb::arg("scene"),
                "Uploads a scene.\n\n"
                "Raises:\n"
                "    Exhausted: The scene exceeds the limits of the device.");
    session.def_prop_ro(
        "scene", [](const PythonSession& self) { return self.scene(); }, "A copy of the scene.");
    session.def("forget", &PythonSession::forget, "Makes a cut: the next frame has no history.");
    define_frame(
        session, "frame",
        [](PythonSession& self, const std::string& technique, const Size& size,
           const OptionalCamera& camera, double time, OptionalNumber exposure,
           OptionalNumber ambient, std::uint64_t seed, const std::string& model, int frames) {
            return self.frame(make_frame_spec(self.scene(), technique, size, camera, time, exposure,
                                              ambient, seed, model),
                              frames);
        },
        "Renders frames, and returns the last of them.\n\n"
        "A frame continues the history of the frame before. Frames with other techniques or\n"
        "another model than the frame before begin without history.\n\n",
        "    frames: The number of frames.\n", nb::arg("frames") = 1);
    define_frame(
        session, "render",
        [](PythonSession& self, const std::string& technique, const Size& size,
           const OptionalCamera& camera, double time, OptionalNumber exposure,
           OptionalNumber ambient, std::uint64_t seed, const std::string& model) {
            return self.render(make_frame_spec(self.scene(), technique, size, camera, time,
                                               exposure, ambient, seed, model));
        },
        "Renders frames without earlier history until the picture stays the same, at most 28.\n\n"
        "The picture has the bytes of the command `catoptric render`.\n\n",
        "");
}

} // namespace catoptric::python
