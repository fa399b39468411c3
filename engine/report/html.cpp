// Writes report.html: one self-contained page.
#include "report/html.hpp"
#include "measure/budget.hpp"
#include "measure/heat.hpp"
#include "measure/judge.hpp"
#include "report/chart.hpp"
#include "report/report_part.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catoptric::report {

namespace {

std::string html_cell(const TableColumn& column, const char* tag, const char* scope,
                      const std::string& content) {
    return fmt::format("<{}{}{}>{}</{}>", tag, scope, column.is_number ? "" : " class=\"text\"",
                       content, tag);
}

/// If `linked` is given, the first cell of row i links to the pictures of its row i.
std::string to_html(const ReportTable& table, const std::string& look,
                    const Comparison* linked = nullptr) {
    if (table.rows.empty()) return "";
    const std::string title = escape_html(table.title);
    std::string html = fmt::format("<div class=\"scroll\" tabindex=\"0\" role=\"region\" "
                                   "aria-label=\"{}\"><table class=\"{}\"><thead><tr>",
                                   title, look);
    for (const TableColumn& column : table.columns)
        html += html_cell(column, "th", " scope=\"col\"", escape_html(column.name));
    html += "</tr></thead><tbody>";
    for (std::size_t r = 0; r < table.rows.size(); ++r) {
        const bool marked = r < table.marked.size() && table.marked[r];
        html += marked ? "\n<tr class=\"front\">" : "\n<tr>";
        for (std::size_t i = 0; i < table.columns.size(); ++i) {
            std::string content = escape_html(table.rows[r][i]);
            if (i == 0 && linked != nullptr)
                content = fmt::format("<a href=\"#{}\">{}</a>", row_anchor(*linked, r), content);
            html += html_cell(table.columns[i], i == 0 ? "th" : "td",
                              i == 0 ? " scope=\"row\"" : "", content);
        }
        html += "</tr>";
    }
    return titled_section(title, html + "</tbody></table></div><p class=\"note\">" +
                                     escape_html(table.note) + "</p>");
}

std::string html_list(const std::vector<std::string>& sentences) {
    std::string html = "<ul>";
    for (const std::string& sentence : sentences) html += "<li>" + escape_html(sentence) + "</li>";
    return html + "</ul>";
}

std::string html_headline(const std::string& name, const std::string& figure,
                          const std::string& of) {
    return fmt::format("<div><dt>{}</dt><dd>{} <small>{}</small></dd></div>", name, figure,
                       escape_html(of));
}

/// Returns the headlines: the fastest row, the closest row other than the reference, the front, and
/// the reference.
std::string html_headlines(const Comparison& comparison) {
    std::string html = "<dl class=\"headline\">";
    const measure::FastestRows fastest = measure::find_fastest_rows(comparison);
    if (fastest.rows.size() == 1)
        html += html_headline("Fastest", format_ms(fastest.rows.front()->time_ms().median) + " ms",
                              fastest.rows.front()->label);
    else if (!fastest.rows.empty())
        html += html_headline(fastest.are_equal ? "Fastest" : "May be fastest",
                              std::to_string(fastest.rows.size()) + " rows",
                              fastest.are_equal ? "equal"
                                                : fmt::format("of {}", fastest.candidates));
    if (const Row* closest = measure::find_closest_row(comparison); closest != nullptr) {
        const std::size_t ties = measure::find_closest_ties(comparison).size();
        html += html_headline("Closest", "FLIP " + format_flip(closest->error),
                              closest->label +
                                  (ties == 0 ? "" : fmt::format(", {} more tie", ties)));
    }
    html += html_headline("On the front", std::to_string(comparison.pareto.size()),
                          fmt::format("of {} rows", comparison.rows.size()));
    if (!std::isnan(comparison.reference_gpu_ms.median))
        html += html_headline("Reference", format_ms(comparison.reference_gpu_ms.median) + " ms",
                              comparison.reference_label);
    return html + "</dl>";
}

/// Returns the comparison with the times of each other device that parts of the report know, such
/// as devices of --costs.
std::vector<ComparisonOnDevice> list_other_devices(const Comparison& comparison) {
    std::vector<ComparisonOnDevice> devices;
    for (const ReportPart& part : list_parts())
        if (part.other_devices != nullptr)
            for (ComparisonOnDevice& device : part.other_devices(comparison))
                devices.push_back(std::move(device));
    return devices;
}

/// Returns HTML that the page shows while the given device is chosen. Device 0 is the device that
/// measured.
std::string device_block(std::size_t device, const std::string& html) {
    return fmt::format("<div data-device=\"{}\"{}>{}</div>", device, device == 0 ? "" : " hidden",
                       html);
}

/// Returns HTML with the list of devices, or nothing if there is only one device. When the user
/// chooses a device, the page's script shows the HTML of this device.
std::string device_switch(const Comparison& comparison,
                          const std::vector<ComparisonOnDevice>& others) {
    if (others.empty()) return "";
    std::string html = "<p class=\"controls\"><label>Times of <select class=\"devices\">"
                       "<option value=\"0\">" +
                       escape_html(comparison.device.name) + ", measured here</option>";
    for (std::size_t i = 0; i < others.size(); ++i)
        html += fmt::format("<option value=\"{}\">{}, {}</option>", i + 1,
                            escape_html(others[i].comparison.device.name), others[i].times);
    return html + "</select></label></p>";
}

/// Returns the first sentences and headlines of the page for one device. `where` is the beginning
/// of the sentence on ray tracing.
std::string first_sentences(const Comparison& comparison, const std::string& where) {
    std::string html;
    if (measure::has_budget(comparison))
        html = "<p class=\"lede answer\"><strong>" + escape_html(describe_budget(comparison)) +
               "</strong></p>";
    return html + "<p class=\"lede\">" + escape_html(summarise_verdict(comparison, where)) + "</p>";
}

std::string row_numbers(const Row& row) {
    std::string html = "<dl class=\"numbers\">";
    for (const auto& [name, value] :
         {std::pair(row.on_processor ? "ms of processor time" : "ms",
                    format_ms(row.time_ms().median)),
          std::pair("FPS", format_fps(row.elapsed_ms().median)),
          std::pair("FLIP", format_flip(row.error)),
          std::pair("off, %", format_fixed(100 * row.error.off, 2)),
          std::pair("MAE", format_error(row.error.mae)),
          std::pair("rmse", format_error(row.error.rmse)),
          std::pair("FLIP, 1st order", format_flip(row.error_first_order)),
          std::pair("PSNR dB", format_fixed(row.error.psnr.value_or(NAN), 1)),
          std::pair("Scene passes", std::to_string(row.scene_passes)),
          std::pair("MiB", format_mebibytes(row.memory_bytes))})
        html += fmt::format("<div><dt>{}</dt><dd>{}</dd></div>", name, value);
    return html + "</dl>";
}

std::string row_details(const Row& row) {
    std::string html = "<details><summary>Knobs and passes</summary><p><code>" +
                       escape_html(format_settings(row)) + "</code></p>";
    if (row.rays)
        html += fmt::format("<p>Rays: {} primary, {} mirror, {} shadow.</p>", row.rays->primary,
                            row.rays->mirror, row.rays->shadow);
    if (row.traced_fraction)
        html += "<p>Traced: " + format_fixed(100 * *row.traced_fraction, 1) +
                " % of mirror pixels.</p>";
    if (row.passes.empty()) return html + "</details>";
    html += "<table><thead><tr><th class=\"text\" scope=\"col\">Pass</th><th "
            "scope=\"col\">ms</th></tr></thead><tbody>";
    for (const PassFacts& pass : row.passes)
        html += fmt::format("<tr><th class=\"text\" scope=\"row\">{}</th><td>{}</td></tr>",
                            escape_html(pass.name), format_fixed(pass.gpu_ms.median, 4));
    return html + "</tbody></table></details>";
}

std::string row_article(const Comparison& comparison, const EncodedPictures& encoded,
                        std::size_t index) {
    const Row& row = comparison.rows[index];
    std::string html = fmt::format("<article id=\"{}\"><div class=\"title\"><h3>{}</h3>",
                                   row_anchor(comparison, index), escape_html(row.label));
    for (const auto& [holds, name] :
         {std::pair(measure::is_on_front(comparison, row), "on the front"),
          std::pair(row.is_reference, "the reference"),
          std::pair(measure::has_nonfinite_pixels(row), "failed"), std::pair(row.noisy, "noisy")})
        if (holds) html += fmt::format("<span class=\"badge\">{}</span>", name);
    html += "</div><div class=\"pair\">" +
            html_figure(row.display.width, row.display.height, encoded.rows[index].picture,
                        "Picture by " + row.label, "Picture",
                        row_anchor(comparison, index) + "-picture",
                        picture_file(comparison, encoded, row.image + ".png")) +
            html_figure(row.display.width, row.display.height, encoded.rows[index].error,
                        "Heat map of the FLIP error of " + row.label + ", mean over the mirrors " +
                            format_flip(row.error),
                        "FLIP error", row_anchor(comparison, index) + "-error",
                        picture_file(comparison, encoded, row.image + "-error.png")) +
            html_figure(row.display.width, row.display.height, encoded.rows[index].causes,
                        "Pixels of " + row.label + " that are off, painted by their largest cause",
                        "Largest cause where it is off", row_anchor(comparison, index) + "-causes",
                        picture_file(comparison, encoded, "causes-" + row.image + ".png"));
    return html + "</div>" + row_numbers(row) + row_details(row) + "</article>\n";
}

std::string css_colour(const vec3& colour) {
    return fmt::format("rgb({:.0f} {:.0f} {:.0f})", colour.x * 255, colour.y * 255, colour.z * 255);
}

/// Returns the colour scale of the heat maps from 0 to 1.
std::string heat_scale() {
    std::string stops;
    for (int i = 0; i <= 8; ++i)
        stops += "," + css_colour(measure::heat_colour(static_cast<float>(i) / 8));
    return "<div class=\"scale\" style=\"background:linear-gradient(90deg" + stops +
           ")\"></div><div class=\"ends\"><span>FLIP 0: no difference</span><span>1</span></div>";
}

/// Returns the legend of the pictures by cause, or nothing if there are none.
std::string cause_legend(const Comparison& comparison) {
    if (std::ranges::none_of(comparison.rows, [](const Row& row) { return row.causes != nullptr; }))
        return "";
    std::string html = "<ul class=\"legend\">";
    for (const CauseColour& one : found_cause_colours(comparison))
        html += "<li><span style=\"background:" + css_colour(one.colour) + "\"></span>" +
                std::string(one.cause) + "</li>";
    return html + "</ul>";
}

std::string html_pictures(const Comparison& comparison, const EncodedPictures& encoded) {
    std::string html =
        "<div class=\"reference\">" +
        html_figure(comparison.reference_display.width, comparison.reference_display.height,
                    encoded.reference, "Reference picture by " + comparison.reference_label,
                    "Reference: " + comparison.reference_label, id_prefix(comparison) + "reference",
                    picture_file(comparison, encoded, "reference.png")) +
        "<div><p>Each row: its last frame, and where it differs from the reference.</p>" +
        heat_scale() + cause_legend(comparison) + "</div></div><div class=\"rows\">";
    for (std::size_t i = 0; i < comparison.rows.size(); ++i)
        html += row_article(comparison, encoded, i);
    return titled_section("Pictures", html + "</div>");
}

/// Returns the HTML of one part of the report: its tables, sentences and pictures.
std::string html_part(const Comparison& comparison, const EncodedPictures& encoded,
                      const ReportPart& part) {
    std::string html;
    for (const ReportTable& table : part.tables(comparison))
        html += to_html(table, std::string(part.look), part.links_rows ? &comparison : nullptr);
    const bool has_rows = !html.empty();
    if (part.plots != nullptr) html.insert(0, part.plots(comparison));
    if (has_rows && part.sentences != nullptr)
        html += titled_section(std::string(part.title), html_list(part.sentences(comparison)));
    if (has_rows && part.pictures != nullptr) html += part.pictures(comparison, encoded);
    return html;
}

std::string html_plot(const Comparison& comparison) {
    const std::string chart = rows_chart(comparison);
    if (chart.empty()) return "";
    return "<figure class=\"plot\">" + chart +
           "<figcaption>Lower left is better. Filled: no row beats it. Dashed: the least FLIP of a "
           "mark up to each time. Squares: ray traced. Bars: 95 % intervals; rows with the same "
           "place tie. Rows that are not judged have no mark. The lane below is error 0. A click on a mark, or arrow keys and Enter, show the row in "
           "the comparer.</figcaption></figure>";
}

std::string html_front(const Comparison& comparison,
                       const std::vector<ComparisonOnDevice>& others) {
    std::string html = device_block(0,
                                    html_plot(comparison) + html_list(describe_front(comparison)));
    for (std::size_t i = 0; i < others.size(); ++i)
        html += device_block(i + 1, html_plot(others[i].comparison) + html_list({others[i].front}));
    return titled_section("Time against error", html);
}

std::string html_circumstances(const Comparison& comparison) {
    std::string html = "<dl class=\"facts\">";
    for (const ReportHeaderLine& fact : list_facts(comparison))
        html += fmt::format("<dt>{0}</dt><dd><{1}>{2}</{1}></dd>", fact.name,
                            fact.name == "Command" ? "code" : "span", escape_html(fact.value));
    return titled_section("What was measured where", html + "</dl>");
}

} // namespace

