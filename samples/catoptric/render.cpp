// catoptric render: renders one picture, or a sequence.
#include "camera_path.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "core/image_module.hpp"
#include "file_sequence.hpp"
#include "json.hpp"
#include "measure/picture.hpp"
#include "measure/picture_file.hpp"
#include "measure/statistics.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "progress.hpp"
#include "scene/hash.hpp"
#include "session/capture_budget.hpp"
#include "session/exposure.hpp"
#include "session/frames.hpp"
#include "session/run.hpp"
#include "session/scene_facts.hpp"
#include "session/technique_choice.hpp"
#include "session/watcher.hpp"
#include "technique_option.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace catoptric::cli {

namespace {

constexpr const char* kRenderExamples = R"(Examples:
  catoptric render --technique parallax -o parallax.png
  catoptric render scene.glb --technique raytrace:samples=16 -o truth.exr
  catoptric render --technique reuse --frames 60 --trace frame.json -o last.png
  catoptric render --technique reuse --animate --frames 60 -o 'frame-{n:3}.png'
  catoptric render --technique secant --camera-path path.json -o 'p-{n:4}.png'
  catoptric render --technique naive:bounces=2 -o - | display
  catoptric render --plan "1=hybrid 2,3=secant:face=64 *=reuse" -o mixed.png

A still picture takes one frame, or with last frame's captures as many frames as change a pixel, at most 28.
With --budget-ms it takes at most 28 rounds of all mirrors; the picture does not depend on the budget.
The camera of --camera-path moves from the first measured frame on, 1/60 s a frame, to the end of the path or
for --frames. The file is {"keys": [{"time": 0, "camera": "0,1,4:0,1,0:45"}, {"time": 2, "camera": "..."}]}.
With --animate, --camera-path, --frames, --warmup, --profile or --trace, frames are counted and timed as in compare.
The picture is then that of the last frame. With {n}, {n:3}, %d or %03d in its name, one picture per measured
frame is written, numbered from 1.
EXR files are linear float; PNG files have exposure, clamping and the sRGB curve. '-' writes a PNG to stdout.
The text of --origin is JSON of schema catoptric/picture/1 in the EXR attribute `comments`, which
OpenImageIO calls ImageDescription. Without --origin, equal pictures are equal files.)";

struct RenderOptions {
    CommonOptions common;
    TechniqueOption drawn;
    std::string technique; ///< technique or plan, checked
    std::string output;
    std::string trace;
    std::string profile;
    std::string camera_path; ///< file; empty: the camera stands still
    bool origin = false;     ///< whether the picture's header says how it was made
};

bool writes_to_stdout(const RenderOptions& options) { return options.output == "-"; }
bool writes_exr(const RenderOptions& options) { return options.output.ends_with(".exr"); }

constexpr int kMaxSequencePictures = 100'000; ///< limit of a sequence

/// Returns whether only a picture is wanted, without times or a certain number of frames.
bool wants_only_picture(const RenderOptions& options) {
    const CommonOptions& common = options.common;
    return !common.animate && !common.frames && !common.warmup && options.trace.empty() &&
           options.profile.empty() && options.camera_path.empty();
}

/// Returns the files that the pictures of so many measured frames are written to; none if the
/// picture goes to stdout.
std::vector<std::string> list_output_files(const RenderOptions& options, int frames) {
    if (writes_to_stdout(options)) return {};
    const std::optional<PictureFileSequence> sequence = PictureFileSequence::parse_file_sequence(
        options.output);
    if (!sequence) return {options.output};
    check(!wants_only_picture(options), Failure::usage, "-o ", options.output,
          ": wanted --frames, --animate or --camera-path with a sequence of pictures, found none");
    check(frames <= kMaxSequencePictures, Failure::usage, "-o ", options.output,
          ": wanted at most ", kMaxSequencePictures, " pictures, found ", frames, " frames");
    std::vector<std::string> files;
    for (int number = 1; number <= frames; ++number) files.push_back(sequence->file(number));
    return files;
}

void check_output_options(const RenderOptions& options) {
    check(!options.common.both_models, Failure::usage,
          "--model both: wanted everything or required, of which a picture has one");
    check_budget_option(options.common);
    check(options.camera_path.empty() || !options.common.overrides.camera, Failure::usage,
          "--camera-path: wanted it without --camera, found both");
    throw_unless_option_given(!options.output.empty(), "render", "-o OUT",
                              "a name ending in .exr or .png, or - for stdout");
    check(!writes_to_stdout(options) || !options.common.manners.json, Failure::usage,
          "-o - and --json: stdout has room for one of them");
    if (!writes_to_stdout(options)) {
        check_file_can_be_made(list_output_files(options, 1).front());
        check(writes_exr(options) || options.output.ends_with(".png"), Failure::usage,
              "-o: wanted a name ending in .exr or .png, or -, found '", options.output, "'");
    }
    check(!options.origin || writes_exr(options), Failure::usage,
          "--origin: wanted -o with a name ending in .exr, found '", options.output, "'");
    for (const std::string& file : {options.trace, options.profile})
        if (!file.empty()) check_file_can_be_made(file);
}

