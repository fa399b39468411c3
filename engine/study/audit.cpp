// The audit of a plan as users of the library see it.
#include "compare.hpp"
#include "scene/hash.hpp"
#include "study/plan_audit.hpp"

#include <utility>

namespace catoptric::study {

namespace {

PlanAuditRequest read_audit_request(const std::filesystem::path& file, AuditOptions options) {
    PlanAuditRequest request = read_plan_audit(file);
    request.pace = {options.every, options.most_time, options.seed};
    request.before_audit = std::move(options.before_audit);
    return request;
}

} // namespace

struct PlanAudit::Impl {
    RunningPlanAudit running;
};

PlanAudit::PlanAudit(const std::filesystem::path& file, AuditOptions options)
    : impl_(
          std::make_unique<Impl>(RunningPlanAudit(read_audit_request(file, std::move(options))))) {}

PlanAudit::~PlanAudit() = default;

bool PlanAudit::is_for(const scene::Scene& scene) const {
    const std::string& hash = impl_->running.request().scene_hash;
    return hash.empty() || hash == scene::hash_scene(scene);
}

const std::string& PlanAudit::plan() const { return impl_->running.plan(); }

void PlanAudit::prepare(Session& session, const FrameSpec& spec) {
    impl_->running.prepare(session, spec);
}

AuditState PlanAudit::watch_frame(Session& session, const Frame& frame, const FrameSpec& spec,
                                  double seconds) {
    return impl_->running.watch_frame(session, frame, spec, seconds);
}

void PlanAudit::wait_until_settled() { impl_->running.wait_until_settled(); }

std::string PlanAudit::describe() const { return impl_->running.describe(); }

} // namespace catoptric::study
