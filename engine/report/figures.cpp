#include "report/figures.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "measure/causes.hpp"
#include "measure/picture.hpp"
#include "measure/rows.hpp"
#include "report/pass_times.hpp"
#include "report/plot.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace catoptric::report {

namespace {

namespace fs = std::filesystem;

constexpr int kMinCropSide = 16;
constexpr int kEnlargedCropSide = 512; ///< crops are enlarged to at most so many pixels a side

/// Colours of the page's light theme, which an SVG outside the page lacks.
constexpr std::string_view kFigureStyle =
    "<style>text{font:11px sans-serif;fill:#333}.label{fill:#111;stroke:#fff;stroke-width:3;"
    "stroke-linejoin:round;paint-order:stroke}.grid{stroke:#ddd}.lane{fill:#f2f2f2}"
    ".curve{fill:none;stroke:#888}.step{fill:none;stroke:#0b62a8;stroke-width:1.5;"
    "stroke-dasharray:5 4}.noise{fill:none;stroke:#888;stroke-dasharray:2 4}"
    ".interval{fill:none;stroke:#888;stroke-width:1.5}.mark{fill:#fff;stroke:#888;"
    "stroke-width:1.5}.mark.hidden{fill-opacity:.25}.mark.front{fill:#0b62a8;stroke:#0b62a8}"
    "</style><rect width=\"100%\" height=\"100%\" style=\"fill:#fff\"/>";

/// Returns an SVG for a file of its own. `svg` is one to embed in a page.
std::string standalone_svg(const std::string& svg) {
    const std::size_t end = svg.find('>');
    return "<svg xmlns=\"http://www.w3.org/2000/svg\"" + svg.substr(4, end + 1 - 4) +
           std::string(kFigureStyle) + svg.substr(end + 1) + "\n";
}

std::string escape_latex(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        if (c == '\\')
            escaped += "\\textbackslash{}";
        else if (c == '~' || c == '^')
            escaped += std::string("\\") + c + "{}";
        else if (std::string_view("{}$&#_%").find(c) != std::string_view::npos)
            escaped += std::string("\\") + c;
        else
            escaped += c;
    }
    return escaped;
}

std::string latex_figure(const std::string& name, const std::string& content,
                         const std::string& caption) {
    return "\\begin{figure}\n\\centering\n" + content + "\\caption{" + caption +
           "}\n\\label{fig:" + name + "}\n\\end{figure}\n\n";
}

std::string latex_picture(const std::string& file, double width) {
    return fmt::format("\\includegraphics[width={:.3g}\\linewidth]{{{}}}\n", width, file);
}

/// Says what all figures show, for their captions.
std::string describe_pictures(const Comparison& comparison) {
    return fmt::format("scene {}, {}$\\times${} pixels, {}", escape_latex(comparison.scene.name),
                       comparison.width, comparison.height, escape_latex(comparison.device.name));
}

std::string latex_table(const Comparison& comparison) {
    std::string text = "\\begin{table}\n\\centering\n\\begin{tabular}{lrrrr}\n\\toprule\n"
                       "row & ms & 95\\,\\% & FLIP & rmse \\\\\n\\midrule\n";
    for (const Row& row : comparison.rows) {
        const measure::SampleSummary& time = row.time_ms();
        text += fmt::format(
            "{} & {} & {} & {} & {} \\\\\n", escape_latex(row.label),
            escape_latex(format_ms(time.median)),
            time.ci95.is_known() ? format_ms(time.ci95.low) + "--" + format_ms(time.ci95.high) : "",
            escape_latex(format_flip(row.error)), escape_latex(format_error(row.error.rmse)));
    }
    return text +
           "\\bottomrule\n\\end{tabular}\n\\caption{Median time of a frame with its 95\\,\\% "
           "interval, and errors over the mirrors against " +
           escape_latex(comparison.reference_label) + "; " + describe_pictures(comparison) +
           ".}\n\\label{tab:rows}\n\\end{table}\n";
}

