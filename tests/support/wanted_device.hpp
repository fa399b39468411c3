#pragma once

#include <cstdlib>
#include <string>

namespace test {

/// Returns the device that CATOPTRIC_TEST_DEVICE names (bench/machine/run.sh), in the form that
/// `session::EngineOptions` takes. Empty stands for the first usable device.
inline std::string read_wanted_device_name() {
    const char* wanted = std::getenv("CATOPTRIC_TEST_DEVICE");
    return wanted ? wanted : "";
}

} // namespace test
