// The picture: traced as a whole, or drawn by the rasteriser and completed by rays; then composed.
#include "reflect/captures.hpp"
#include "reflect/feature.hpp"

#include <algorithm>

namespace catoptric::reflect {

namespace {

constexpr FrameFeature kTracedPictureFeature{
    .name = "traced picture",
    .order = feature_order::kTracedPicture,
    .applies =
        [](const FrameDeclaration& frame) {
            return !frame.is_mixed() && !frame.completes_view &&
                   frame.choices().front().technique->traits.draws_whole_picture;
        },
    .add =
        [](FrameDeclaration& frame) {
            const TechniqueChoice& choice = frame.choices().front();
            frame.outputs = choice.technique->picture(frame.graph, frame.inputs, choice.settings,
                                                      frame.lighting);
            frame.outputs.traces_all_mirrors = true;
            frame.is_traced_whole = true;
        }};
const RegisteredFeature kTracedPictureRegistration{kTracedPictureFeature};

void add_rasterised_view(FrameDeclaration& frame) {
    std::optional<render::GlassOverPicture> glass;
    if (frame.opaque) {
        glass = {*frame.opaque, frame.looks};
        std::ranges::for_each(glass->opaque_looks.looks, remove_view_images);
    }
    const bool completes = frame.completes_view;
    frame.view = render::add_camera_view(
        frame.graph, frame.inputs, frame.view_lighting, std::move(frame.looks),
        !frame.tracers.empty(),
        completes ? render::ShadingTracer{1, frame.tracers.front().rays > 0}
                  : render::ShadingTracer{},
        std::move(glass));
    frame.outputs.hdr = frame.view->hdr;
    frame.outputs.traces_all_mirrors = completes;
    if (!frame.inputs.with_lookup) return;
    frame.outputs.lookup = frame.view->lookup;
    if (!frame.tracers.empty() && !completes) frame.outputs.tracer_marks = frame.view->tracers;
}

constexpr FrameFeature kCameraViewFeature{.name = "camera's view",
                                          .order = feature_order::kCameraView,
                                          .applies = is_rasterised,
                                          .add = add_rasterised_view};
const RegisteredFeature kCameraViewRegistration{kCameraViewFeature};

constexpr FrameFeature kTracerFeature{
    .name = "tracers",
    .order = feature_order::kTracers,
    .applies = [](const FrameDeclaration& frame) { return !frame.tracers.empty(); },
    .add =
        [](FrameDeclaration& frame) {
            for (std::uint32_t i = 0; i < frame.tracers.size(); ++i)
                frame.outputs.counters.push_back(add_list_tracing(
                    frame.graph, frame.inputs, frame.tracers[i], i + 1, *frame.view));
        }};
const RegisteredFeature kTracerRegistration{kTracerFeature};

constexpr FrameFeature kComposeFeature{.name = "compose",
                                       .order = feature_order::kCompose,
                                       .applies = [](const FrameDeclaration&) { return true; },
                                       .add =
                                           [](FrameDeclaration& frame) {
                                               frame.outputs.display = render::add_compose_pass(
                                                   frame.graph, frame.inputs, frame.outputs.hdr,
                                                   frame.inputs.exposure);
                                           }};
const RegisteredFeature kComposeRegistration{kComposeFeature};

} // namespace

} // namespace catoptric::reflect
