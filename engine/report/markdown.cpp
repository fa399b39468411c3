#include "core/text.hpp"
#include "measure/budget.hpp"
#include "report/report_part.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <algorithm>

namespace catoptric::report {

std::string escape_markdown(const std::string& text) {
    std::string result;
    for (const char c : escape(text, "\n")) {
        if (std::string_view("\\`*_[]<>|#&~").find(c) != std::string_view::npos) result += '\\';
        result += c == '\n' ? ' ' : c;
    }
    return result;
}

namespace {

/// Returns the number of characters, not bytes.
std::size_t count_characters(const std::string& text) {
    return static_cast<std::size_t>(
        std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string pad_cell(const std::string& cell, std::size_t width, bool right) {
    const std::string space(width - count_characters(cell), ' ');
    return right ? space + cell : cell + space;
}

std::string markdown_line(const std::vector<std::string>& cells,
                          const std::vector<std::size_t>& widths,
                          const std::vector<TableColumn>& columns) {
    std::string line = "|";
    for (std::size_t i = 0; i < columns.size(); ++i)
        line += " " + pad_cell(cells[i], widths[i], columns[i].is_number) + " |";
    return line + "\n";
}

std::string markdown_list(const std::vector<std::string>& sentences) {
    std::string text;
    for (const std::string& sentence : sentences) text += "- " + escape_markdown(sentence) + "\n";
    return text + "\n";
}

/// Returns the tables and sentences of a part, or nothing if its tables have no rows.
std::string markdown_part(const Comparison& comparison, const ReportPart& part) {
    std::string text;
    for (const ReportTable& table : part.tables(comparison)) text += to_markdown(table);
    if (text.empty() || part.sentences == nullptr) return text;
    return text + markdown_list(part.sentences(comparison));
}

} // namespace

std::string to_markdown(const ReportTable& table) {
    if (table.rows.empty()) return "";
    std::vector<std::vector<std::string>> lines(1);
    for (const TableColumn& column : table.columns)
        lines[0].push_back(escape_markdown(column.name));
    for (const std::vector<std::string>& row : table.rows) {
        std::vector<std::string>& cells = lines.emplace_back();
        for (const std::string& cell : row) cells.push_back(escape_markdown(cell));
    }
    std::vector<std::size_t> widths(table.columns.size(), 2);
    for (const std::vector<std::string>& cells : lines)
        for (std::size_t i = 0; i < cells.size(); ++i)
            widths[i] = std::max(widths[i], count_characters(cells[i]));
    std::vector<std::string> rule;
    for (std::size_t i = 0; i < widths.size(); ++i)
        rule.push_back(std::string(widths[i] - 1, '-') + (table.columns[i].is_number ? ":" : "-"));
    lines.insert(lines.begin() + 1, rule);

    std::string text = "## " + escape_markdown(table.title) + "\n\n";
    for (const std::vector<std::string>& cells : lines)
        text += markdown_line(cells, widths, table.columns);
    return text + (table.note.empty() ? "" : "\n" + escape_markdown(table.note) + "\n") + "\n";
}

std::string to_markdown(const Comparison& comparison) {
    std::string text = "# Reflections compared: " + escape_markdown(comparison.scene.name) +
                       "\n\n" +
                       (measure::has_budget(comparison)
                            ? "**" + escape_markdown(describe_budget(comparison)) + "**\n\n"
                            : "") +
                       escape_markdown(summarise_verdict(comparison)) + "\n\n";
    for (const ReportHeaderLine& fact : list_facts(comparison))
        text += "- **" + fact.name + "**: " + escape_markdown(fact.value) + "\n";
    text += "\n";
    for (const std::string& caution : list_cautions(comparison))
        text += "> " + escape_markdown(caution) + "\n>\n";
    text += "\n" + (comparison.scene.is_seed ? to_markdown(seed_table(comparison)) : "") +
            "**Set-up**, once: " +
            escape_markdown(describe_setup(measure::read_setup_facts(comparison))) + "\n\n" +
            to_markdown(rows_table(comparison)) + to_markdown(plan_table(comparison));
    for (const ReportPart& part : list_parts()) text += markdown_part(comparison, part);
    text += to_markdown(unsupported_table(comparison.scene));
    text += "## The Pareto front: time against FLIP\n\n" +
            markdown_list(describe_front(comparison));
    const std::vector<std::string> sentences = list_findings(comparison);
    if (!sentences.empty())
        text += "## " + findings_title(comparison) + "\n\n" + markdown_list(sentences);
    return text;
}

} // namespace catoptric::report