void check_picture_places(const RenderOptions& options, const scene::Scene& scene,
                          const std::vector<std::string>& pictures) {
    std::vector<std::filesystem::path> outputs;
    if (writes_to_stdout(options) || options.common.manners.json) outputs.push_back(kStdoutPath);
    for (const std::string& file : pictures) outputs.emplace_back(file);
    for (const std::string& file : {options.trace, options.profile})
        if (!file.empty()) outputs.push_back(file);
    check_outputs_differ_from_inputs(outputs, scene.files);
    if (!options.camera_path.empty())
        check_outputs_differ_from_inputs(outputs, {resolve_real_path(options.camera_path)},
                                         ", which the camera's path is read from");
}

app::Request make_render_request(const RenderOptions& options) {
    app::Request request = make_render_request_of_options(options.common);
    request.techniques = {options.technique};
    request.model = options.common.model.value_or(app::RenderedWork::required);
    if (!wants_only_picture(options)) return request;
    request.frames += request.warmup; // the same number as `compare` renders
    request.warmup = 0;
    request.until_settled = true;
    return request;
}

/// Returns what pictures of the request are made of, but for the camera and the instant. Empty
/// without --origin.
std::optional<PictureOrigin> make_picture_origin(const RenderOptions& options,
                                                 const app::Request& request,
                                                 const app::DeviceInfo& device) {
    if (!options.origin) return std::nullopt;
    return PictureOrigin{.device = device.name,
                         .driver = device.driver,
                         .scene = request.scene.name,
                         .scene_hash = scene::hash_scene(request.scene),
                         .technique = app::parse_technique(options.technique).label,
                         .model = rendered_work_name(request.model),
                         .seed = request.seed,
                         .exposure = request.exposure};
}

void write_picture(const app::TechniqueResult& part, const std::optional<PictureOrigin>& origin,
                   const std::string& file) {
    if (file.ends_with(".exr"))
        return measure::write_exr(part.hdr, file, origin ? make_picture_origin_json(*origin) : "");
    measure::write_png(part.display, file);
}

/// Reads the camera path. Unless --frames is given, sets the number of frames so that they cover
/// the whole path.
std::optional<CameraPath> read_camera_path_of_request(const RenderOptions& options,
                                                      app::Request& request) {
    if (options.camera_path.empty()) return std::nullopt;
    CameraPath path = read_camera_path(options.camera_path, request.scene);
    // The last frame shows the last key. A tiny amount is subtracted, because the decimal number of
    // seconds may be rounded up.
    const double whole = std::ceil(path.duration() * kFramesPerSecond - 1e-6) + 1;
    check(options.common.frames || whole <= kMaxSequencePictures, Failure::usage, "--camera-path ",
          options.camera_path, ": wanted --frames or a path of at most ", kMaxSequencePictures,
          " frames, found ", whole);
    if (!options.common.frames) request.frames = static_cast<int>(whole);
    path.check_frames(std::min(request.frames, static_cast<int>(std::min(whole, 1e9))),
                      options.camera_path);
    request.camera = path.camera_after(0);
    request.camera.name = options.camera_path;
    return path;
}

/// Renders all frames. In a sequence, each measured frame is written to its file. Sets the camera
/// and the instant of `origin` to those of the last frame.
void render_all_frames(app::FrameLoop& frames, const app::Request& request,
                       const std::optional<CameraPath>& path, const std::vector<std::string>& files,
                       std::optional<PictureOrigin>& origin, const app::Watcher& watcher) {
    const int warmup = request.warmup;
    const auto find_camera = [&] {
        const int next = frames.rendered_frame_count() + 1 -
                         warmup; // number from 1; below 1: warm-up
        return path ? path->camera_after((next - 1) / kFramesPerSecond) : request.camera;
    };
    throw_if_stopped(watcher);
    for (scene::Camera camera = find_camera(); frames.render_next(camera); camera = find_camera()) {
        const int measured = frames.rendered_frame_count() - warmup;
        if (origin) {
            origin->camera = app::make_camera_facts(camera);
            origin->time = request.instant(frames.rendered_frame_count());
        }
        if (files.size() > 1 && measured > 0)
            write_picture(frames.current_frame().read(), origin,
                          files[static_cast<std::size_t>(measured - 1)]);
        report_frame_to_watcher(watcher, frames.rendered_frame_count(), frames.max_frame_count());
    }
}

std::vector<double> list_gpu_times(const app::RunResult& result) {
    std::vector<double> ms;
    for (const app::FrameTimes& frame : result.frames) ms.push_back(frame.gpu_ms);
    return ms;
}

