// Mirrored views for flat mirrors: a view for each visible mirror whose technique has
// Technique::mirrored_views, and views within these views.
#include "reflect/captures.hpp"
#include "reflect/feature.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace catoptric::reflect {

namespace {

using render::MirroredView;

/// A flat face that can have mirrored views, with its mirror and its triangles.
struct MirrorFace {
    std::uint32_t mirror = 0;
    std::size_t number = 0; ///< from 1; 0: the face is the whole mirror
    std::vector<scene::TriangleRun> triangles;
    /// How the mirror shows its view; MirroredViewOptions::rough is none for a sharp mirror.
    MirroredViewOptions options;

    bool is_blurred() const { return options.rough != RoughKnobs::Lookup::none; }
};

/// All mirrors that are drawn by mirrored views.
struct MirrorFaces {
    std::vector<MirrorFace> faces;
    std::vector<std::optional<render::MirrorPlane>> planes; ///< plane of each face
    /// Mirrors with several faces, and their triangles that belong to no flat face.
    std::vector<std::pair<std::uint32_t, std::vector<scene::TriangleRun>>> bodies;
};

/// Returns the angle, radians, around the mirrored direction that holds most of the light of a
/// rough mirror's lobe.
double find_blur_angle(const render::GpuScene& scene, std::uint32_t mirror) {
    const render::DrawRange& range = scene.draw_ranges()[scene.mirror_object(mirror)];
    // Nine tenths of the normals of a GGX lobe have a slope of up to three times its width (Walter
    // et al. 2007, equation 35). A mirrored direction turns by twice the normal's angle.
    constexpr double kSlopeOfMostNormals = 3;
    return range.lobe_alpha > 0 ? 2 * std::atan(kSlopeOfMostNormals * double{range.lobe_alpha})
                                : std::numbers::pi;
}

MirrorFaces collect_faces(const render::GpuScene& scene, const Assignment& assignment) {
    MirrorFaces all;
    for (std::uint32_t i = 0; i < assignment.of_mirror.size(); ++i) {
        const TechniqueChoice& choice = assignment.choices[assignment.of_mirror[i]];
        if (!choice.technique->traits.draws_mirrored_views) continue;
        const scene::FlatFaces& flats = scene.flat_faces()[i];
        MirroredViewOptions options = choice.technique->mirrored_views(choice.settings);
        if (!scene.is_rough_mirror(i)) options.rough = RoughKnobs::Lookup::none;
        const double blur_angle = options.rough == RoughKnobs::Lookup::none
                                      ? 0
                                      : find_blur_angle(scene, i);
        if (!flats.is_plane()) all.bodies.emplace_back(i, flats.bent);
        for (std::size_t k = 0; k < flats.faces.size(); ++k) {
            const scene::FlatFace& face = flats.faces[k];
            if (face.off > scene.flat_tolerance()) {
                std::ranges::copy(face.triangles, std::back_inserter(all.bodies.back().second));
                continue;
            }
            all.faces.push_back({i, flats.is_plane() ? 0 : k + 1, face.triangles, options});
            all.planes.push_back(render::MirrorPlane{face, options.bounces, blur_angle});
        }
    }
    return all;
}

/// Returns the name of a view. "mirrored/2/1" is the view of mirror 1 inside mirror 2.
/// "mirrored/2.3" is the view of face 3 of mirror 2.
std::string view_name(const MirrorFaces& all, const std::vector<MirroredView>& views,
                      std::size_t view) {
    const auto& within = views[view].within;
    const MirrorFace& face = all.faces[views[view].plane_index];
    return (within ? view_name(all, views, *within) : "mirrored") + "/" +
           std::to_string(face.mirror + 1) +
           (face.number > 0 ? "." + std::to_string(face.number) : "");
}

/// Returns the shader of a mirror that shows a view. `is_within`: the mirror is drawn into a
/// mirrored view, which may store the distances of what the mirror shows.
render::MirrorShader make_planar_shader(const MirrorFace& face, const MirroredView& view,
                                        const render::MirroredViewImages& made, uvec2 size,
                                        bool is_within) {
    render::MirrorShader look{.fragment = "reflect/planar.frag",
                              .constants = {},
                              .captures = {},
                              .images = {{"mirrored", {made.colour}}},
                              .buffers = {}};
    if (made.distances) {
        look.images.emplace_back("mirrored_distances", std::vector{*made.distances});
        if (is_within) look.constants.emplace_back("passes_distances", 1u);
    }
    if (!face.is_blurred()) return look;
    const dvec2 low(view.area.x, view.area.y), extent(view.area.width, view.area.height);
    look.shown = vec4(low / dvec2(size), (low + extent) / dvec2(size));
    look.images.emplace_back("mirrored_colours", std::vector{made.colour});
    look.images.emplace_back("mirrored_levels", std::vector{*made.levels});
    look.constants.emplace_back("rough", static_cast<std::uint32_t>(face.options.rough));
    look.constants.emplace_back("distance_law", static_cast<std::uint32_t>(face.options.law));
    if (face.options.rough == RoughKnobs::Lookup::prefilter)
        look.constants.emplace_back("taps", face.options.taps);
    return look;
}

/// Adds to `looks` how mirrors are drawn inside the view with index `within`, or in the picture if
/// `within` is none. Faces with mirrored views show the images `made`. Faces without views, and
/// triangles outside all flat faces, are black.
render::MirrorShaders add_view_looks(render::MirrorShaders looks, const MirrorFaces& all,
                                     const std::vector<MirroredView>& views,
                                     const std::vector<render::MirroredViewImages>& made,
                                     uvec2 size, std::optional<std::size_t> within) {
    const auto black = static_cast<std::uint32_t>(looks.looks.size());
    looks.looks.emplace_back();
    std::vector<std::uint32_t> of_face(all.faces.size(), black);
    for (std::size_t i = 0; i < views.size(); ++i) {
        if (views[i].within != within) continue;
        of_face[views[i].plane_index] = static_cast<std::uint32_t>(looks.looks.size());
        looks.looks.push_back(make_planar_shader(all.faces[views[i].plane_index], views[i], made[i],
                                                 size, within.has_value()));
    }
    for (const auto& [mirror, bent] : all.bodies) {
        looks.of_mirror[mirror] = render::MirrorShaders::kByPart;
        if (!bent.empty()) looks.parts.push_back({mirror, black, bent});
    }
    for (std::size_t i = 0; i < all.faces.size(); ++i) {
        const MirrorFace& face = all.faces[i];
        const bool is_looked_through = within && views[*within].plane_index == i;
        if (face.number == 0)
            looks.of_mirror[face.mirror] = of_face[i];
        else if (!is_looked_through)
            looks.parts.push_back({face.mirror, of_face[i], face.triangles});
    }
    return looks;
}

bool has_mirrored_views(const TechniqueChoice& choice) {
    return choice.technique->traits.draws_mirrored_views;
}

/// Returns how all other mirrors inside mirrored views are drawn: as in the picture, but without
/// ray tracing. Mirrors that are only ray traced in the picture are drawn from their captures, if
/// they have any.
render::MirrorShaders choose_mirrored_looks(const FrameDeclaration& frame) {
    render::MirrorShaders looks = frame.looks;
    for (std::size_t i = 0; i < looks.looks.size(); ++i) {
        const TechniqueChoice& choice = frame.choices()[i];
        render::MirrorShader& look = looks.looks[i];
        std::erase_if(look.constants,
                      [](const auto& constant) { return constant.first == "tracer"; });
        remove_view_images(look);
        if (has_mirrored_views(choice)) look = {};
        if (!choice.technique->traits.is_ray_traced()) continue;
        look = {};
        if (choice.shared.others.is_black || !frame.outputs.captures) continue;
        look.fragment = "reflect/parallax.frag";
        look.constants.emplace_back("refract_model", other_view_refraction(choice.shared.refract));
        look.captures = frame.outputs.captures;
    }
    return looks;
}

/// Returns the images that each view has besides its colour.
std::vector<render::MirroredViewWishes> choose_view_images(const MirrorFaces& all,
                                                           const std::vector<MirroredView>& views) {
    std::vector<render::MirroredViewWishes> wanted;
    for (const MirroredView& view : views) {
        const MirrorFace& face = all.faces[view.plane_index];
        // The distance of a mirror's surface is not that of what the mirror shows, so a view inside
        // a view with distances has distances, too.
        wanted.push_back({(face.is_blurred() && face.options.law != RoughKnobs::Law::none) ||
                              (view.within && wanted[*view.within].has_distances),
                          face.is_blurred()});
    }
    return wanted;
}

void add_mirrored_views(FrameDeclaration& frame) {
    const render::FrameInputs& inputs = frame.inputs;
    const render::MirrorShaders others = choose_mirrored_looks(frame);
    const MirrorFaces all = collect_faces(inputs.scene, frame.assignment);
    int asked = 0;
    for (const auto& plane : all.planes) asked = std::max(asked, plane->bounces);
    int most = asked;
    const std::vector<MirroredView> views = render::find_mirrored_views(
        inputs.scene.eye(), all.planes, inputs.size, most);
    const std::vector<render::MirroredViewWishes> wanted = choose_view_images(all, views);
    std::vector<render::MirroredViewImages> made(views.size());
    for (std::size_t i = views.size();
         i-- > 0;) { // inner views have larger indices and must be made first
        const std::uint32_t number = inputs.requests.add_view(views[i].view);
        const MirrorFace& face = all.faces[views[i].plane_index];
        const std::optional<std::uint32_t> whole = face.number == 0 ? std::optional(face.mirror)
                                                                    : std::nullopt;
        made[i] = render::add_mirrored_view(
            frame.graph, inputs, view_name(all, views, i), views[i], number, frame.lighting,
            add_view_looks(others, all, views, made, inputs.size, i), whole, wanted[i]);
    }
    frame.looks = add_view_looks(std::move(frame.looks), all, views, made, inputs.size, {});
    if (most < asked)
        frame.outputs.notes.push_back(
            "flat mirrors show " + std::to_string(most) + " mirrors one behind the other, not " +
            std::to_string(asked) + ": a frame has at most " +
            std::to_string(render::kMaxMirroredViews) + " views in mirrors");
}

constexpr FrameFeature kMirroredViewFeature{
    .name = "mirrored views",
    .order = feature_order::kMirroredViews,
    .applies =
        [](const FrameDeclaration& frame) {
            return is_rasterised(frame) && !frame.assignment.of_mirror.empty() &&
                   std::ranges::any_of(frame.choices(), has_mirrored_views);
        },
    .add = add_mirrored_views};
const RegisteredFeature kMirroredViewRegistration{kMirroredViewFeature};

} // namespace

} // namespace catoptric::reflect
