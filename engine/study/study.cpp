#include "study/study.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/table.hpp"

#include <string>
#include <utility>

namespace catoptric::study {

RegisteredStudy::RegisteredStudy(Study study) {
    for (measure::Metric metric : study.metrics) {
        metric.study = study.name;
        const measure::RegisteredMetric registers(std::move(metric));
    }
    study.part.name = study.name;
    if (study.part.tables != nullptr) const report::RegisteredPart registers(study.part);
    table_rows<Study>().push_back(std::move(study));
}

const std::vector<Study>& studies() {
    static const std::vector<Study> kSortedStudies = sorted_rows<Study>();
    return kSortedStudies;
}

const Study& find_study(std::string_view name) {
    std::vector<std::string> names;
    for (const Study& study : studies()) {
        if (study.name == name) return study;
        names.emplace_back(study.name);
    }
    fail(Failure::usage, "no study '", name, "'", suggest_name(name, names));
}

void check_study(const StudyChoice& choice, const std::string& reference) {
    const Study& study = find_study(choice.name);
    if (study.check_reference != nullptr) study.check_reference(reference);
    if (study.check_words != nullptr) study.check_words(choice.texts);
}

} // namespace catoptric::study
