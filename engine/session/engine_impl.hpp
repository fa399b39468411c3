#pragma once

#include "gpu/device.hpp"
#include "gpu/pipeline.hpp"
#include "require/unit_costs.hpp"
#include "session/access.hpp"
#include "session/engine.hpp"

namespace catoptric::session {

/// State of an engine that its sessions share.
struct Engine::Impl {
    explicit Impl(const EngineOptions& options, const EngineHooks& hooks = {});
    gpu::Device device;
    gpu::PipelineStore pipelines;
    DeviceInfo info;
    require::DeviceUnitCosts unit_costs; ///< by which `auto` compares plans
};

} // namespace catoptric::session
