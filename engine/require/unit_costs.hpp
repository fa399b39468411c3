#pragma once

#include "core/work.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>

/// Unit costs by which `auto` compares plans: those of docs/costs, which the program contains, or
/// of a calibrated device.
namespace catoptric::require {

/// A number for each kind of work: estimated counts, or costs.
struct WorkValues {
    std::array<double, kWorkKindCount> values{};

    double& operator[](WorkKind kind) { return values[static_cast<std::size_t>(kind)]; }
    double operator[](WorkKind kind) const { return values[static_cast<std::size_t>(kind)]; }
};

struct UnitCosts {
    std::string file;   ///< name of the file, of docs/costs without its extension
    std::string device; ///< as the file names it
    std::string origin; ///< "fitted", "literature" or "given"
    WorkValues ns;      ///< nanoseconds of one unit; 0: unknown, takes no time
};

/// Returns the costs of all files, ordered by name.
std::span<const UnitCosts> list_unit_costs();
/// Returns the costs of the software driver on which this project measures.
const UnitCosts& default_unit_costs();

/// Unit costs by which plans for a device are compared.
struct DeviceUnitCosts {
    UnitCosts costs = default_unit_costs();
    std::string note; ///< which costs these are: "llvmpipe-22.3, fitted on this device"
};

/// Returns the costs of a device in docs/costs. A device without a file gets those of the most
/// similar one: a processor those of llvmpipe with the nearest version of Mesa, a card those from
/// the literature for the newest card. `name` and `driver` are those of session::DeviceInfo.
DeviceUnitCosts find_unit_costs(std::string_view name, std::string_view driver, bool is_processor);

double predict_ms(const WorkValues& counts, const UnitCosts& costs);

} // namespace catoptric::require
