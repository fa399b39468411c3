#include "prototypes.hpp"

#include "capture_prototype.hpp"
#include "trace_prototype.hpp"

#include <map>

namespace peers {

using namespace catoptric;

namespace {

using Tree = TracePrototype::Tree;
constexpr std::pair<const char*, Tree> kTracers[] = {{"prototype/stack", Tree::stack},
                                                     {"prototype/links", Tree::skip_links}};
constexpr int kFaces[] = {64, 256, 512};

} // namespace

struct Prototypes::Impl {
    gpu::Device device{{}};
    gpu::Pipelines pipelines{device};
    std::map<std::string, std::unique_ptr<TracePrototype>> tracers;
    std::map<std::string, std::unique_ptr<CapturePrototype>> captures;
};

Prototypes::Prototypes(const app::Request& request, const PeerScene& mesh)
    : impl_(std::make_unique<Impl>()) {
    const std::vector<bvh::Triangle> triangles = triangles_of(request.scene);
    for (const auto& [name, tree] : kTracers)
        impl_->tracers[name] = std::make_unique<TracePrototype>(impl_->device, impl_->pipelines,
                                                                mesh, triangles, tree);
    for (const int face : kFaces)
        impl_->captures[name_of(face)] = std::make_unique<CapturePrototype>(
            impl_->device, impl_->pipelines, request, static_cast<std::uint32_t>(face));
}

Prototypes::~Prototypes() = default;

std::vector<std::string> Prototypes::tracers() {
    std::vector<std::string> names;
    for (const auto& [name, tree] : kTracers) names.emplace_back(name);
    return names;
}

std::vector<app::BenchmarkSubject> Prototypes::subjects(int warmup) {
    std::vector<app::BenchmarkSubject> subjects;
    for (const auto& [name, tracer] : impl_->tracers)
        subjects.push_back(app::make_subject(
            name, [&one = *tracer] { one.trace(); }, warmup));
    for (const auto& [name, capture] : impl_->captures)
        subjects.push_back(app::make_subject(
            name, [&one = *capture] { one.draw(); }, warmup));
    return subjects;
}

std::vector<Vector> Prototypes::read(const std::string& name) {
    const auto tracer = impl_->tracers.find(name);
    return tracer != impl_->tracers.end() ? tracer->second->read()
                                          : impl_->captures.at(name)->read();
}

} // namespace peers
