#pragma once

#include "../core/export.hpp"
#include "budget.hpp"
#include "said_by.hpp"
#include "scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace catoptric::scene {

/// A scene that needs no file. It is one row in the .cpp that makes it, which registers itself;
/// nothing else lists it.
struct BuiltIn {
    std::string name;
    std::string summary; ///< one line for `list`
    Scene (*make)();     ///< its name is `name`
    int order = 1000;    ///< place in lists; then by name
};
/// A namespace-scope RegisteredScene puts its row into the table while the program starts.
struct RegisteredScene {
    CATOPTRIC_API explicit RegisteredScene(BuiltIn scene);
};
/// Every built-in scene by `order`, then name.
CATOPTRIC_API const std::vector<BuiltIn>& built_in_scenes();

struct LoadOptions {
    /// The files that a scene names lie below the real folder of the scene, or below this one;
    /// empty: no other.
    std::filesystem::path root;
    /// Which animation of a glTF file moves its nodes: by name, or "none"; empty: the first.
    std::string animation;
    SaidBy animation_by{.where = "--animation"};
    Budget budget;
};

/// A built-in scene by name, or a .glb, .gltf or .obj file, its mirrors found (scene/classify.hpp).
/// Throws `Failure::usage` for a word that is neither (with the nearest built-in name),
/// `missing_input` for a file that is not there, `bad_data` naming file and place for what cannot
/// be read, asks for more than the budget or lies elsewhere than it may. What is left out or
/// repaired is in the scene's warnings, with a count for each kind.
CATOPTRIC_API Scene load(const std::string& name_or_path, const LoadOptions& options = {});

/// Cornell box with four mirror balls (contract: "The built-in scene").
CATOPTRIC_API Scene cornell_mirrors();
/// The same with a white front wall that camera rays ignore.
CATOPTRIC_API Scene cornell_mirrors_closed();
/// A closed room with one flat mirror.
CATOPTRIC_API Scene flat();
/// A furnished room: textures, shared meshes, a wall mirror, a smooth floor, two lamps, a spot.
CATOPTRIC_API Scene furnished_room();
/// A hall with sixteen mirrors through which the camera walks.
CATOPTRIC_API Scene gallery();
/// An open court under a sky, with a hollow dish.
CATOPTRIC_API Scene courtyard();

/// Each reads one file; errors as `load`.
CATOPTRIC_API Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options = {});
CATOPTRIC_API Scene load_obj(const std::filesystem::path& path, const LoadOptions& options = {});

/// Writes .glb (mirror = metallic 1, roughness 0; light = KHR_materials_emissive_strength; motion
/// as a CUBICSPLINE translation; the camera; marks in gltf_model.hpp) or .obj with .mtl beside
/// it (mirror = illum 3, Ks; light = Ke; camera, motion and exact spheres as `# catoptric ...`
/// comment lines, obj_text.hpp). Same scene, same bytes.
/// Throws `cannot_create` or `io`; an existing file is replaced only by a complete one.
CATOPTRIC_API void save_glb(const Scene& scene, const std::filesystem::path& path);
CATOPTRIC_API void save_obj(const Scene& scene, const std::filesystem::path& path);

} // namespace catoptric::scene
