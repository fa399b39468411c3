// Traces what each pixel shows first, and reads how the pixels' reflections were made.
#include "session/first_surface.hpp"

#include "bvh/words.hpp"
#include "reflect/tracer.hpp"
#include "scene/pose.hpp"
#include "session/session_impl.hpp"

#include <cstring>
#include <limits>

namespace catoptric::session {

namespace {

/// Answers of a search, as in shaders/lib/probe.glsl.
constexpr std::uint32_t kSearchHit = 0, kSearchMiss = 2;

/// Returns the texels of an image, or the values of a buffer.
template <typename Texel, typename Handle>
std::vector<Texel> read_output(graph::GraphRunner& runner, graph::FrameTicket ticket,
                               Handle output) {
    const std::vector<std::byte> bytes = runner.read_back(ticket, output);
    std::vector<Texel> texels(bytes.size() / sizeof(Texel));
    std::memcpy(texels.data(), bytes.data(), bytes.size());
    return texels;
}

/// Returns how far the rays of the camera's view start before the camera, in scene units. Those of
/// an orthographic view start where the scene begins (render::make_camera_view).
double camera_ray_start(const render::GpuScene& resident, const scene::Camera& camera) {
    const shared::View& view = resident.list_views()[render::GpuScene::kCameraViewIndex];
    if (view.parallel == 0) return 0;
    return glm::dot(dvec3(view.forward), dvec3(view.eye) + dvec3(view.eye_low) -
                                             resident.scene_units().to_scene(camera.eye));
}

/// Returns the tier of a pixel from the two images of the camera's view.
ReflectionTier classify_pixel(float tracer_mark, const vec4& lookup) {
    if (tracer_mark > 0) return ReflectionTier::traced;
    if (!(lookup.w > 0)) return ReflectionTier::none;
    switch ((static_cast<std::uint32_t>(lookup.w) - 1) % 4) {
    case kSearchHit: return ReflectionTier::capture;
    case kSearchMiss: return ReflectionTier::environment;
    default: return ReflectionTier::unknown;
    }
}

} // namespace

const std::vector<TierInfo>& reflection_tiers() {
    static const std::vector<TierInfo> kTiers{
        {"none", "no mirror, or a mirror without a reflection"},
        {"capture", "found in a capture"},
        {"environment", "looked up in a capture, where the ray leaves the scene"},
        {"unknown", "the search in a capture found no answer"},
        {"traced", "ray traced"},
        {"mirrored", "a mirrored view"}};
    return kTiers;
}

ReflectionTier ReflectionTiers::tier_at(std::size_t pixel, std::uint32_t mirror) const {
    if (mirror == 0) return ReflectionTier::none;
    const ReflectionTier of_whole = of_mirror.at(mirror - 1);
    if (of_whole != ReflectionTier::none || of_pixel.empty()) return of_whole;
    return of_pixel.at(pixel);
}

FirstSurfaces Access::trace_first_surfaces(Session& session, const FrameSpec& spec) {
    Session::Impl& self = *session.impl_;
    self.read_capture_times(); // before this frame takes the place of the timed one
    const scene::Camera camera = scene::camera_at(spec.camera, spec.time);
    const render::FrameFacts facts{.seed = spec.seed,
                                   .now = {spec.time, camera, spec.size, spec.ambient}};
    self.update_scene(facts.now);
    const render::GpuScene& resident = *self.resident;
    graph::Graph graph;
    render::FrameRequests requests(self.resident->next_view());
    const reflect::FirstSurfaceImages images = reflect::add_first_surface(
        graph, {.scene = resident, .requests = requests, .size = spec.size, .facts = facts});
    graph.output(images.normals_and_distances);
    graph.output(images.objects_and_roughness);
    graph.output(images.counters);
    self.resident->fulfil(requests, [&] { self.wait_for_copy(self.copy); });
    const graph::FrameTicket ticket = self.runner.submit_frame(graph, graph::PassTiming::isolated,
                                                               true);
    self.last = ticket;
    self.read_by[self.copy] = ticket.frame;
    ++self.counts.frames;

    const auto counters = read_output<shared::Counters>(self.runner, ticket, images.counters);
    check(counters.front().exhausted == 0, Failure::exhausted,
          "first surfaces: ", counters.front().exhausted,
          " pixels met more triangles and boxes than one invocation may (",
          counters.front().longest_walk, " steps)");
    const auto normals = read_output<vec4>(self.runner, ticket, images.normals_and_distances),
               objects = read_output<vec4>(self.runner, ticket, images.objects_and_roughness);
    const scene::Scene& scene = self.shown_scene();
    const double start = camera_ray_start(resident, camera), scale = resident.scene_units().scale;
    FirstSurfaces surfaces;
    for (std::size_t i = 0; i < normals.size(); ++i) {
        const std::uint32_t object = bvh::unpack_number(objects[i].x);
        const bool is_met = object > 0;
        surfaces.object.push_back(object);
        surfaces.mirror.push_back(is_met ? resident.mirror_of(object - 1) : 0);
        surfaces.distance.push_back(
            is_met ? static_cast<float>((static_cast<double>(normals[i].w) + start) / scale)
                   : std::numeric_limits<float>::infinity());
        surfaces.normal.push_back(vec3(normals[i]));
        const scene::Material* material = is_met
                                              ? &scene.materials[scene.objects[object - 1].material]
                                              : nullptr;
        surfaces.roughness.push_back(
            material && !material->mirror ? material->roughness * objects[i].y : 0.0f);
    }
    return surfaces;
}

ReflectionTiers Access::read_tiers(const Frame& frame, std::size_t part) {
    const Frame::Impl& self = *frame.impl_;
    self.check_is_last();
    const FramePart& declared = self.part(part);
    const reflect::TechniqueOutputs& outputs = declared.outputs;
    const reflect::Assignment& assignment = declared.assignment;
    ReflectionTiers tiers;
    for (const std::uint32_t choice : assignment.of_mirror) {
        const bool is_mirrored = assignment.choices[choice].technique->traits.draws_mirrored_views;
        tiers.of_mirror.push_back(outputs.traces_all_mirrors ? ReflectionTier::traced
                                  : is_mirrored              ? ReflectionTier::mirrored
                                                             : ReflectionTier::none);
    }
    if (outputs.traces_all_mirrors) return tiers;
    check(outputs.lookup.has_value(), Failure::internal, "'", declared.plan.label,
          "': wanted a frame with look-ups, found one without");
    const auto lookups = read_output<vec4>(self.graph_runner(), self.ticket, *outputs.lookup);
    std::vector<float> marks(lookups.size(), 0.0f);
    if (outputs.tracer_marks)
        marks = read_output<float>(self.graph_runner(), self.ticket, *outputs.tracer_marks);
    for (std::size_t i = 0; i < lookups.size(); ++i)
        tiers.of_pixel.push_back(classify_pixel(marks[i], lookups[i]));
    return tiers;
}

} // namespace catoptric::session