std::string row_anchor(const Comparison& comparison, std::size_t row) {
    return fmt::format("{}row-{}", id_prefix(comparison), row);
}

std::string titled_section(const std::string& title, const std::string& content) {
    return "<section><h2>" + title + "</h2>" + content + "</section>\n";
}

std::string id_prefix(const Comparison& comparison) {
    std::string name = comparison.images;
    std::ranges::replace(name, '/', '-');
    return name;
}

std::string to_html(const Comparison& comparison) {
    EncodedPictures pictures;
    encode_pictures(pictures, comparison);
    return to_html(comparison, pictures);
}

std::string html_figure(int width, int height, const std::string& png, const std::string& alt,
                        const std::string& caption, const std::string& id,
                        const std::string& file) {
    if (png.empty()) return "";
    return fmt::format("<figure><img {}width=\"{}\" height=\"{}\" alt=\"{}\" {}src=\"{}\">"
                       "<figcaption>{}</figcaption></figure>",
                       id.empty() ? "" : "id=\"" + id + "\" ", width, height, escape_html(alt),
                       file.empty() ? "" : "loading=\"lazy\" ",
                       file.empty() ? png_uri(png) : escape_html(file), escape_html(caption));
}

std::string html_page(const std::string& title, const std::string& content) {
    const bool has_chart = content.find(kChartOpening) != std::string::npos;
    const std::string charts = has_chart ? std::string("<script>") + kChartLibrary +
                                               "</script>\n<script>" + kChartScript + "</script>"
                                         : std::string();
    const bool has_map = content.find(kMapOpening) != std::string::npos;
    const std::string map = has_map ? std::string("<script>") + kMapScript + "</script>"
                                    : std::string();
    return "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
           "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
           "<title>Reflections compared: " +
           escape_html(title) + "</title><style>" + kStyleSheet +
           (has_chart ? kChartStyleSheet : "") + "</style></head>\n<body>" + content +
           "\n<script>" + kPageScript + "</script>" + charts + map + "</body></html>\n";
}

