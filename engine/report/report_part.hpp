#pragma once

#include "report/tables.hpp"
#include "report/writer.hpp"

#include <string>
#include <string_view>
#include <vector>

/// Table of the parts that report.md and report.html have for special results, such as errors by
/// cause. They stand between the table of rows and the pictures. The .cpp that makes a part
/// registers it, so that no other file lists it.
namespace catoptric::report {

/// A comparison by the times of another device.
struct ComparisonOnDevice {
    /// The comparison with that device's name, times and front, and without pictures.
    Comparison comparison;
    std::string times; ///< what the times are, for example "predicted from counted work"
    std::string front; ///< a sentence that names the front
};

struct ReportPart {
    std::string_view name;
    int order = 1000; ///< place in the report; equal orders are sorted by name
    /// Returns the part's tables. Reports leave out tables without rows, and leave out the
    /// sentences and pictures if all tables have no rows.
    std::vector<ReportTable> (*tables)(const Comparison&) = nullptr;
    std::string_view look = {}; ///< class of the tables in HTML
    bool links_rows = false;    ///< whether line i of a table belongs to row i, and links to it
    /// Returns sentences that follow the tables. `title` heads them in HTML. May be null.
    std::vector<std::string> (*sentences)(const Comparison&) = nullptr;
    std::string_view title = {};
    /// Returns a sentence for the top of report.html, or nothing. May be null.
    std::string (*first_sentence)(const Comparison&) = nullptr;
    /// Returns the comparison on other devices. The switch at the top of report.html shows the
    /// first sentences and the plot of one of them. May be null.
    std::vector<ComparisonOnDevice> (*other_devices)(const Comparison&) = nullptr;
    /// Returns HTML that stands before the tables. May be null.
    std::string (*plots)(const Comparison&) = nullptr;
    /// Returns HTML that stands after the sentences. May be null.
    std::string (*pictures)(const Comparison&, const EncodedPictures&) = nullptr;
};

/// Registers a part. Define it at namespace scope: the part enters the table while the program
/// starts.
struct RegisteredPart {
    explicit RegisteredPart(const ReportPart& part);
};

/// Returns all parts by `order`, then name.
std::vector<ReportPart> list_parts();

} // namespace catoptric::report