void print_render_summary(const RenderOptions& options, const app::Request& request,
                          const app::RunResult& result) {
    const OutputOptions& manners = options.common.manners;
    const app::TechniqueResult& part = result.parts.front();
    for (const std::string& what : part.notes)
        print_note_unless_quiet(manners, part.label + ": " + what);
    const measure::Mean mean = measure::mean_of(part.hdr, measure::ValueRange::clamped);
    const std::string output = writes_to_stdout(options) ? "stdout" : options.output;
    std::string frames = fmt::format("{} frame{}", result.frames.size(),
                                     result.frames.size() == 1 ? "" : "s");
    if (request.until_settled && !result.settled) frames += " (the next would still differ)";
    if (!request.until_settled) {
        const measure::SampleSummary ms = measure::summarise_samples(list_gpu_times(result));
        frames = fmt::format("{:.4g} ms [{:.4g} - {:.4g}]", ms.median, ms.p05, ms.p95);
    }
    print_note_unless_quiet(manners,
                            fmt::format("{}: {} scene passes, {}, mean {:.5f}, written: {}",
                                        part.label, part.scene_passes, frames, mean.all, output));
    if (part.slices) print_detail_if_verbose(manners, app::describe_capture_budget(*part.slices));
    if (request.until_settled) return;
    for (const app::PassTime& pass : result.frames.back().passes)
        print_detail_if_verbose(manners, fmt::format("  {:<40} {:10.4f} ms", pass.name, pass.ms()));
}

void warn_of_nonfinite(const measure::Picture& picture) {
    const auto broken = std::ranges::count_if(picture.pixels, [](const vec3& pixel) {
        return !std::isfinite(pixel.x) || !std::isfinite(pixel.y) || !std::isfinite(pixel.z);
    });
    if (broken > 0) print_warning(fmt::format("{} pixels are not finite", broken));
}

int run_render(const RenderOptions& options) {
    const OutputOptions& manners = options.common.manners;
    const app::TechniqueChoice choice = app::parse_technique(options.technique);
    check_output_options(options);
    app::Request request = make_render_request(options);
    const std::optional<CameraPath> path = read_camera_path_of_request(options, request);
    const std::vector<std::string> files = list_output_files(options, request.frames);
    check_picture_places(options, request.scene, files);
    if (writes_exr(options)) get_image_codecs(); // fail before rendering if the codecs are missing
    app::Engine engine(make_engine_options(options.common.device));
    print_device_and_warnings(engine, options.common.manners);

    ProgressPrinter progress(manners);
    const app::Watcher watcher = make_progress_watcher(progress);
    report_row_to_watcher(watcher, choice.label, 0, 1);
    std::optional<PictureOrigin> origin = make_picture_origin(options, request, engine.device());
    scene::Scene scene = std::exchange(request.scene, {});
    request.scene.name = scene.name;
    app::Session session(engine, std::move(scene));
    app::resolve_auto_exposure(session, request);
    if (origin) origin->exposure = request.exposure;
    app::FrameLoop frames(session, request);
    render_all_frames(frames, request, path, files, origin, watcher);
    const app::RunResult result = frames.result();
    progress.clear();

    warn_of_nonfinite(result.parts.front().hdr);
    if (files.empty())
        print_picture_bytes(measure::encode_picture_png(result.parts.front().display));
    if (files.size() == 1) write_picture(result.parts.front(), origin, files.front());
    if (!options.trace.empty())
        write_file(options.trace, make_trace_json(result.frames.back(),
                                                  choice.label + " on " + engine.device().name));
    const std::string document = make_render_json(request, engine.device(), result, options.output);
    if (!options.profile.empty()) write_file(options.profile, document);
    if (manners.json) print_result(document);
    print_render_summary(options, request, result);
    if (options.common.device.validate) engine.check_validation();
    return 0;
}

} // namespace

void add_render_verb(CommandLine& program) {
    const auto options = std::make_shared<RenderOptions>();
    CommandVerb& verb = program.add_command_verb("render",
                                                 "render one picture by one technique or plan");
    verb.examples(kRenderExamples);
    add_technique_options(verb, options->drawn);
    verb.option(
        "-o,--output", "OUT",
        "picture file OUT.exr or OUT.png, frame-{n:4}.png for one per frame, or - for a PNG on "
        "stdout; required",
        options->output);
    verb.option("--camera-path", "FILE",
                "file with a motion of the camera, in place of --camera; see the notes below",
                options->camera_path);
    verb.flag("--origin", "write into the header of OUT.exr how it was made, see the notes below",
              options->origin);
    verb.heading(kMeasuringOptions);
    verb.option("--trace", "T.json",
                "file for the times of the last frame's passes, for chrome://tracing or Perfetto",
                options->trace);
    verb.option("--profile", "P.json",
                "file for the times of frames, passes and host, as printed by --json",
                options->profile);
    add_budget_option(verb, options->common);
    add_common_options(verb, options->common);
    verb.set_verb_action([options] {
        options->technique = check_technique_choice(options->drawn, "render");
        return run_render(*options);
    });
}

} // namespace catoptric::cli
