#pragma once

#include "app/engine.hpp"
#include "app/lanes.hpp"
#include "measure/comparison.hpp"

namespace catoptric::app {

/// Returns what reports say of a device, without the lanes, which only a dispatch can count.
inline measure::DeviceFacts facts_of(const DeviceInfo& device) {
    return {device.name,    device.driver,  device.api,     device.type,
            device.threads, device.profile, device.variants};
}

/// Returns what reports say of the device of `engine`. Dispatches a shader to count the lanes.
inline measure::DeviceFacts facts_of(const Engine& engine) {
    measure::DeviceFacts facts = facts_of(engine.device());
    facts.lanes = lanes_of(engine);
    return facts;
}

} // namespace catoptric::app
