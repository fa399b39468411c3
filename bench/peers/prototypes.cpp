#include "prototypes.hpp"

#include "capture_prototype.hpp"
#include "trace_prototype.hpp"

#include <map>

namespace peers {

using namespace catoptric;

namespace {

using Tree = RayTracingPrototype::PrototypeBvhKind;
constexpr std::pair<const char*, Tree> kPrototypeTracers[] = {
    {"prototype/stack", Tree::stack}, {"prototype/links", Tree::skip_links}};
constexpr int kCaptureFaceEdges[] = {64, 256, 512};

} // namespace

struct PrototypeFrameRenderer::Impl {
    gpu::Device device{{}};
    gpu::PipelineStore pipelines{device};
    std::map<std::string, std::unique_ptr<RayTracingPrototype>> tracers;
    std::map<std::string, std::unique_ptr<CubeCapturePrototypeRenderer>> captures;
};

PrototypeFrameRenderer::PrototypeFrameRenderer(const session::Request& request,
                                               const EmbreeWhittedTracer& mesh)
    : prototype_impl_(std::make_unique<Impl>()) {
    const std::vector<bvh::Triangle> triangles = make_bvh_triangles_of_scene(request.scene);
    for (const auto& [name, tree] : kPrototypeTracers)
        prototype_impl_->tracers[name] = std::make_unique<RayTracingPrototype>(
            prototype_impl_->device, prototype_impl_->pipelines, mesh, triangles, tree);
    for (const int face : kCaptureFaceEdges)
        prototype_impl_->captures[prototype_benchmark_name(face)] =
            std::make_unique<CubeCapturePrototypeRenderer>(prototype_impl_->device,
                                                           prototype_impl_->pipelines, request,
                                                           static_cast<std::uint32_t>(face));
}

PrototypeFrameRenderer::~PrototypeFrameRenderer() = default;

std::vector<std::string> PrototypeFrameRenderer::tracers() {
    std::vector<std::string> names;
    for (const auto& [name, tree] : kPrototypeTracers) names.emplace_back(name);
    return names;
}

std::vector<benchmark::Subject> PrototypeFrameRenderer::subjects(int warmup) {
    std::vector<benchmark::Subject> subjects;
    for (const auto& [name, tracer] : prototype_impl_->tracers)
        subjects.push_back(benchmark::make_subject(
            name, [&one = *tracer] { one.trace_picture_with_prototype(); }, warmup));
    for (const auto& [name, capture] : prototype_impl_->captures)
        subjects.push_back(benchmark::make_subject(
            name, [&one = *capture] { one.draw(); }, warmup));
    return subjects;
}

std::vector<PeerVector3> PrototypeFrameRenderer::read(const std::string& name) {
    const auto tracer = prototype_impl_->tracers.find(name);
    return tracer != prototype_impl_->tracers.end() ? tracer->second->read()
                                                    : prototype_impl_->captures.at(name)->read();
}

} // namespace peers
