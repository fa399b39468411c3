#pragma once
#include "places.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

/// The second driver: Mesa 25, which `./dev drivers` unpacks beside the system's driver.
namespace test {

inline constexpr const char* kNoSecondDriverMessage =
    "no second driver: ./dev drivers unpacks Mesa 25 under build/drivers";

/// Returns the environment variables with which a process sees only the second driver. Returns
/// nothing if that driver is not unpacked.
inline std::optional<std::map<std::string, std::string>> find_second_driver_environment() {
    const std::filesystem::path place = source_folder() / "build/drivers/mesa25";
    if (!std::filesystem::exists(place / "icd.json")) return {};
    const char* libraries = std::getenv("LD_LIBRARY_PATH");
    return {{{"VK_DRIVER_FILES", place / "icd.json"},
             {"LD_LIBRARY_PATH",
              (place / "lib").string() + (libraries ? std::string(":") + libraries : "")}}};
}

} // namespace test
