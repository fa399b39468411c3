// catoptric render: renders one picture, or a sequence.
#include "aov.hpp"
#include "camera_path.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "file_sequence.hpp"
#include "film.hpp"
#include "json.hpp"
#include "measure/picture.hpp"
#include "measure/picture_file.hpp"
#include "measure/statistics.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "progress.hpp"
#include "scene/hash.hpp"
#include "session/access.hpp"
#include "session/capture_budget.hpp"
#include "session/exposure.hpp"
#include "session/frames.hpp"
#include "session/run.hpp"
#include "session/scene_info.hpp"
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

constexpr const char* kDefaultTechnique = "auto";
constexpr const char* kRenderExamples = R"(Examples:
  catoptric render scene.glb -o picture.png
  catoptric render --technique parallax -o parallax.png
  catoptric render scene.glb --technique raytrace:samples=16 -o truth.exr
  catoptric render --technique reuse --frames 60 --trace frame.json -o last.png
  catoptric render --technique reuse --animate --frames 60 -o 'frame-{n:3}.png'
  catoptric render --technique secant --camera-path path.json -o 'p-{n:4}.png'
  catoptric render --technique secant --camera-path path.json -o film.mp4
  catoptric render --technique secant --aov distance,normal -o layers.exr
  catoptric render --technique naive:bounces=2 -o - | display
  catoptric render --plan "1=hybrid 2,3=secant:face=64 *=reuse" -o mixed.png

A still picture takes one frame, or with last frame's captures as many frames as change a pixel, at most 28.
With --budget-ms it takes at most 28 rounds of all mirrors; the picture does not depend on the budget.
The camera of --camera-path moves from the first measured frame on, 1/60 s a frame, to the end of the path or
for --frames. The file is {"keys": [{"time": 0, "camera": "0,1,4:0,1,0:45"}, {"time": 2, "camera": "..."}]},
or the views.json of 'catoptric views': then frame n shows the n-th view of the file, at its time.
With --animate, --camera-path, --frames, --warmup, --profile or --trace, frames are counted and timed as in compare.
The picture is then that of the last frame. With {n}, {n:3}, %d or %03d in its name, one picture per measured
frame is written, numbered from 1. A name that ends in .mp4 is a film of 60 measured frames a second, as
displayed. ffmpeg encodes it. --frames A..B are the frames A to B of a longer sequence, with the same numbers. The
frames before A are left out, except the --warmup frames, which fill the captures.

Layers of --aov, of what the ray through a pixel's centre meets first:
)";
constexpr const char* kPictureFileNotes =
    R"(
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
    std::string camera_path;      ///< file; empty: the camera stands still
    bool origin = false;          ///< whether the picture's header says how it was made
    std::vector<PictureAov> aovs; ///< layers beside the colours
};

bool writes_to_stdout(const RenderOptions& options) { return options.output == "-"; }
bool writes_exr(const RenderOptions& options) { return options.output.ends_with(".exr"); }
bool writes_film(const RenderOptions& options) { return is_film_name(options.output); }
bool writes_aov(const RenderOptions& options, PictureAov aov) {
    return std::ranges::find(options.aovs, aov) != options.aovs.end();
}

constexpr int kMaxSequencePictures = 100'000;

/// Returns whether only a picture is wanted, without times or a certain number of frames.
bool wants_only_picture(const RenderOptions& options) {
    const CommonOptions& common = options.common;
    return !common.animate && !common.frames && !common.warmup && options.trace.empty() &&
           options.profile.empty() && options.camera_path.empty();
}

/// Returns the files that the pictures of so many measured frames are written to; none if the
/// picture goes to stdout.
std::vector<std::string> output_files(const RenderOptions& options, int frames) {
    if (writes_to_stdout(options)) return {};
    const std::optional<FileSequence> sequence = FileSequence::parse(options.output);
    if (writes_film(options)) {
        check(!sequence, Failure::usage, "-o ", options.output,
              ": wanted a film's name without a place for the frame's number, found one");
        check(!wants_only_picture(options), Failure::usage, "-o ", options.output,
              ": wanted --frames, --animate or --camera-path with a film, found none");
        return {options.output};
    }
    if (!sequence) return {options.output};
    check(!wants_only_picture(options), Failure::usage, "-o ", options.output,
          ": wanted --frames, --animate or --camera-path with a sequence of pictures, found none");
    check(frames <= kMaxSequencePictures, Failure::usage, "-o ", options.output,
          ": wanted at most ", kMaxSequencePictures, " pictures, found ", frames, " frames");
    std::vector<std::string> files;
    for (int number = 0; number < frames; ++number)
        files.push_back(sequence->file(options.common.first_frame + number));
    return files;
}

