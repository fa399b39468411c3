#pragma once

#include "import/gltf_container.hpp"
#include "import/json.hpp"
#include "scene/material.hpp"
#include "scene/material_facts.hpp"
#include "scene/notes.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

/// Checks a glTF document before tinygltf parses it. In the document that tinygltf gets, every
/// member has the right type and every index names an existing object. Every accessor lies within
/// its bytes, and members that we do not read are removed.
namespace catoptric::scene::gltf {

inline constexpr std::string_view kEmissiveStrengthExtension = "KHR_materials_emissive_strength";
/// Returns whether the material extension holds factors that are read.
inline bool is_factor_extension(std::string_view name) {
    return std::ranges::find(kMaterialFactors, name, &MaterialFactor::extension) !=
           std::end(kMaterialFactors);
}

/// Checks the type of every known member. Unknown members are ignored. Throws `bad_data` for a
/// member of the wrong type, an index of no object, or lists over the budget. Defined in
/// gltf_members.cpp.
void check_known_members(const JsonObject& root, LoadAccount& account);
/// Returns the members that are read, taken from a checked document. Members that tinygltf needs
/// and the document lacks are added with placeholder values.
Json keep_known_members(Json document);

/// Throws `bad_data` unless each view lies in its buffer and each accessor in its view. Unused
/// views and accessors are checked, too. Defined in gltf_accessor.cpp.
void check_view_bounds(const JsonObject& root, const std::vector<GltfBuffer>& buffers);

/// Checks rules that involve more than one member, and notes extensions and animation channels that
/// are not read. Throws `bad_data`, also for an image file outside the folders that `files` allows.
/// Defined in gltf_unread.cpp.
void check_cross_references(const JsonObject& root, FileOpener& files, LoaderNotes& notes);

} // namespace catoptric::scene::gltf
