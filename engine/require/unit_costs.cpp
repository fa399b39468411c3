#include "require/unit_costs.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace catoptric::require {

namespace {

constexpr std::string_view kDefaultFile = "llvmpipe-22.3", kDefaultCardFile = "rtx-2080-ti";
constexpr std::string_view kLlvmpipe = "llvmpipe", kMesa = "Mesa ";

const UnitCosts& find_file(std::string_view name) {
    return *std::ranges::find(list_unit_costs(), name, &UnitCosts::file);
}

/// Returns the version of Mesa that a driver's description names, such as 22.3; 0 if there is none.
double find_mesa_version(std::string_view text) {
    const std::size_t place = text.find(kMesa);
    if (place == std::string_view::npos) return 0;
    return std::strtod(std::string(text.substr(place + kMesa.size(), 5)).c_str(), nullptr);
}

} // namespace

const UnitCosts& default_unit_costs() { return find_file(kDefaultFile); }

DeviceUnitCosts find_unit_costs(std::string_view name, std::string_view driver, bool is_processor) {
    const std::string whole = std::string(name) + ", " + std::string(driver);
    const auto describe = [&](const UnitCosts& costs, const char* relation) {
        std::string note = costs.file + ", " + costs.origin + relation;
        if (name.find(costs.device) == std::string_view::npos && whole != costs.device)
            note += " " + costs.device + ", because docs/costs has no file of " + std::string(name);
        return DeviceUnitCosts{costs, std::move(note)};
    };
    const UnitCosts* own = nullptr;
    for (const UnitCosts& costs : list_unit_costs())
        if (whole.find(costs.device) != std::string::npos &&
            (own == nullptr || costs.device.size() > own->device.size()))
            own = &costs;
    if (own != nullptr) return describe(*own, ", for this device");
    if (!is_processor) return describe(find_file(kDefaultCardFile), ", for");
    const UnitCosts* nearest = &default_unit_costs();
    const double version = find_mesa_version(driver);
    const auto distance = [&](const UnitCosts& costs) {
        return std::abs(find_mesa_version(costs.device) - version);
    };
    for (const UnitCosts& costs : list_unit_costs())
        if (version > 0 && costs.device.starts_with(kLlvmpipe) &&
            distance(costs) < distance(*nearest))
            nearest = &costs;
    return describe(*nearest, ", for");
}

double predict_ms(const WorkValues& counts, const UnitCosts& costs) {
    double ns = 0;
    for (std::size_t i = 0; i < kWorkKindCount; ++i) ns += counts.values[i] * costs.ns.values[i];
    return ns * 1e-6;
}

} // namespace catoptric::require