void check_output_options(const RenderOptions& options) {
    check(!options.common.both_models, Failure::usage,
          "--model both: wanted everything or required, of which a picture has one");
    check_budget_option(options.common);
    check(options.camera_path.empty() || !options.common.overrides.camera, Failure::usage,
          "--camera-path: wanted it without --camera, found both");
    require_option(!options.output.empty(), "render", "-o OUT",
                   "a name ending in .exr, .png or .mp4, or - for stdout");
    check(!writes_to_stdout(options) || !options.common.output_options.json, Failure::usage,
          "-o - and --json: stdout has room for one of them");
    if (!writes_to_stdout(options)) {
        check_output_file(output_files(options, 1).front());
        check(writes_exr(options) || writes_film(options) || options.output.ends_with(".png"),
              Failure::usage, "-o: wanted a name ending in .exr, .png or .mp4, or -, found '",
              options.output, "'");
    }
    check(options.aovs.empty() || writes_exr(options), Failure::usage,
          "--aov: wanted -o with a name ending in .exr, which holds layers, found '",
          options.output, "'");
    check(!options.origin || writes_exr(options), Failure::usage,
          "--origin: wanted -o with a name ending in .exr, found '", options.output, "'");
    if (writes_film(options)) check_film(options.output, options.common.size);
    for (const std::string& file : {options.trace, options.profile})
        if (!file.empty()) check_output_file(file);
}

void check_picture_places(const RenderOptions& options, const scene::Scene& scene,
                          const std::vector<std::string>& pictures) {
    std::vector<std::filesystem::path> outputs;
    if (writes_to_stdout(options) || options.common.output_options.json)
        outputs.push_back(kStdoutPath);
    for (const std::string& file : pictures) outputs.emplace_back(file);
    for (const std::string& file : {options.trace, options.profile})
        if (!file.empty()) outputs.push_back(file);
    check_distinct(outputs, scene.files);
    if (!options.camera_path.empty())
        check_distinct(outputs, {real_path(options.camera_path)},
                       ", which the camera's path is read from");
}

session::Request make_render_request(const RenderOptions& options) {
    session::Request request = make_request(options.common);
    request.techniques = {options.technique};
    request.model = options.common.model.value_or(session::RenderedWork::required);
    request.with_lookup = writes_aov(options, PictureAov::tier);
    if (!wants_only_picture(options)) return request;
    request.frames += request.warmup; // the same number as `compare` renders
    request.warmup = 0;
    request.until_settled = true;
    return request;
}

/// Returns what pictures of the request are made of, but for the camera and the instant. Empty
/// without --origin.
std::optional<PictureOrigin> picture_origin(const RenderOptions& options,
                                            const session::Request& request,
                                            const session::DeviceInfo& device) {
    if (!options.origin) return std::nullopt;
    return PictureOrigin{.device = device.name,
                         .driver = device.driver,
                         .scene = request.scene.name,
                         .scene_hash = scene::hash_scene(request.scene),
                         .technique = session::parse_technique(options.technique).label,
                         .model = work_name(request.model),
                         .seed = request.seed,
                         .exposure = request.exposure};
}

/// Reads the cameras of the frames. Unless --frames is given, sets the number of frames so that
/// they cover the whole file.
std::optional<FrameCameras> read_cameras(const RenderOptions& options, session::Request& request) {
    if (options.camera_path.empty()) return std::nullopt;
    FrameCameras cameras = read_frame_cameras(options.camera_path, request.scene);
    for (const auto& [given, option] : {std::pair(options.common.animate, "--animate"),
                                        std::pair(options.common.time.has_value(), "--time")})
        check(!cameras.has_instants() || !given, Failure::usage, option,
              ": wanted it without views in --camera-path, which have an instant each, found both");
    const double whole = cameras.frame_count();
    check(options.common.frames || whole <= kMaxSequencePictures, Failure::usage, "--camera-path ",
          options.camera_path, ": wanted --frames or a path of at most ", kMaxSequencePictures,
          " frames, found ", whole);
    if (!options.common.frames) request.frames = static_cast<int>(whole);
    cameras.check_frames(options.common.first_frame - 1 + request.frames, options.camera_path);
    request.camera = cameras.camera_of(1);
    request.camera.name = options.camera_path;
    if (cameras.has_instants()) request.time = cameras.instant_of(1);
    return cameras;
}