std::string html_section(const Comparison& comparison, const EncodedPictures& encoded) {
    const std::vector<ComparisonOnDevice> others = list_other_devices(comparison);
    std::string html =
        "<header class=\"screen\"><div><p class=\"kicker\">Reflections compared on " +
        escape_html(comparison.device.name) + "</p><h1>" + escape_html(comparison.scene.name) +
        "</h1>" + device_switch(comparison, others) +
        device_block(0, first_sentences(comparison, "On this device, " + comparison.device.name));
    for (std::size_t i = 0; i < others.size(); ++i) {
        const Comparison& other = others[i].comparison;
        html += device_block(i + 1, first_sentences(other, "On " + other.device.name +
                                                               ", by times " + others[i].times));
    }
    for (const ReportPart& part : list_parts())
        if (part.first_sentence != nullptr)
            if (const std::string sentence = part.first_sentence(comparison); !sentence.empty())
                html += "<p class=\"lede\">" + escape_html(sentence) + "</p>";
    const std::vector<std::string> notes = list_cautions(comparison);
    if (!notes.empty()) html += "<aside class=\"caution\">" + html_list(notes) + "</aside>";
    const bool is_page = id_prefix(comparison).empty(); // a page has exactly one <main>
    html += device_block(0, html_headlines(comparison));
    for (std::size_t i = 0; i < others.size(); ++i)
        html += device_block(i + 1, html_headlines(others[i].comparison));
    html += "</div>" + html_comparer(comparison) + "</header>\n" +
            (is_page ? "<main>" : "<div class=\"main\">") + html_front(comparison, others) +
            (comparison.scene.is_seed ? to_html(seed_table(comparison), "seed") : "");
    const std::vector<std::string> sentences = list_findings(comparison);
    if (!sentences.empty())
        html += titled_section(findings_title(comparison), html_list(sentences));
    html += titled_section("Set-up, once",
                           "<p>" +
                               escape_html(describe_setup(measure::read_setup_facts(comparison))) +
                               "</p>") +
            to_html(rows_table(comparison), "all", &comparison) +
            to_html(plan_table(comparison), "plans", &comparison);
    for (const ReportPart& part : list_parts()) html += html_part(comparison, encoded, part);
    html += html_pictures(comparison, encoded) +
            to_html(unsupported_table(comparison.scene), "gaps") + html_circumstances(comparison);
    return html + (is_page ? "</main>\n" : "</div>\n");
}

std::string to_html(const Comparison& comparison, const EncodedPictures& encoded) {
    return html_page(comparison.scene.name, html_section(comparison, encoded));
}

} // namespace catoptric::report
