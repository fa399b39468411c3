#pragma once
#include "places.hpp"

#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

/// Mesa 25 as ./dev drivers unpacks it beside the system's driver.
namespace test {

inline constexpr const char* kNoSecondDriver =
    "no second driver: ./dev drivers unpacks Mesa 25 under build/drivers";

/// What a process needs in its environment to see that driver and no other; nothing where it was
/// not set up.
inline std::optional<std::map<std::string, std::string>> second_driver() {
    const std::filesystem::path place = source_folder() / "build/drivers/mesa25";
    if (!std::filesystem::exists(place / "icd.json")) return {};
    const char* libraries = std::getenv("LD_LIBRARY_PATH");
    return {{{"VK_DRIVER_FILES", place / "icd.json"},
             {"LD_LIBRARY_PATH",
              (place / "lib").string() + (libraries ? std::string(":") + libraries : "")}}};
}

} // namespace test