/// Writes the pictures of a run: one, one for each measured frame, or a film.
class RunOutput {
public:
    /// `files`: as output_files returns them. `origin`: what the pictures are made of, but for
    /// the camera and the instant. All arguments but the last must outlive this object.
    RunOutput(const RenderOptions& options, const std::vector<std::string>& files,
              session::Session& session, const session::Watcher& watcher,
              std::optional<PictureOrigin> origin)
        : options_(options), files_(files), session_(session), origin_(std::move(origin)) {
        if (writes_film(options))
            film_.emplace(options.output, options.common.size, kFramesPerSecond, watcher);
    }

    /// Returns whether each measured frame is written.
    bool writes_each_frame() const { return film_ || files_.size() > 1; }
    /// Writes a measured frame, with its number from 0. `spec`: of the frame. `part`: its result.
    /// The frame cannot be read afterwards.
    void write_frame(std::size_t number, const session::Frame& frame,
                     const session::FrameSpec& spec, const session::TechniqueResult& part) {
        if (files_.empty()) return print_bytes(measure::encode_png(part.display));
        if (film_) return film_->add_frame(part.display);
        const std::string& file = files_.at(std::min(number, files_.size() - 1));
        if (!writes_exr(options_)) return measure::write_png(part.display, file);
        write_file(file, encode_exr(frame, spec, part));
    }
    /// Puts the film in place, if there is one.
    void finish() {
        if (film_) film_->finish();
    }

private:
    std::string encode_exr(const session::Frame& frame, const session::FrameSpec& spec,
                           const session::TechniqueResult& part) {
        std::string text;
        if (origin_) {
            origin_->camera = session::make_camera_facts(spec.camera, spec.time);
            origin_->time = spec.time;
            text = origin_json(*origin_);
        }
        if (options_.aovs.empty()) return measure::encode_exr(part.hdr, text);
        std::optional<session::ReflectionTiers> tiers;
        if (writes_aov(options_, PictureAov::tier)) tiers = session::Access::read_tiers(frame);
        const session::FirstSurfaces surfaces = session::Access::trace_first_surfaces(session_,
                                                                                      spec);
        return measure::encode_exr(part.hdr, aov_channels(options_.aovs, surfaces, tiers), text);
    }

    const RenderOptions& options_;
    const std::vector<std::string>& files_;
    session::Session& session_;
    std::optional<PictureOrigin> origin_;
    std::optional<FilmWriter> film_;
};

/// Renders all frames and writes them. Returns the results.
session::RunResult render_frames(session::Session& session, const session::Request& request,
                                 int first_frame, const std::optional<FrameCameras>& cameras,
                                 RunOutput& output, const session::Watcher& watcher) {
    session::FrameLoop frames(session, request);
    session::FrameSpec shown = request;
    int number = first_frame - request.warmup; // below first_frame: warm-up
    const auto find_instant = [&] {
        return cameras && cameras->has_instants() ? cameras->instant_of(number)
                                                  : request.instant(request.warmup + number);
    };
    throw_if_stopped(watcher);
    for (;; ++number) {
        session::FrameSpec next = shown;
        next.camera = cameras ? cameras->camera_of(number) : request.camera;
        next.time = find_instant();
        if (!frames.render_next(next.camera, next.time)) break;
        shown = std::move(next);
        const int measured = frames.frame_number() - request.warmup;
        // The last frame is written after its result was read.
        if (output.writes_each_frame() && measured > 0 && measured < request.frames)
            output.write_frame(static_cast<std::size_t>(measured - 1), frames.frame(), shown,
                               frames.frame().read());
        report_frame(watcher, frames.frame_number(), frames.max_frames());
    }
    session::RunResult result = frames.result();
    output.write_frame(static_cast<std::size_t>(request.frames - 1), frames.frame(), shown,
                       result.parts.front());
    output.finish();
    return result;
}

std::vector<double> gpu_times(const session::RunResult& result) {
    std::vector<double> ms;
    for (const session::FrameTimes& frame : result.frames) ms.push_back(frame.gpu_ms);
    return ms;
}

void print_summary(const RenderOptions& options, const session::Request& request,
                   const session::RunResult& result) {
    const OutputOptions& output_options = options.common.output_options;
    const session::TechniqueResult& part = result.parts.front();
    for (const std::string& what : part.notes) print_note(output_options, part.label + ": " + what);
    const measure::Mean mean = measure::mean_of(part.hdr, measure::ValueRange::clamped);
    const std::string output = writes_to_stdout(options) ? "stdout" : options.output;
    std::string frames = fmt::format("{} frame{}", result.frames.size(),
                                     result.frames.size() == 1 ? "" : "s");
    if (request.until_settled && !result.settled) frames += " (the next would still differ)";
    if (!request.until_settled) {
        const measure::SampleSummary ms = measure::summarise(gpu_times(result));
        frames = fmt::format("{:.4g} ms [{:.4g} - {:.4g}]", ms.median, ms.p05, ms.p95);
    }
    print_note(output_options,
               fmt::format("{}: {} scene passes, {}, mean {:.5f}, written: {}", part.label,
                           part.scene_passes, frames, mean.all, output));
    if (part.capture_budget)
        print_detail(output_options, session::describe_budget(*part.capture_budget));
    if (request.until_settled) return;
    for (const session::PassTime& pass : result.frames.back().passes)
        print_detail(output_options, fmt::format("  {:<40} {:10.4f} ms", pass.name, pass.ms()));
}

