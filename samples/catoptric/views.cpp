// catoptric views: writes the views of a comparison for another renderer.
#include "study/views.hpp"
#include "core/error.hpp"
#include "core/file.hpp"
#include "options.hpp"
#include "output_checks.hpp"
#include "parse.hpp"
#include "report/json.hpp"
#include "report/writer.hpp"
#include "session/engine.hpp"
#include "session/scene_info.hpp"
#include "study/picture_rows.hpp"
#include "study/study.hpp"
#include "verbs.hpp"

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include <cmath>
#include <memory>
#include <numbers>

namespace catoptric::cli {

namespace {

using report::Json;

constexpr const char* kViewsExamples = R"(Examples:
  catoptric views room.glb --count 30 --size 512x512 -o views
  catoptric compare room.glb --views 30 --size 512x512 --row mine=views -o out

The folder gets views.json, views.gltf (a camera for each view) and views.txt (one line a view). view-000 is the
camera of the comparison, and the others are drawn from --seed as by compare --views. Render each view with your own
renderer into the same folder, as view-000.exr (linear light), .hdr or .png (as displayed), and compare them.)";

struct ViewsOptions {
    CommonOptions common;
    std::string folder;
    int count = 1;
};

/// Returns view 0, which is the comparison's own camera, and the drawn views.
std::vector<measure::View> list_views(const session::Request& request, int count) {
    std::vector<measure::View> views{
        {session::make_camera_facts(request.camera, request.time), request.time, request.seed}};
    for (measure::View& view : study::draw_views(request, count)) views.push_back(view);
    return views;
}

Json views_document(const session::Request& request, const std::vector<measure::View>& views) {
    Json document{{"schema", "catoptric/views/1"},
                  {"version", session::version()},
                  {"commit", session::commit()}};
    document["scene"] = request.scene.name;
    document["width"] = request.size.x, document["height"] = request.size.y;
    document["exposure"] = request.auto_exposure ? Json("auto")
                                                 : report::number_json(request.exposure);
    document["seed"] = request.seed;
    document["views"] = Json::array();
    for (std::size_t i = 0; i < views.size(); ++i)
        document["views"].push_back({{"name", study::view_picture_name(i)},
                                     {"time", report::number_json(views[i].time)},
                                     {"camera", report::camera_json(views[i].camera)}});
    return document;
}

Json number_list(std::initializer_list<double> numbers) { return Json(numbers); }

/// Returns the camera of glTF 2.0 (section 5.12).
Json gltf_camera(const measure::CameraFacts& camera, const std::string& name, uvec2 size) {
    const double ratio = static_cast<double>(size.x) / size.y;
    const double near = 1e-4 * std::max(glm::distance(camera.eye, camera.target), 1e-3);
    if (camera.orthographic_height > 0)
        return {{"name", name},
                {"type", "orthographic"},
                {"orthographic",
                 {{"xmag", camera.orthographic_height * ratio / 2},
                  {"ymag", camera.orthographic_height / 2},
                  {"znear", near},
                  {"zfar", 1e7 * near}}}};
    return {{"name", name},
            {"type", "perspective"},
            {"perspective",
             {{"yfov", camera.vertical_fov_degrees * std::numbers::pi / 180},
              {"aspectRatio", ratio},
              {"znear", near}}}};
}

/// Returns a node that places camera `index`, which looks along its own -z with y up.
Json camera_node(const measure::View& view, std::size_t index) {
    const measure::CameraFacts& camera = view.camera;
    const dvec3 back = glm::normalize(camera.eye - camera.target),
                right = glm::normalize(glm::cross(camera.up, back));
    const glm::dquat turn = glm::quat_cast(glm::dmat3(right, glm::cross(back, right), back));
    return {{"name", study::view_picture_name(index)},
            {"camera", index},
            {"translation", number_list({camera.eye.x, camera.eye.y, camera.eye.z})},
            {"rotation", number_list({turn.x, turn.y, turn.z, turn.w})},
            {"extras", {{"time", view.time}}}};
}

Json views_gltf(const std::vector<measure::View>& views, uvec2 size) {
    Json document{{"asset", {{"version", "2.0"}, {"generator", "catoptric views"}}}, {"scene", 0}};
    Json nodes = Json::array(), cameras = Json::array(), roots = Json::array();
    for (std::size_t i = 0; i < views.size(); ++i) {
        cameras.push_back(gltf_camera(views[i].camera, study::view_picture_name(i), size));
        nodes.push_back(camera_node(views[i], i));
        roots.push_back(i);
    }
    document["scenes"] = {{{"nodes", roots}}};
    document["nodes"] = nodes, document["cameras"] = cameras;
    return document;
}

/// Returns the table of views as text: a header and one line for each view, with tabs between the
/// columns.
std::string views_text(const std::vector<measure::View>& views) {
    std::string text = "name\ttime\teye_x\teye_y\teye_z\ttarget_x\ttarget_y\ttarget_z\tup_x\tup_y\t"
                       "up_z\tvertical_fov_degrees\torthographic_height\n";
    for (std::size_t i = 0; i < views.size(); ++i) {
        const measure::CameraFacts& camera = views[i].camera;
        text += fmt::format("{}\t{}", study::view_picture_name(i), views[i].time);
        for (const dvec3& point : {camera.eye, camera.target, camera.up})
            text += fmt::format("\t{}\t{}\t{}", point.x, point.y, point.z);
        text += fmt::format("\t{}\t{}\n", camera.vertical_fov_degrees, camera.orthographic_height);
    }
    return text;
}

int run_views(const ViewsOptions& options) {
    scene::check_exists(options.common.scene);
    require_option(!options.folder.empty(), "views", "-o DIR", "the folder for the views");
    const session::Request request = make_request(options.common);
    const std::vector<measure::View> views = list_views(request, options.count);
    const std::filesystem::path folder = options.folder;
    std::vector<std::filesystem::path> files;
    for (const char* name : {"views.json", "views.gltf", "views.txt"})
        files.push_back(folder / name);
    check_distinct(files, request.scene.files);
    report::create_folder(folder);
    const std::string document = report::serialise(views_document(request, views));
    write_file(files[2], views_text(views));
    write_file(files[1], report::serialise(views_gltf(views, request.size)));
    write_file(files[0], document);
    if (options.common.output_options.json) print_result(document);
    print_note(options.common.output_options,
               fmt::format("written: {}; render {} pictures of {}x{} there", options.folder,
                           views.size(), request.size.x, request.size.y));
    return 0;
}

} // namespace

void add_views_verb(CommandLine& program) {
    const auto options = std::make_shared<ViewsOptions>();
    Verb& verb = program.add_verb(
        "views", "write the views of a comparison, to render them with another renderer");
    verb.examples(kViewsExamples);
    verb.argument("SCENE", "built-in scene or .glb, .gltf or .obj file (cornell-mirrors)",
                  options->common.scene, Verb::Need::optional);
    verb.option("-o,--output", "DIR", "folder for the views, created if missing; required",
                options->folder);
    const study::Study& study = study::find_study("views");
    verb.option("--count", "N",
                "number of drawn views, as of compare --views: 1 (none) or at least 6 (1)",
                [options, &study](const std::string& text) {
                    options->count = static_cast<int>(
                        parse_integer("--count", text, study.low, study.high));
                    study.check_count("--count", options->count);
                });
    add_view_options(verb, options->common);
    add_override_options(verb, options->common);
    add_output_options(verb, options->common.output_options);
    verb.action([options] { return run_views(*options); });
}

} // namespace catoptric::cli
