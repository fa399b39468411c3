#include "prototypes.hpp"

#include "capture_prototype.hpp"
#include "trace_prototype.hpp"

#include <map>

namespace peers {

using namespace catoptric;

namespace {

using Tree = TracePrototype::PrototypeTreeKind;
constexpr std::pair<const char*, Tree> kTracers[] = {{"prototype/stack", Tree::stack},
                                                     {"prototype/links", Tree::skip_links}};
constexpr int kCaptureFaceEdges[] = {64, 256, 512};

} // namespace

struct PrototypeFrames::Impl {
    gpu::GpuDevice device{{}};
    gpu::PipelineStore pipelines{device};
    std::map<std::string, std::unique_ptr<TracePrototype>> tracers;
    std::map<std::string, std::unique_ptr<CapturePrototype>> captures;
};

PrototypeFrames::PrototypeFrames(const app::Request& request, const EmbreePeerScene& mesh)
    : prototype_impl_(std::make_unique<Impl>()) {
    const std::vector<bvh::Triangle> triangles = list_scene_triangles(request.scene);
    for (const auto& [name, tree] : kTracers)
        prototype_impl_->tracers[name] = std::make_unique<TracePrototype>(
            prototype_impl_->device, prototype_impl_->pipelines, mesh, triangles, tree);
    for (const int face : kCaptureFaceEdges)
        prototype_impl_->captures[prototype_name_of_edge(face)] =
            std::make_unique<CapturePrototype>(prototype_impl_->device, prototype_impl_->pipelines,
                                               request, static_cast<std::uint32_t>(face));
}

PrototypeFrames::~PrototypeFrames() = default;

std::vector<std::string> PrototypeFrames::tracers() {
    std::vector<std::string> names;
    for (const auto& [name, tree] : kTracers) names.emplace_back(name);
    return names;
}

std::vector<app::BenchmarkSubject> PrototypeFrames::subjects(int warmup) {
    std::vector<app::BenchmarkSubject> subjects;
    for (const auto& [name, tracer] : prototype_impl_->tracers)
        subjects.push_back(app::make_benchmark_subject(
            name, [&one = *tracer] { one.trace_prototype_picture(); }, warmup));
    for (const auto& [name, capture] : prototype_impl_->captures)
        subjects.push_back(app::make_benchmark_subject(
            name, [&one = *capture] { one.draw(); }, warmup));
    return subjects;
}

std::vector<PeerVector> PrototypeFrames::read(const std::string& name) {
    const auto tracer = prototype_impl_->tracers.find(name);
    return tracer != prototype_impl_->tracers.end() ? tracer->second->read()
                                                    : prototype_impl_->captures.at(name)->read();
}

} // namespace peers