StackedBars cause_bars(const Comparison& comparison) {
    StackedBars chart{.x_name = "Share of the row's squared error over the mirrors, %",
                      .says = "Bars of each row's error by cause"};
    for (const CauseColour& cause : cause_colours()) {
        const vec3 bytes = glm::round(255.0F * cause.colour);
        const bool is_white = cause.colour == vec3(1); // as the paper
        chart.kinds.push_back(
            {std::string(cause.cause),
             is_white ? "#444"
                      : fmt::format("rgb({:.0f},{:.0f},{:.0f})", bytes.x, bytes.y, bytes.z)});
    }
    for (const Row& row : comparison.rows) {
        if (!row.causes) continue;
        StackedBar& bar = chart.bars.emplace_back();
        bar.label = row.label;
        for (const BarPartKind& kind : chart.kinds) {
            const auto cause = std::ranges::find(row.causes->list, kind.name, &CauseShare::name);
            bar.lengths.push_back(cause != row.causes->list.end() ? 100 * cause->share : 0);
        }
    }
    return chart;
}

/// Writes the drawing and returns its LaTeX figure, or does nothing if there is no drawing.
std::string write_drawing(const std::string& svg, const fs::path& folder, const std::string& name,
                          const std::string& caption, const DrawingConverter& make_pdf) {
    if (svg.empty()) return "";
    write_file(folder / (name + ".svg"), standalone_svg(svg));
    if (make_pdf)
        make_pdf(folder / (name + ".svg"), folder / (name + ".pdf"));
    else
        fs::remove(folder /
                   (name + ".pdf")); // figures.tex would show the drawing of an earlier run
    return latex_figure(name, latex_picture(name + ".pdf", 1), caption);
}

/// Draws a frame around the pixels, one pixel wide, in a colour that differs from the pixels below.
void draw_pixel_frame(measure::Picture& picture, const PixelRectangle& part) {
    const ivec2 low = part.corner - 1, high = part.corner + part.size;
    for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
            const bool is_edge = x == low.x || x == high.x || y == low.y || y == high.y;
            if (!is_edge || x < 0 || y < 0 || x >= picture.width || y >= picture.height) continue;
            vec3& pixel = picture.at(x, y);
            pixel = vec3(pixel.x + pixel.y + pixel.z > 1.5F ? 0.0F : 1.0F);
        }
}

/// Writes the crops of the reference and of each row. Returns their LaTeX figure.
std::string write_crops(const Comparison& comparison, const fs::path& folder,
                        const PixelRectangle& crop) {
    const int scale = std::max(kEnlargedCropSide / std::max(crop.size.x, crop.size.y), 1);
    std::vector<std::pair<std::string, std::string>> crops; // name of the file, label
    const auto write = [&](const measure::Picture& picture, const std::string& name,
                           const std::string& label) {
        if (picture.pixels.empty()) return;
        measure::write_png(enlarge_pixels(picture, crop, scale),
                           folder / ("crop-" + name + ".png"));
        crops.emplace_back("crop-" + name + ".png", label);
    };
    measure::Picture whole = comparison.reference_display;
    write(whole, "reference", "reference");
    for (const Row& row : comparison.rows) write(row.display, row.image, row.label);
    draw_pixel_frame(whole, crop);
    measure::write_png(whole, folder / "reference.png");
    std::string tex = latex_picture("reference.png", .5) + "\n";
    for (const auto& [file, label] : crops)
        tex += "\\begin{minipage}[t]{.19\\linewidth}\\centering\n" + latex_picture(file, 1) +
               "{\\tiny " + escape_latex(label) + "}\\end{minipage}\n";
    return latex_figure(
        "crops", tex,
        fmt::format(
            "Reference ({}) and its pixels from ({}, {}) to ({}, {}), enlarged {} times; {}.",
            escape_latex(comparison.reference_label), crop.corner.x, crop.corner.y,
            crop.corner.x + crop.size.x - 1, crop.corner.y + crop.size.y - 1, scale,
            describe_pictures(comparison)));
}

} // namespace

