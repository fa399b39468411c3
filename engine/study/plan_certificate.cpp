#include "study/plan_certificate.hpp"

#include "core/file.hpp"
#include "core/json.hpp"
#include "measure/metric.hpp"
#include "report/json.hpp"
#include "report/report_part.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

namespace catoptric::study {

namespace {

using report::Json;
using report::ReportTable;

constexpr const char* kCertificateMetricName = "certificate";
constexpr std::string_view kPlanFilePrefix = "plan:";

double find_number(const Json& object, const char* name) {
    const Json value = object.value(name, Json());
    return value.is_number() ? value.get<double>() : NAN;
}

std::string find_text(const Json& object, const char* name) {
    const Json value = object.value(name, Json());
    return value.is_string() ? value.get<std::string>() : std::string();
}

/// Returns the statement of a certificate as a sentence, or nothing if members are missing.
std::optional<std::string> describe_certificate(const Json& certificate) {
    const double share = find_number(certificate, "share"),
                 confidence = find_number(certificate, "confidence"),
                 views = find_number(certificate, "views"),
                 failures = find_number(certificate, "failures"),
                 limit = find_number(certificate, "max_error"),
                 bound = find_number(certificate, "error_bound"),
                 proved = find_number(certificate, "share_bound"),
                 width = find_number(certificate, "width"),
                 height = find_number(certificate, "height");
    const double error = std::isnan(limit) ? bound : limit; // with a limit of time alone, the
                                                            // proved error counts as the limit
    const std::string quantity = find_text(certificate, "quantity");
    if (quantity.empty() ||
        !std::isfinite(share + confidence + views + failures + error + width + height))
        return std::nullopt;
    if (!std::isnan(limit) && !(proved >= share))
        return std::nullopt; // the proved share is smaller than the claimed share
    return fmt::format("at least {:.4g} % of views have {} <= {:.4g}, with {:.4g} % confidence "
                       "({:.0f} views, {:.0f} failures), at {:.0f}x{:.0f}",
                       100 * share, quantity, error, 100 * confidence, views, failures, width,
                       height);
}

/// Returns the certificate in the results of a row, or null.
const measure::MetricParts* find_certificate(const measure::MetricValue& value) {
    const auto* list = std::get_if<std::vector<measure::MetricParts>>(&value);
    return list != nullptr && !list->empty() ? &list->front() : nullptr;
}

bool is_of_scene(const measure::MetricParts& certificate) {
    return std::get<bool>(certificate.values.front().second);
}

std::vector<ReportTable> make_certificate_tables(const report::Comparison& comparison) {
    ReportTable table{
        "Certificates of chosen plans",
        {report::text_column("row"), report::text_column("statement"),
         report::text_column("for this scene")},
        "As catoptric choose proved them, for drawn views of the named size. They say "
        "nothing of the times in this report.",
        {},
        {}};
    for (const report::Row& row : comparison.rows) {
        const measure::MetricValue value = measure::study_metric(row, kCertificateMetricName);
        if (const auto* certificate = find_certificate(value))
            table.rows.push_back(
                {row.label, certificate->name, is_of_scene(*certificate) ? "yes" : "no"});
    }
    return {table};
}

std::string quote_certificates(const report::Comparison& comparison) {
    std::string sentences;
    for (const report::Row& row : comparison.rows) {
        const measure::MetricValue value = measure::study_metric(row, kCertificateMetricName);
        const auto* certificate = find_certificate(value);
        if (certificate == nullptr) continue;
        sentences += (sentences.empty() ? "" : " ") + row.label + " was chosen" +
                     (is_of_scene(*certificate) ? "" : " for another scene") + ": " +
                     certificate->name + ".";
    }
    return sentences;
}

const measure::RegisteredMetric kCertificateMetric{
    {.name = kCertificateMetricName,
     .help = "statement of the certificate of a chosen plan, and whether it is for this scene",
     .order = 795,
     .study = kCertificateMetricName,
     .get = measure::Metric::FromStudy{}}};
const report::RegisteredPart kCertificatePart{{.name = kCertificateMetricName,
                                               .order = 650,
                                               .tables = make_certificate_tables,
                                               .first_sentence = quote_certificates}};

} // namespace

std::vector<std::optional<PlanCertificate>>
read_certificates(const std::vector<std::string>& texts) {
    std::vector<std::optional<PlanCertificate>> certificates(texts.size());
    for (std::size_t i = 0; i < texts.size(); ++i) {
        if (!texts[i].starts_with(kPlanFilePrefix)) continue;
        const std::string file = texts[i].substr(kPlanFilePrefix.size());
        const Json document = parse_json<Json>(file, read_file(file));
        const Json certificate = document.is_object() ? document.value("certificate", Json())
                                                      : Json();
        if (!certificate.is_object()) continue;
        if (const std::optional<std::string> statement = describe_certificate(certificate))
            certificates[i] = {*statement, find_text(certificate, "scene_hash")};
    }
    return certificates;
}

void add_certificates(const std::vector<std::optional<PlanCertificate>>& certificates,
                      measure::Comparison& comparison) {
    for (std::size_t i = 0; i < std::min(certificates.size(), comparison.rows.size()); ++i) {
        if (!certificates[i]) continue;
        std::vector<measure::MetricParts> list{
            {"statement",
             certificates[i]->statement,
             {{"of_this_scene", certificates[i]->scene_hash == comparison.scene.hash}}}};
        measure::set_study_metric(comparison.rows[i], kCertificateMetricName, std::move(list));
        if (std::ranges::find(comparison.studies, kCertificateMetricName) ==
            comparison.studies.end())
            comparison.studies.emplace_back(kCertificateMetricName);
    }
}

} // namespace catoptric::study
