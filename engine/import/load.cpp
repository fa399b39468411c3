#include "import/load.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "import/file_options.hpp"
#include "scene/built_in.hpp"
#include "scene/classify.hpp"

#include <algorithm>
#include <cctype>

namespace catoptric::scene {

namespace {

std::string lower_case_extension(const std::filesystem::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return extension;
}

Scene with_mirrors(Scene scene) {
    find_mirrors(scene);
    scene.meshes.shrink_to_fit(), scene.objects.shrink_to_fit(); // no more are added
    return scene;
}

/// Throws if the options choose an animation of a scene that has none.
void check_no_animation(const std::string& scene, const FileOptions& options) {
    check(options.animation.empty() || options.animation == "none", options.animation_by.failure,
          options.animation_by.where, ": ", scene, " has no animation ", quote(options.animation),
          ": wanted none");
}

[[noreturn]] void fail_unknown_scene(const std::string& word) {
    std::vector<std::string> names;
    std::string list;
    for (const BuiltInScene& scene : built_in_scenes()) {
        names.push_back(scene.name);
        list += (list.empty() ? "" : ", ") + scene.name;
    }
    const std::string extension = lower_case_extension(word), nearest = suggest_name(word, names);
    fail(Failure::usage, "scene ", quote(word), ": wanted a built-in scene (", list,
         ") or a .glb, .gltf or .obj file", nearest,
         nearest.empty() && !extension.empty()
             ? ", found " + quote(extension) +
                   "; export the scene as .glb (glTF 2.0) from the program that wrote it, or in "
                   "Blender by File > Import and File > Export"
             : "");
}

} // namespace

void check_exists(const std::string& name_or_path) {
    for (const BuiltInScene& scene : built_in_scenes())
        if (scene.name == name_or_path) return;
    const std::string extension = lower_case_extension(name_or_path);
    if (extension != ".glb" && extension != ".gltf" && extension != ".obj")
        fail_unknown_scene(name_or_path);
    std::error_code error;
    const bool exists = std::filesystem::exists(name_or_path, error);
    check(exists || error, Failure::missing_input, name_or_path,
          ": cannot be opened: No such file or directory");
}

Scene load(const std::string& name_or_path, const LoadOptions& options) {
    return load_file(name_or_path, {.root = options.root, .animation = options.animation});
}

Scene load_file(const std::string& name_or_path, const FileOptions& options) {
    for (const BuiltInScene& scene : built_in_scenes())
        if (scene.name == name_or_path) {
            check_no_animation(name_or_path, options);
            return with_mirrors(scene.make());
        }
    const std::string extension = lower_case_extension(name_or_path);
    if (extension == ".glb" || extension == ".gltf")
        return with_mirrors(load_gltf(name_or_path, options));
    if (extension == ".obj") {
        check_no_animation(name_or_path, options);
        return with_mirrors(load_obj(name_or_path, options));
    }
    fail_unknown_scene(name_or_path);
}

} // namespace catoptric::scene