void warn_of_nonfinite(const measure::Picture& picture) {
    const auto broken = std::ranges::count_if(picture.pixels, [](const vec3& pixel) {
        return !std::isfinite(pixel.x) || !std::isfinite(pixel.y) || !std::isfinite(pixel.z);
    });
    if (broken > 0) print_warning(fmt::format("{} pixels are not finite", broken));
}

int run_render(const RenderOptions& options) {
    const OutputOptions& output_options = options.common.output_options;
    const session::ParsedTechnique choice = session::parse_technique(options.technique);
    check_output_options(options);
    ProgressPrinter progress(output_options, ProgressPrinter::OffTerminal::nothing,
                             "reading the scene, opening the device");
    session::Request request = make_render_request(options);
    const std::optional<FrameCameras> cameras = read_cameras(options, request);
    const std::vector<std::string> files = output_files(options, request.frames);
    check_picture_places(options, request.scene, files);
    session::Engine engine(engine_options(options.common.device));
    progress.clear();
    print_device(engine, options.common.output_options);

    const session::Watcher watcher = make_watcher(progress);
    const session::WatchedWork watched(watcher);
    report_row(watcher, choice.label, 0, 1);
    std::optional<PictureOrigin> origin = picture_origin(options, request, engine.device());
    scene::Scene scene = std::exchange(request.scene, {});
    request.scene.name = scene.name;
    session::Session session(engine, std::move(scene));
    session::resolve_exposure(session, request);
    if (origin) origin->exposure = request.exposure;
    RunOutput output(options, files, session, watcher, std::move(origin));
    const session::RunResult result = render_frames(session, request, options.common.first_frame,
                                                    cameras, output, watcher);
    progress.clear();

    warn_of_nonfinite(result.parts.front().hdr);
    if (!options.trace.empty())
        write_file(options.trace,
                   trace_json(result.frames.back(), choice.label + " on " + engine.device().name));
    const std::string document = render_json(request, options.common.first_frame, engine.device(),
                                             result, options.output);
    if (!options.profile.empty()) write_file(options.profile, document);
    if (output_options.json) print_result(document);
    print_summary(options, request, result);
    if (options.common.device.validate) engine.check_validation();
    return 0;
}

} // namespace

void add_render_verb(CommandLine& program) {
    const auto options = std::make_shared<RenderOptions>();
    Verb& verb = program.add_verb("render", "render one picture by one technique or plan");
    verb.examples(kRenderExamples + describe_aovs() + kPictureFileNotes);
    add_technique_options(verb, options->drawn, kDefaultTechnique);
    verb.option(
        "-o,--output", "OUT",
        "picture file OUT.exr or OUT.png, frame-{n:4}.png for one per frame, a film OUT.mp4, or - "
        "for a PNG on stdout; required",
        options->output);
    verb.option("--camera-path", "FILE",
                "file with a motion of the camera, in place of --camera; see --help-all",
                options->camera_path);
    verb.option("--aov", "LIST",
                "layers to add to OUT.exr, separated by commas: distance, normal, object, mirror, "
                "tier, roughness, or all; see --help-all",
                [options](const std::string& text) { options->aovs = parse_aovs(text); });
    verb.flag("--origin", "write into the header of OUT.exr how it was made, see --help-all",
              options->origin);
    verb.heading(kMeasuringOptions);
    verb.option("--trace", "T.json",
                "file for the times of the last frame's passes, for chrome://tracing or Perfetto",
                options->trace);
    verb.option("--profile", "P.json",
                "file for the times of frames, passes and host, as printed by --json",
                options->profile);
    options->common.takes_frame_range = true;
    add_budget_option(verb, options->common);
    add_common_options(verb, options->common);
    verb.action([options] {
        scene::check_exists(options->common.scene);
        TechniqueOption drawn = options->drawn;
        if (drawn.technique.empty() && drawn.plan.empty()) drawn.technique = kDefaultTechnique;
        options->technique = check_choice(drawn, "render");
        return run_render(*options);
    });
}

} // namespace catoptric::cli
