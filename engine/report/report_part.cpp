#include "report/report_part.hpp"

#include <algorithm>
#include <utility>

namespace catoptric::report {

namespace {

std::vector<ReportPart>& report_part_table() {
    static std::vector<ReportPart> rows; // filled while the program starts
    return rows;
}

} // namespace

RegisteredReportPart::RegisteredReportPart(const ReportPart& part) {
    report_part_table().push_back(part);
}

std::vector<ReportPart> list_report_parts() {
    std::vector<ReportPart> rows = report_part_table();
    std::ranges::sort(rows, {},
                      [](const ReportPart& row) { return std::pair(row.order, row.name); });
    return rows;
}

} // namespace catoptric::report
