#include "core/error.hpp"
#include "core/knob.hpp"
#include "stress/property.hpp"

#include <algorithm>

namespace catoptric::stress {

namespace {

std::vector<StressProperty>& get_property_table() {
    static std::vector<StressProperty> rows;
    return rows;
}

} // namespace

RegisteredStressProperty::RegisteredStressProperty(const StressProperty& property) {
    get_property_table().push_back(property);
}

std::vector<const StressProperty*> list_stress_properties() {
    std::vector<const StressProperty*> rows;
    for (const StressProperty& property : get_property_table()) rows.push_back(&property);
    std::ranges::sort(rows, {}, [](const StressProperty* row) {
        return std::pair(row->id[0], std::stoi(std::string(row->id.substr(1))));
    });
    return rows;
}

const StressProperty& find_stress_property(std::string_view id) {
    std::vector<std::string> ids;
    for (const StressProperty* row : list_stress_properties()) {
        if (row->id == id) return *row;
        ids.emplace_back(row->id);
    }
    fail(Failure::usage, "--only: wanted the id of a property (", ids.front(), " ... ", ids.back(),
         "), found '", id, "'", suggest_name(id, ids));
}

} // namespace catoptric::stress
