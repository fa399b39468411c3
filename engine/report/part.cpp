#include "report/part.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::report {

namespace {

std::vector<Part>& part_table() {
    static std::vector<Part> rows; // filled while the program starts
    return rows;
}

} // namespace

RegisteredPart::RegisteredPart(const Part& part) { part_table().push_back(part); }

std::vector<Part> parts() {
    std::vector<Part> rows = part_table();
    std::ranges::sort(rows, {}, [](const Part& row) { return std::pair(row.order, row.name); });
    return rows;
}

} // namespace catoptric::report
