// Writes a model as text for the user.
#include "core/text.hpp"
#include "require/culled_work.hpp"

#include <algorithm>
#include <bit>
#include <sstream>

namespace catoptric::require {

namespace {

std::string format_mirror_numbers(const std::vector<std::uint32_t>& mirrors) {
    std::vector<std::size_t> numbers(mirrors.begin(), mirrors.end());
    for (std::size_t& number : numbers) ++number;
    return format_ranges(numbers);
}

std::string describe_capture_needs(const MirrorRequirements& needs, const scene::Mesh& mesh) {
    if (!needs.is_captured) return "not seen";
    std::string text = needs.seen_in
                           ? "in the view of mirror " + std::to_string(needs.seen_in.number())
                       : !has_few_triangles(mesh) ? "its bounds are in the camera's view"
                                                  : "in the camera's view";
    text += "; captured, ";
    text += needs.faces == kAllFaces ? "six faces" : "faces " + face_names(needs.faces);
    text += needs.sees.empty() ? ", no other mirror in it"
                               : ", mirrors " + format_mirror_numbers(needs.sees) + " in it";
    return text;
}

/// Returns the text about captures and maps that are kept over frames; empty if there are none.
std::string describe_kept_captures(const WorkModel& model) {
    std::size_t faces = 0;
    for (const MirrorRequirements& needs : model.mirrors)
        faces += needs.is_captured ? static_cast<std::size_t>(std::popcount(needs.faces)) : 0;
    const auto maps = static_cast<std::size_t>(
        std::ranges::count_if(model.lights, &LightRequirements::has_map));
    if (model.is_everything || faces + maps == 0) return "";
    std::ostringstream text;
    text
        << "kept: " << faces << (faces == 1 ? " face" : " faces") << " of captures, " << maps
        << (maps == 1 ? " shadow map" : " shadow maps")
        << "\n    why: what they show stays until something in it moves, is lit in another way or "
           "mirrors something else\n    saves: each of them in each frame in which it stays; of a face in which something "
           "moves what lies around it\n"
           "    changes: no pixel; in a mirror that nobody saw before, other such mirrors appear a "
           "bounce a frame\n";
    return text.str();
}

} // namespace

std::string describe_model(const WorkModel& model, const scene::Scene& scene) {
    std::ostringstream text;
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    text << (model.is_everything ? "everything is required\n" : "required\n");
    const auto text_of = [&](std::size_t i) {
        return describe_capture_needs(model.mirrors[i],
                                      scene.meshes[scene.objects[mirrors[i]].mesh]);
    };
    // Consecutive mirrors with the same text share one line.
    for (std::size_t i = 0; i < model.mirrors.size();) {
        const std::string needs = text_of(i);
        std::size_t end = i + 1;
        while (end < model.mirrors.size() && text_of(end) == needs) ++end;
        if (end == i + 1)
            text << "  mirror " << end << " " << quote(scene.objects[mirrors[i]].name);
        else
            text << "  mirrors " << i + 1 << "-" << end;
        text << ": " << needs << "\n";
        i = end;
    }
    for (std::size_t i = 0; i < model.lights.size(); ++i) {
        const std::string name = quote_light_name(scene, i, model.lights.size());
        text << "  light " << i + 1 << (name.empty() ? "" : " " + name) << ": "
             << (model.lights[i].has_map ? "a shadow map" : "no shadow map") << "\n";
    }
    text << describe_kept_captures(model);
    text << (model.left_out.empty() ? "nothing is left out\n" : "left out\n");
    for (const CulledWork& thing : model.left_out)
        text << "  " << thing.what << "\n    why: " << thing.why << "\n    saves: " << thing.saves
             << "\n    changes: no pixel\n";
    return text.str();
}

} // namespace catoptric::require
