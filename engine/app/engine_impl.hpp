#pragma once

#include "app/engine.hpp"
#include "gpu/device.hpp"
#include "gpu/pipeline.hpp"

namespace catoptric::app {

/// What sessions share.
struct Engine::Impl {
    explicit Impl(const EngineOptions& options);
    gpu::Device device;
    gpu::Pipelines pipelines;
    DeviceInfo info;
};

} // namespace catoptric::app
