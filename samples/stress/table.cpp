#include "core/error.hpp"
#include "core/knob.hpp"
#include "stress/property.hpp"

#include <algorithm>

namespace catoptric::stress {

namespace {

std::vector<Property>& property_table() {
    static std::vector<Property> rows;
    return rows;
}

} // namespace

RegisteredProperty::RegisteredProperty(const Property& property) {
    property_table().push_back(property);
}

std::vector<const Property*> properties() {
    std::vector<const Property*> rows;
    for (const Property& property : property_table()) rows.push_back(&property);
    std::ranges::sort(rows, {}, [](const Property* row) {
        return std::pair(row->id[0], std::stoi(std::string(row->id.substr(1))));
    });
    return rows;
}

const Property& find_property(std::string_view id) {
    std::vector<std::string> ids;
    for (const Property* row : properties()) {
        if (row->id == id) return *row;
        ids.emplace_back(row->id);
    }
    fail(Failure::usage, "--only: wanted the id of a property (", ids.front(), " ... ", ids.back(),
         "), found '", id, "'", suggest_name(id, ids));
}

} // namespace catoptric::stress
