// Reads the results of a frame that a session has submitted.
#include "render/captured.hpp"
#include "require/model.hpp"
#include "session/access.hpp"
#include "session/session_impl.hpp"

namespace catoptric::session {

FrameTimes to_frame_times(const graph::GraphFrameTimes& times) {
    FrameTimes frame{.gpu_ms = times.span_ms,
                     .record_ms = times.record_ms,
                     .wall_ms = times.wall_ms,
                     .wait_ms = times.wait_ms};
    frame.host.compile = times.compile_ms, frame.host.record = times.record_ms;
    for (const graph::GraphPassTime& pass : times.passes) {
        frame.passes.push_back({pass.name, pass.begin_ms, pass.end_ms});
        frame.passes_ms += pass.elapsed_ms();
    }
    return frame;
}

const FrameTimes& Frame::times() const {
    if (!impl_->times) {
        impl_->times = to_frame_times(impl_->graph_runner().wait_for(impl_->ticket));
        impl_->times->host.update = impl_->update_ms;
        impl_->times->host.hierarchy = impl_->hierarchy_ms;
        impl_->times->host.compile += impl_->declare_ms;
        impl_->times->wait_ms += impl_->waited_ms;
    }
    return *impl_->times;
}

std::size_t Frame::size() const { return impl_->frame.parts.size(); }

bool Access::remembers(const Frame& frame, std::size_t part) {
    const Frame::Impl& self = *frame.impl_;
    return session::remembers(self.frame, self.graph_plan(), self.part(part));
}

const std::optional<CaptureBudget>& Frame::capture_budget(std::size_t part) const {
    return impl_->part(part).capture_budget;
}

std::uint32_t Frame::waiting() const {
    std::uint32_t waiting = 0;
    for (const FramePart& part : impl_->frame.parts)
        waiting += part.capture_budget ? part.capture_budget->waiting : 0;
    return waiting;
}

const require::WorkModel& Access::rendered_model(const Frame& frame) { return *frame.impl_->model; }

measure::Picture Frame::hdr(std::size_t part) const {
    return read_hdr(impl_->graph_runner(), impl_->ticket, impl_->part(part), impl_->spec.size);
}

TechniqueResult Frame::read(std::size_t part) const {
    if (impl_->spec.with_lookup) impl_->check_is_last();
    TechniqueResult read = read_result(impl_->graph_runner(), impl_->ticket, impl_->frame, part,
                                       impl_->session->mirrors, *impl_->session->resident,
                                       impl_->spec);
    read.model = impl_->spec.model;
    if (!impl_->part(part).outputs.draws_everything) read.left_out = impl_->model->left_out;
    read.capture_budget = capture_budget(part);
    return read;
}

std::vector<TechniqueResult> Frame::read_all() const {
    std::vector<TechniqueResult> parts;
    for (std::size_t i = 0; i < size(); ++i) parts.push_back(read(i));
    return parts;
}

render::CapturedCubes Access::read_captures(const Frame& frame, std::size_t part) {
    const Frame::Impl& self = *frame.impl_;
    const std::shared_ptr<const render::MirrorCaptures>& captures =
        self.part(part).outputs.captures;
    check(
        self.hooks.with_captures && captures && captures->arrays.size() == 1 &&
            captures->arrays.front().distance,
        Failure::internal, "'", self.part(part).plan.label,
        "': wanted captures with distances in one array that the frame was asked for, found none");
    self.check_is_last();
    graph::GraphRunner& runner = self.graph_runner();
    const render::CubeCaptureArray& cubes = captures->arrays.front();
    return {cubes.face, runner.read_back(self.ticket, cubes.colour),
            runner.read_back(self.ticket, *cubes.distance), self.session->resident->scene_units()};
}

std::vector<PassWork> Access::pass_work(const Frame& frame) {
    return frame.impl_->graph_runner().work_counts(frame.impl_->ticket);
}

std::vector<std::byte> Access::read_state(const Frame& frame) {
    const Frame::Impl& self = *frame.impl_;
    self.check_is_last();
    graph::GraphRunner& runner = self.graph_runner();
    std::vector<std::byte> bytes = runner.read_history();
    const auto add = [&](graph::ImageHandle image) {
        const std::vector<std::byte> texels = runner.read_back(self.ticket, image);
        bytes.insert(bytes.end(), texels.begin(), texels.end());
    };
    for (const FramePart& part : self.frame.parts) {
        if (!part.outputs.kept) continue;
        for (const render::CubeCaptureArray& cubes : part.outputs.captures->arrays) {
            add(cubes.colour);
            if (cubes.distance) add(*cubes.distance);
        }
    }
    if (bytes.empty()) return bytes;
    for (const FramePart& part : self.frame.parts) add(part.outputs.hdr);
    return bytes;
}

} // namespace catoptric::session
