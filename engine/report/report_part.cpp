#include "report/report_part.hpp"

#include "core/table.hpp"

namespace catoptric::report {

RegisteredReportPart::RegisteredReportPart(const ReportPart& part) {
    get_registered_table_entries<ReportPart>().push_back(part);
}

std::vector<ReportPart> list_report_parts() {
    return list_registered_entries_in_order<ReportPart>();
}

} // namespace catoptric::report
