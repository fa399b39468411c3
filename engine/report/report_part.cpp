#include "report/report_part.hpp"

#include "core/table.hpp"

namespace catoptric::report {

RegisteredReportPart::RegisteredReportPart(const ReportPart& part) {
    get_registered_rows<ReportPart>().push_back(part);
}

std::vector<ReportPart> list_report_parts() { return sort_registered_rows<ReportPart>(); }

} // namespace catoptric::report
