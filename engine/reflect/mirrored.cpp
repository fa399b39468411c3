#include "reflect/mirrored.hpp"

#include <algorithm>
#include <iterator>

namespace catoptric::reflect {

namespace {

using render::MirroredView;

/// A flat face that can have mirrored views, with its mirror and its triangles.
struct FlatMirrorFace {
    std::uint32_t mirror = 0;
    std::size_t number = 0; ///< from 1; 0: the face is the whole mirror
    std::vector<scene::TriangleIndexRun> triangles;
};

/// All mirrors that are drawn by mirrored views.
struct FlatMirrorFaceList {
    std::vector<FlatMirrorFace> faces;
    std::vector<std::optional<render::MirrorPlane>> planes; ///< plane of each face
    /// Mirrors with several faces, and their triangles that belong to no flat face.
    std::vector<std::pair<std::uint32_t, std::vector<scene::TriangleIndexRun>>> bodies;
};

FlatMirrorFaceList list_flat_mirror_faces_to_view(const render::GpuScene& scene,
                                                  const TechniqueOfEachMirror& assignment) {
    FlatMirrorFaceList all;
    for (std::uint32_t i = 0; i < assignment.of_mirror.size(); ++i) {
        const TechniqueChoice& choice = assignment.choices[assignment.of_mirror[i]];
        if (!choice.technique->mirrored_bounces) continue;
        const scene::FlatFaces& flats = scene.list_flat_mirror_faces()[i];
        const int bounces = choice.technique->mirrored_bounces(choice.settings);
        if (!flats.is_single_plane()) all.bodies.emplace_back(i, flats.bent);
        for (std::size_t k = 0; k < flats.faces.size(); ++k) {
            const scene::FlatFace& face = flats.faces[k];
            if (face.off > scene.flat_mirror_tolerance()) {
                std::ranges::copy(face.triangles, std::back_inserter(all.bodies.back().second));
                continue;
            }
            all.faces.push_back({i, flats.is_single_plane() ? 0 : k + 1, face.triangles});
            all.planes.push_back(render::MirrorPlane{face, bounces});
        }
    }
    return all;
}

/// Returns the name of a view. "mirrored/2/1" is the view of mirror 1 inside mirror 2.
/// "mirrored/2.3" is the view of face 3 of mirror 2.
std::string mirrored_view_name(const FlatMirrorFaceList& all,
                               const std::vector<MirroredView>& views, std::size_t view) {
    const auto& within = views[view].within;
    const FlatMirrorFace& face = all.faces[views[view].mirror];
    return (within ? mirrored_view_name(all, views, *within) : "mirrored") + "/" +
           std::to_string(face.mirror + 1) +
           (face.number > 0 ? "." + std::to_string(face.number) : "");
}

/// Adds to `looks` how mirrors are drawn inside the view with index `within`, or in the picture if
/// `within` is none. Faces with mirrored views show the images `made`. Faces without views, and
/// triangles outside all flat faces, are black.
render::ShaderOfEachMirror
add_mirror_shaders_of_mirrored_view(render::ShaderOfEachMirror looks, const FlatMirrorFaceList& all,
                                    const std::vector<MirroredView>& views,
                                    const std::vector<graph::ImageHandle>& made,
                                    std::optional<std::size_t> within) {
    const auto black = static_cast<std::uint32_t>(looks.looks.size());
    looks.looks.emplace_back();
    std::vector<std::uint32_t> of_face(all.faces.size(), black);
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].within != within) continue;
        of_face[views[i].mirror] = static_cast<std::uint32_t>(looks.looks.size());
        looks.looks.push_back({.fragment = "reflect/planar.frag",
                               .constants = {},
                               .captures = {},
                               .images = {{"mirrored", {made[i]}}},
                               .buffers = {}});
    }
    for (const auto& [mirror, bent] : all.bodies) {
        looks.of_mirror[mirror] = render::ShaderOfEachMirror::kShaderChosenByPart;
        if (!bent.empty()) looks.parts.push_back({mirror, black, bent});
    }
    for (std::size_t i = 0; i < all.faces.size(); ++i) {
        const FlatMirrorFace& face = all.faces[i];
        const bool is_looked_through = within && views[*within].mirror == i;
        if (face.number == 0)
            looks.of_mirror[face.mirror] = of_face[i];
        else if (!is_looked_through)
            looks.parts.push_back({face.mirror, of_face[i], face.triangles});
    }
    return looks;
}

} // namespace

std::vector<std::string> add_mirrored_views(graph::Graph& graph, const render::FrameInputs& inputs,
                                            const TechniqueOfEachMirror& assignment,
                                            const render::ShadingLights& lighting,
                                            const render::ShaderOfEachMirror& others,
                                            render::ShaderOfEachMirror& looks) {
    const FlatMirrorFaceList all = list_flat_mirror_faces_to_view(inputs.scene, assignment);
    int asked = 0;
    for (const auto& plane : all.planes) asked = std::max(asked, plane->bounces);
    int most = asked;
    const std::vector<MirroredView> views = render::find_mirrored_views(
        inputs.scene.eye(), all.planes, inputs.size, most);
    std::vector<graph::ImageHandle> made(views.size());
    for (std::size_t i = views.size();
         i-- > 0;) { // inner views have larger indices and must be made first
        const std::uint32_t number = inputs.scene.add_view(views[i].view);
        const FlatMirrorFace& face = all.faces[views[i].mirror];
        const std::optional<std::uint32_t> whole = face.number == 0 ? std::optional(face.mirror)
                                                                    : std::nullopt;
        made[i] = render::add_mirrored_view(
            graph, inputs, mirrored_view_name(all, views, i), views[i], number, lighting,
            add_mirror_shaders_of_mirrored_view(others, all, views, made, i), whole);
    }
    looks = add_mirror_shaders_of_mirrored_view(std::move(looks), all, views, made, {});
    if (most == asked) return {};
    return {"flat mirrors show " + std::to_string(most) + " mirrors one behind the other, not " +
            std::to_string(asked) + ": a frame has at most " +
            std::to_string(render::kMaxMirroredViews) + " views in mirrors"};
}

} // namespace catoptric::reflect
