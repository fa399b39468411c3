#include "report/report_part.hpp"

#include "core/table.hpp"

namespace catoptric::report {

RegisteredPart::RegisteredPart(const ReportPart& part) { table_rows<ReportPart>().push_back(part); }

std::vector<ReportPart> list_parts() { return sorted_rows<ReportPart>(); }

} // namespace catoptric::report
