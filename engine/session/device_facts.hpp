#pragma once

#include "measure/comparison.hpp"
#include "session/calibration.hpp"
#include "session/engine.hpp"
#include "session/lanes.hpp"

namespace catoptric::session {

/// Returns the facts that reports list about a device. Leaves out the lanes, because only a
/// dispatch can count them.
inline measure::DeviceFacts make_device_facts(const DeviceInfo& device) {
    return {device.name,    device.driver,  device.api,      device.type,
            device.threads, device.profile, device.variants, device.calibration};
}

/// Returns the facts that reports list about the engine's device, with its balance. Dispatches a
/// shader to count the lanes.
inline measure::DeviceFacts make_device_facts(const Engine& engine) {
    measure::DeviceFacts facts = make_device_facts(engine.device());
    facts.balance = describe_balance(engine);
    facts.lanes = count_lanes(engine);
    return facts;
}

} // namespace catoptric::session
