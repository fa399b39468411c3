#pragma once

#include "measure/comparison.hpp"
#include "session/engine.hpp"
#include "session/lanes.hpp"

namespace catoptric::app {

/// Returns the facts that reports list about a device. Leaves out the lanes, because only a
/// dispatch can count them.
inline measure::DeviceFacts facts_of(const DeviceInfo& device) {
    return {device.name,    device.driver,  device.api,     device.type,
            device.threads, device.profile, device.variants};
}

/// Returns the facts that reports list about the engine's device. Dispatches a shader to count the
/// lanes.
inline measure::DeviceFacts facts_of(const Engine& engine) {
    measure::DeviceFacts facts = facts_of(engine.device());
    facts.lanes = lanes_of(engine);
    return facts;
}

} // namespace catoptric::app
