#pragma once

#include "scene/gltf_container.hpp"
#include "scene/json.hpp"
#include "scene/notes.hpp"

/// What stands in front of tinygltf: it is given a document of which every member has its kind,
/// every index its object and every accessor its bytes, and in which nothing else is left.
namespace catoptric::scene::gltf {

inline constexpr std::string_view kEmissiveStrength = "KHR_materials_emissive_strength";

/// gltf_members.cpp: throws `bad_data` for a member of the wrong kind, an index of nothing, or
/// lists over the budget; names what is not read. Says nothing of members that it does not know.
void check_members(const Item& root, Account& account, Notes& notes);
/// The members that are read, of a document that has been checked.
Json what_is_read(Json document);

/// gltf_bounds.cpp: throws `bad_data` unless each view lies in its buffer and each accessor in its
/// view, those that nobody asks for too.
void check_bounds(const Item& root, const std::vector<Buffer>& buffers);

/// gltf_unread.cpp: checks what depends on more than one member, and names the rest of what is not
/// read. Images lie where a scene's files may.
void check_uses(const Item& root, Files& files, Notes& notes);

} // namespace catoptric::scene::gltf
