#pragma once

#include "../core/export.hpp"
#include "budget.hpp"
#include "said_by.hpp"
#include "scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace catoptric::scene {

/// Scene that needs no file. The .cpp file that builds the scene also registers it; nothing else
/// lists it.
struct BuiltIn {
    std::string name;
    std::string summary; ///< one line for `list`
    Scene (*make)();     ///< builds the scene; Scene::name equals `name`
    int order = 1000;    ///< place in lists; equal orders are sorted by name
};
/// Registration of a built-in scene. A variable of this type at namespace scope adds the scene to
/// the table while the program starts.
struct RegisteredScene {
    CATOPTRIC_API explicit RegisteredScene(BuiltIn scene);
};
/// Returns every built-in scene, sorted by `order`, then by name.
CATOPTRIC_API const std::vector<BuiltIn>& built_in_scenes();

struct LoadOptions {
    /// Second folder below which the files named by a scene may lie. The first is the real folder
    /// of the scene. Empty: no second folder.
    std::filesystem::path root;
    /// Name of the animation that moves the nodes of a glTF file, or "none". Empty: the first
    /// animation.
    std::string animation;
    SaidBy animation_by{.where = "--animation"};
    Budget budget;
};

/// Loads a built-in scene by name, or a .glb, .gltf or .obj file, and finds its mirrors
/// (scene/classify.hpp). Throws `Failure::usage`, with the nearest built-in name, for a word that
/// is neither. Throws `missing_input` for a file that does not exist. Throws `bad_data`, naming
/// file and place, for content that cannot be read, exceeds the budget, or lies outside the allowed
/// folders. The scene's warnings list what was left out or repaired, with a count for each kind.
CATOPTRIC_API Scene load(const std::string& name_or_path, const LoadOptions& options = {});

/// Builds the Cornell box with four mirror balls (contract: "The built-in scene").
CATOPTRIC_API Scene cornell_mirrors();
/// Builds the same box with a white front wall that camera rays ignore.
CATOPTRIC_API Scene cornell_mirrors_closed();
/// Builds a closed room with one flat mirror.
CATOPTRIC_API Scene flat();
/// Builds a furnished room: textures, shared meshes, a wall mirror, a smooth floor, two lamps, a
/// spot.
CATOPTRIC_API Scene furnished_room();
/// Builds a hall with sixteen mirrors through which the camera walks.
CATOPTRIC_API Scene gallery();
/// Builds an open court under a sky, with a hollow dish.
CATOPTRIC_API Scene courtyard();

/// Reads a glTF or an OBJ file. Throws as `load`.
CATOPTRIC_API Scene load_gltf(const std::filesystem::path& path, const LoadOptions& options = {});
CATOPTRIC_API Scene load_obj(const std::filesystem::path& path, const LoadOptions& options = {});

/// Writes a scene as .glb, or as .obj with an .mtl file beside it.
/// In .glb, a mirror is metallic 1, roughness 0. A light uses KHR_materials_emissive_strength, and
/// motion is a CUBICSPLINE translation. The camera is written, too. Our own marks are in
/// gltf_model.hpp.
/// In .obj, a mirror is illum 3 with Ks, and a light is Ke. Camera, motion and exact spheres are
/// comments that begin with `# catoptric` (obj_text.hpp).
/// The same scene gives the same bytes. Throws `cannot_create` or `io`. An existing file is
/// replaced only by a complete one.
CATOPTRIC_API void save_glb(const Scene& scene, const std::filesystem::path& path);
CATOPTRIC_API void save_obj(const Scene& scene, const std::filesystem::path& path);

} // namespace catoptric::scene
