#include "measure/row_notes.hpp"

namespace catoptric::measure {

std::vector<std::string> row_notes(const Comparison& comparison, const Row& row) {
    const std::string begin = "'" + row.label + "': ";
    std::vector<std::string> notes;
    for (const std::string& warning : comparison.warnings)
        if (warning.starts_with(begin)) notes.push_back(warning.substr(begin.size()));
    return notes;
}

} // namespace catoptric::measure