std::optional<PixelRectangle> choose_crop(const Comparison& comparison) {
    const int width = comparison.width, height = comparison.height;
    const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    std::vector<const std::vector<float>*> maps;
    for (const Row& row : comparison.rows)
        if (row.flip_map.size() == count) maps.push_back(&row.flip_map);
    if (maps.size() < 2) return std::nullopt;
    // Sums over all pixels above and to the left, with a row and a column of zeros.
    const auto stride = static_cast<std::size_t>(width) + 1;
    std::vector<double> sums(stride * (static_cast<std::size_t>(height) + 1));
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        for (std::size_t x = 0; x + 1 < stride; ++x) {
            float low = 1, high = 0;
            for (const std::vector<float>* map : maps) {
                const float flip = (*map)[y * (stride - 1) + x];
                low = std::min(low, flip), high = std::max(high, flip);
            }
            sums[(y + 1) * stride + x + 1] = std::max(high - low, 0.0F) + sums[y * stride + x + 1] +
                                             sums[(y + 1) * stride + x] - sums[y * stride + x];
        }
    const int shorter = std::min(width, height);
    const int side = std::min(std::max(shorter / 8, kMinCropSide), shorter);
    PixelRectangle best{{0, 0}, {side, side}};
    double most = -1;
    for (int y = 0; y + side <= height; ++y)
        for (int x = 0; x + side <= width; ++x) {
            const auto at = [&](int column, int line) {
                return sums[static_cast<std::size_t>(line) * stride +
                            static_cast<std::size_t>(column)];
            };
            const double sum = at(x + side, y + side) - at(x, y + side) - at(x + side, y) +
                               at(x, y);
            if (sum > most) most = sum, best.corner = {x, y};
        }
    return best;
}

void check_crop(const PixelRectangle& crop, ivec2 size) {
    const ivec2 corner = crop.corner, extent = crop.size;
    check(corner.x >= 0 && corner.y >= 0 && extent.x > 0 && extent.y > 0 &&
              extent.x <= size.x - corner.x && extent.y <= size.y - corner.y,
          Failure::usage, "--crop: wanted pixels of a picture of ", size.x, "x", size.y, ", found ",
          corner.x, ",", corner.y, ",", extent.x, ",", extent.y);
}

std::vector<fs::path> figure_files(const std::vector<std::string>& images) {
    std::vector<fs::path> files{"figures.tex", "reference.png", "crop-reference.png"};
    for (const char* drawing : {"plot", "passes", "causes"})
        for (const char* kind : {".svg", ".pdf"}) files.emplace_back(std::string(drawing) + kind);
    for (const std::string& image : images) files.emplace_back("crop-" + image + ".png");
    return files;
}

measure::Picture enlarge_pixels(const measure::Picture& picture, const PixelRectangle& part,
                                int scale) {
    measure::Picture large(part.size.x * scale, part.size.y * scale);
    for (int y = 0; y < large.height; ++y)
        for (int x = 0; x < large.width; ++x)
            large.at(x, y) = picture.at(part.corner.x + x / scale, part.corner.y + y / scale);
    return large;
}

void write_figures(const Comparison& comparison, const fs::path& folder,
                   std::optional<PixelRectangle> crop, const DrawingConverter& make_pdf) {
    if (crop)
        check_crop(*crop, {comparison.width, comparison.height});
    else
        crop = choose_crop(comparison);
    const std::string shown = describe_pictures(comparison);
    std::string tex = "% Figures of catoptric compare. Needs the packages graphicx and booktabs.\n";
    if (!make_pdf)
        tex += "% Drawings as PDF: for f in *.svg; do rsvg-convert -f pdf -o \"${f%.svg}.pdf\" "
               "\"$f\"; done\n";
    tex += "\n";
    tex += write_drawing(
        comparison_plot(comparison), folder, "plot",
        "Median time of a frame against FLIP over the mirrors; " + shown +
            ". Filled: no row beats it. Dashed: the least FLIP of a mark up to each time. Horizontal lines: 95\\,\\% intervals.",
        make_pdf);
    tex += write_drawing(draw_bars(pass_time_bars(comparison)), folder, "passes",
                         "Median time of the passes of a frame; " + shown + ".", make_pdf);
    tex += write_drawing(draw_bars(cause_bars(comparison)), folder, "causes",
                         "Squared error over the mirrors by cause. Negative shares are left "
                         "out; " +
                             shown + ".",
                         make_pdf);
    if (crop && !comparison.reference_display.pixels.empty())
        tex += write_crops(comparison, folder, *crop);
    // Written last, so that all files it names exist when a reader sees it.
    write_file(folder / "figures.tex", tex + latex_table(comparison));
}

} // namespace catoptric::report
