#pragma once

#include "gpu/device.hpp"
#include "gpu/pipeline.hpp"
#include "session/engine.hpp"

#include <optional>

namespace catoptric::app {

/// State of an engine that its sessions share.
struct Engine::Impl {
    explicit Impl(const EngineOptions& options,
                  const std::optional<gpu::GivenDevice>& given = std::nullopt);
    gpu::Device device;
    gpu::Pipelines pipelines;
    DeviceInfo info;
};

} // namespace catoptric::app
