#include "figure_options.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/text.hpp"
#include "external_program.hpp"
#include "output.hpp"
#include "parse.hpp"

#include <array>
#include <sstream>

namespace catoptric::cli {

namespace {

constexpr std::int64_t kMaxCropCoordinate = 1 << 20; ///< far above any picture's size

report::PixelRectangle parse_crop(const std::string& text) {
    std::array<int, 4> numbers{};
    std::istringstream words(text);
    std::size_t count = 0;
    for (std::string word; std::getline(words, word, ','); ++count)
        if (count < numbers.size())
            numbers[count] = static_cast<int>(
                parse_integer("--crop", word, count < 2 ? 0 : 1, kMaxCropCoordinate));
    check(count == numbers.size() && !text.ends_with(','), Failure::usage,
          "--crop: wanted X,Y,WIDTH,HEIGHT in pixels, found ", quote(text));
    return {{numbers[0], numbers[1]}, {numbers[2], numbers[3]}};
}

} // namespace

void add_figure_options(Verb& verb, FigureOptions& options) {
    verb.option(
        "--figures", "DIR",
        "folder for figures of a paper: plots as SVG and, with rsvg-convert, as PDF; enlarged crops; and "
        "a LaTeX file with captions and a table",
        options.folder);
    verb.option("--crop", "X,Y,W,H",
                "pixels that --figures enlarges; X,Y is their corner at the top left (where rows "
                "differ most)",
                [&options](const std::string& text) { options.crop = parse_crop(text); });
}

report::DrawingConverter pdf_converter() {
    const std::string program = find_program("rsvg-convert");
    if (program.empty()) return {};
    return [program](const std::filesystem::path& svg, const std::filesystem::path& pdf) {
        PartialFile partial(pdf);
        run_external({program, "-f", "pdf", "-o",
                      std::filesystem::absolute(partial.temporary()).string(),
                      std::filesystem::absolute(svg).string()},
                     pdf.string());
        partial.copy_mode();
        partial.commit();
    };
}

void check_figure_options(const FigureOptions& options, uvec2 size) {
    check(!options.crop || !options.folder.empty(), Failure::usage,
          "--crop: wanted --figures with it, found none");
    if (!options.folder.empty()) check_output_folder(options.folder);
    if (options.crop) report::check_crop(*options.crop, ivec2(size));
}

} // namespace catoptric::cli
