#include "require/culled_work.hpp"

#include "core/text.hpp"
#include "scene/material_facts.hpp"

#include <algorithm>
#include <bit>
#include <map>

namespace catoptric::require {

namespace {

using ItemNumbers = std::vector<std::size_t>; ///< numbers of mirrors or lights, from 1

/// Returns `one` with its number and name, or the plural with several numbers.
std::string format_items(const std::string& one, const ItemNumbers& numbers,
                         const std::string& name) {
    if (numbers.size() == 1)
        return one + " " + format_ranges(numbers) + (name.empty() ? "" : " " + name);
    return one + "s " + format_ranges(numbers);
}

std::string quote_object_name(const scene::Scene& scene, std::size_t object) {
    return quote(scene.objects[object].name);
}

/// Returns the reason why mirrors are invisible, as text. `seen`: number of visible mirrors.
std::string explain_unseen(const UnseenReason& unseen, std::size_t seen, bool is_one,
                           const scene::Scene& scene) {
    const std::string they = is_one ? "it" : "they", them = is_one ? "it" : "them";
    std::string why;
    switch (unseen.why) {
    case UnseenReason::Cause::empty: return they + (is_one ? " has" : " have") + " no triangle";
    case UnseenReason::Cause::outside:
        why = they + (is_one ? " is" : " are") + " not in the camera's picture";
        break;
    case UnseenReason::Cause::hidden_from_camera:
        why = "the scene hides " + them + " from camera rays";
        break;
    case UnseenReason::Cause::hidden:
        why = quote_object_name(scene, unseen.wall) + " hides " + them + " from the camera";
        break;
    }
    if (seen == 0) return why + ", and no mirror is seen in which " + they + " could show";
    if (seen == 1) return why + ", and walls hide " + them + " from the one mirror that is seen";
    return why + ", and walls hide " + them + " from each of the " + std::to_string(seen) +
           " mirrors that are seen";
}

void add_unseen_mirrors(std::vector<CulledWork>& all, const WorkModel& model,
                        const VisibilityFindings& findings, const scene::Scene& scene,
                        const std::vector<std::size_t>& mirrors) {
    const auto seen = static_cast<std::size_t>(
        std::ranges::count_if(model.mirrors, &MirrorRequirements::is_seen));
    std::map<std::pair<UnseenReason::Cause, std::size_t>, ItemNumbers> alike;
    for (std::size_t i = 0; i < mirrors.size(); ++i)
        if (!model.mirrors[i].is_captured && findings.camera[i])
            alike[{findings.camera[i]->why, findings.camera[i]->wall}].push_back(i + 1);
    for (const auto& [reason, numbers] : alike) {
        const bool is_one = numbers.size() == 1;
        const std::string count = std::to_string(numbers.size());
        all.push_back(
            {.what = (is_one ? "the capture of " : "the captures of ") +
                     format_items("mirror", numbers,
                                  quote_object_name(scene, mirrors[numbers[0] - 1])),
             .why = explain_unseen({reason.first, reason.second}, seen, is_one, scene),
             .saves = is_one ? "the six faces of a capture, each time that it would be drawn again"
                             : "the six faces of each of " + count +
                                   " captures, each time that they would be drawn again"});
    }
}

void add_culled_faces(std::vector<CulledWork>& all, const WorkModel& model,
                      const scene::Scene& scene, const std::vector<std::size_t>& mirrors) {
    std::map<FaceBits, ItemNumbers> alike;
    for (std::size_t i = 0; i < mirrors.size(); ++i)
        if (model.mirrors[i].is_captured && model.mirrors[i].faces != kAllFaces)
            alike[model.mirrors[i].faces].push_back(i + 1);
    for (const auto& [faces, numbers] : alike) {
        const auto without = static_cast<FaceBits>(kAllFaces & ~faces);
        const int count = std::popcount(without);
        const bool is_one = numbers.size() == 1;
        all.push_back({.what = std::string(count == 1 ? "face " : "faces ") + face_names(without) +
                               (is_one ? " of the capture of " : " of the captures of ") +
                               format_items("mirror", numbers,
                                            quote_object_name(scene, mirrors[numbers[0] - 1])),
                       .why = is_one ? "it is flat, all who look at it stand on one side, and what "
                                       "they see in it lies on that side, too"
                                     : "they are flat, all who look at each stand on one side, and "
                                       "what they see in it lies on that side, too",
                       .saves = std::to_string(count) + " of " + (is_one ? "six" : "each six") +
                                " faces, each time that they would be drawn again"});
    }
}

void add_culled_maps(std::vector<CulledWork>& all, const WorkModel& model,
                     const scene::Scene& scene) {
    for (std::size_t i = 0; i < model.lights.size(); ++i)
        if (!model.lights[i].has_map)
            all.push_back({.what = "the shadow map of " +
                                   format_items("light", {i + 1},
                                                quote_light_name(scene, i, model.lights.size())),
                           .why = "nothing that is seen lies within its range and in front of it",
                           .saves = "its map, each time that it would be drawn again"});
}

} // namespace

void set_key(VisibilityFindings& findings, const WorkModel& model) {
    findings.key.clear();
    for (std::size_t i = 0; i < model.mirrors.size(); ++i) {
        const MirrorRequirements& needs = model.mirrors[i];
        std::uint64_t word = needs.faces | (needs.is_captured ? 64u : 0u);
        if (!needs.is_captured && findings.camera[i])
            word |= static_cast<std::uint64_t>(findings.camera[i]->why) << 8 |
                    std::uint64_t{findings.camera[i]->wall} << 16;
        findings.key.push_back(word);
    }
    for (const LightRequirements& needs : model.lights)
        findings.key.push_back(needs.has_map ? 1 : 0);
}

std::string format_ranges(const std::vector<std::size_t>& numbers) {
    std::string text;
    for (std::size_t i = 0; i < numbers.size();) {
        std::size_t last = i;
        while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
        text += (text.empty() ? "" : ", ") + std::to_string(numbers[i]);
        if (last > i) text += "-" + std::to_string(numbers[last]);
        i = last + 1;
    }
    return text;
}

std::vector<CulledWork> find_culled_work(const WorkModel& model, const VisibilityFindings& findings,
                                         const scene::Scene& scene) {
    std::vector<CulledWork> all;
    const std::vector<std::size_t> mirrors = scene::mirrors(scene);
    add_unseen_mirrors(all, model, findings, scene, mirrors);
    add_culled_faces(all, model, scene, mirrors);
    add_culled_maps(all, model, scene);
    return all;
}

std::string quote_light_name(const scene::Scene& scene, std::size_t light, std::size_t count) {
    std::vector<std::string> names;
    for (const scene::Object& object : scene.objects)
        if (scene::emitted_radiance(scene.materials[object.material]) != vec3(0))
            names.push_back(quote(object.name));
    for (const scene::PunctualLight& punctual : scene.punctual)
        names.push_back(quote(punctual.name));
    return names.size() == count ? names[light] : "";
}

std::string face_names(FaceBits faces) {
    constexpr const char* kFaceNames[] = {"+X", "-X", "+Y", "-Y", "+Z", "-Z"};
    std::string text;
    for (std::size_t face = 0; face < 6; ++face)
        if ((faces >> face & 1) != 0)
            text += (text.empty() ? "" : " ") + std::string(kFaceNames[face]);
    return text;
}

} // namespace catoptric::require
