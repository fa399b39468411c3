#pragma once

#include <cstdlib>
#include <string>

namespace test {

/// The device that a person asked for (bench/machine/run.sh), as `app::EngineOptions` takes it;
/// empty: the first usable.
inline std::string wanted_device() {
    const char* wanted = std::getenv("CATOPTRIC_TEST_DEVICE");
    return wanted ? wanted : "";
}

} // namespace test
