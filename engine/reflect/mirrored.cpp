#include "reflect/mirrored.hpp"

namespace catoptric::reflect {

namespace {

using render::MirroredView;

/// The planes of mirrors that are drawn so.
std::vector<std::optional<render::MirrorPlane>> planes_of(const render::GpuScene& scene,
                                                          const Assignment& assignment) {
    std::vector<std::optional<render::MirrorPlane>> planes;
    for (std::size_t i = 0; i < assignment.of_mirror.size(); ++i) {
        const Choice& choice = assignment.choices[assignment.of_mirror[i]];
        planes.emplace_back();
        if (!choice.technique->mirrored_bounces || !scene.flat_mirrors()[i]) continue;
        planes.back() = {*scene.flat_mirrors()[i],
                         choice.technique->mirrored_bounces(choice.settings)};
    }
    return planes;
}

/// "mirrored/2/1": what mirror 1 shows in mirror 2.
std::string name_of(const std::vector<MirroredView>& views, std::size_t view) {
    const auto& within = views[view].within;
    return (within ? name_of(views, *within) : "mirrored") + "/" +
           std::to_string(views[view].mirror + 1);
}

/// Mirrors with views show what these made, black where nothing did; `made`: of the views that are
/// seen in `within`.
render::Looks shown_in(render::Looks looks,
                       const std::vector<std::optional<render::MirrorPlane>>& planes,
                       const std::vector<MirroredView>& views,
                       const std::vector<graph::Image>& made, std::optional<std::size_t> within) {
    const auto show = [&](std::uint32_t mirror, render::MirrorLook look) {
        looks.of_mirror[mirror] = static_cast<std::uint32_t>(looks.looks.size());
        looks.looks.push_back(std::move(look));
    };
    for (std::uint32_t mirror = 0; mirror < planes.size(); ++mirror)
        if (planes[mirror]) show(mirror, {}); // black
    for (std::size_t i = 0; i < views.size(); ++i)
        if (views[i].within == within)
            show(views[i].mirror, {.fragment = "reflect/planar.frag",
                                   .constants = {},
                                   .captures = {},
                                   .images = {{"mirrored", {made[i]}}},
                                   .buffers = {}});
    return looks;
}

} // namespace

std::vector<std::string> add_mirrored(graph::Graph& graph, const render::FrameInputs& inputs,
                                      const Assignment& assignment,
                                      const render::Lighting& lighting, const render::Looks& others,
                                      render::Looks& looks) {
    const auto planes = planes_of(inputs.scene, assignment);
    int asked = 0;
    for (const auto& plane : planes)
        if (plane) asked = std::max(asked, plane->bounces);
    int most = asked;
    const std::vector<MirroredView> views = render::mirrored_views(inputs.scene.eye(), planes,
                                                                   inputs.size, most);
    std::vector<graph::Image> made(views.size());
    for (std::size_t i = views.size(); i-- > 0;) { // what a view shows comes after it
        const std::uint32_t number = inputs.scene.add_view(views[i].view, views[i].eye);
        made[i] = render::add_mirrored_view(graph, inputs, name_of(views, i), views[i], number,
                                            lighting, shown_in(others, planes, views, made, i));
    }
    looks = shown_in(std::move(looks), planes, views, made, {});
    if (most == asked) return {};
    return {"flat mirrors show " + std::to_string(most) + " mirrors one behind the other, not " +
            std::to_string(asked) + ": a frame has at most " +
            std::to_string(render::kMostMirroredViews) + " views in mirrors"};
}

} // namespace catoptric::reflect
