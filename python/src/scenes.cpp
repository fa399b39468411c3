// Scenes and cameras.
#include "binding.hpp"

#include <catoptric/error.hpp>

#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <tuple>

namespace catoptric::python {

namespace {

using Triple = std::array<double, 3>;

dvec3 to_vector(const Triple& triple) { return {triple[0], triple[1], triple[2]}; }
std::tuple<double, double, double> to_tuple(const dvec3& vector) {
    return {vector.x, vector.y, vector.z};
}

scene::Camera make_camera(const Triple& eye, const Triple& target, const Triple& up,
                          double vertical_fov_degrees, double orthographic_height) {
    return {.eye = to_vector(eye),
            .target = to_vector(target),
            .up = to_vector(up),
            .vertical_fov_degrees = vertical_fov_degrees,
            .orthographic_height = orthographic_height};
}

std::string describe_triple(const dvec3& vector) {
    const nb::object tuple = nb::cast(to_tuple(vector));
    return nb::repr(tuple).c_str();
}

void bind_camera(nb::module_& module) {
    nb::class_<scene::Camera>(module, "Camera",
                              "A camera that looks from `eye` to `target`, in world units.")
        .def(
            "__init__",
            [](scene::Camera* self, const Triple& eye, const Triple& target, const Triple& up,
               double vertical_fov_degrees, double orthographic_height) {
                new (self) scene::Camera(
                    make_camera(eye, target, up, vertical_fov_degrees, orthographic_height));
            },
            nb::arg("eye"), nb::arg("target"), nb::kw_only(), nb::arg("up") = Triple{0, 1, 0},
            nb::arg("vertical_fov_degrees") = 45.0, nb::arg("orthographic_height") = 0.0,
            "Makes a camera.\n\n"
            "Args:\n"
            "    eye: The position of the camera, world units.\n"
            "    target: A point in the middle of the picture, world units.\n"
            "    up: The direction that points upwards in the picture.\n"
            "    vertical_fov_degrees: The vertical field of view, degrees.\n"
            "    orthographic_height: The height of the picture, world units. 0: the camera is a\n"
            "        perspective camera.")
        .def_ro("name", &scene::Camera::name, "The name in the scene file, or an empty text.")
        .def_prop_ro("eye", [](const scene::Camera& camera) { return to_tuple(camera.eye); })
        .def_prop_ro("target", [](const scene::Camera& camera) { return to_tuple(camera.target); })
        .def_prop_ro("up", [](const scene::Camera& camera) { return to_tuple(camera.up); })
        .def_ro("vertical_fov_degrees", &scene::Camera::vertical_fov_degrees)
        .def_ro("orthographic_height", &scene::Camera::orthographic_height,
                "The height of the picture, world units. 0: a perspective camera.")
        .def("__repr__", [](const scene::Camera& camera) {
            return "Camera(eye=" + describe_triple(camera.eye) +
                   ", target=" + describe_triple(camera.target) + ")";
        });
}

std::vector<std::string> mirror_names(const scene::Scene& scene) {
    std::vector<std::string> names;
    for (const std::size_t index : scene::mirrors(scene))
        names.push_back(scene.objects[index].name);
    return names;
}

std::vector<std::tuple<std::string, std::uint64_t, std::string>>
unsupported_features(const scene::Scene& scene) {
    std::vector<std::tuple<std::string, std::uint64_t, std::string>> features;
    for (const scene::UnsupportedFeature& feature : scene.unsupported)
        features.emplace_back(feature.id, feature.count, feature.first);
    return features;
}

scene::Scene load_scene(const std::filesystem::path& name_or_path,
                        const std::optional<std::filesystem::path>& root,
                        const std::string& animation) {
    const nb::gil_scoped_release released;
    return scene::load(name_or_path.string(),
                       {.root = root.value_or(std::filesystem::path()), .animation = animation});
}

} // namespace

SceneDefaults choose_defaults(const scene::Scene& scene, const std::optional<scene::Camera>& camera,
                              std::optional<double> ambient, std::optional<double> exposure) {
    if (!camera && scene.cameras.empty())
        throw UsageError("scene '" + scene.name +
                         "' has no camera: wanted the argument 'camera', found None");
    const bool is_file = !scene.files.empty();
    return {.camera = camera ? *camera : scene.cameras.front(),
            .ambient = ambient.value_or(scene.environment ? 0 : .05),
            .exposure = exposure.value_or(scene.exposure.value_or(0)),
            .auto_exposure = is_file && !exposure && !scene.exposure};
}

void bind_scenes(nb::module_& module) {
    bind_camera(module);
    nb::class_<scene::Scene>(module, "Scene", "A scene. `load` makes it.")
        .def_ro("name", &scene::Scene::name)
        .def_prop_ro(
            "cameras", [](const scene::Scene& scene) { return scene.cameras; },
            "The scene's cameras. The first one is the default of frames and comparisons.")
        .def_prop_ro("mirrors", &mirror_names,
                     "The names of the mirrors. Mirror n, counted from 1, is entry n-1.")
        .def_prop_ro("triangles", &scene::triangle_count, "The number of triangles.")
        .def_ro("exposure", &scene::Scene::exposure, "Stops, if the file gives them, else None.")
        .def_prop_ro("unsupported", &unsupported_features,
                     "What the file has and Catoptric does not draw: identifier, count, and place "
                     "of the first.")
        .def_prop_ro(
            "warnings", [](const scene::Scene& scene) { return scene.warnings; },
            "Sentences on what was left out or repaired when the file was read.")
        .def("__repr__", [](const scene::Scene& scene) { return "Scene('" + scene.name + "')"; });
    module.def("load", &load_scene, nb::arg("name_or_path"), nb::kw_only(),
               nb::arg("root") = nb::none(), nb::arg("animation") = "",
               "Loads a built-in scene by name, or a .glb, .gltf or .obj file.\n\n"
               "Args:\n"
               "    name_or_path: Such as 'cornell-mirrors', or the path of a file.\n"
               "    root: A second folder below which files named by the scene may lie.\n"
               "    animation: The animation that moves the nodes of a glTF file. 'none': nothing\n"
               "        moves. Empty: the first animation.\n\n"
               "Returns:\n"
               "    The scene, with its mirrors found. Lengths have the unit of the file.\n\n"
               "Raises:\n"
               "    UsageError: The name is neither a built-in scene nor a file name.\n"
               "    MissingInput: The file does not exist.\n"
               "    BadData: The file cannot be read.");
}

} // namespace catoptric::python
