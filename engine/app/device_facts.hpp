#pragma once

#include "app/engine.hpp"
#include "measure/comparison.hpp"

namespace catoptric::app {

/// What reports say of a device.
inline measure::DeviceFacts facts_of(const DeviceInfo& device) {
    return {device.name,    device.driver,  device.api,     device.type,
            device.threads, device.profile, device.variants};
}

} // namespace catoptric::app
