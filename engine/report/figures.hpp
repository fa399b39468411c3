#pragma once

#include "report/comparison.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

// Figures of a comparison for a paper or a talk.
namespace catoptric::report {

/// A rectangle of pixels; `corner` is its pixel at the top left.
struct PixelRectangle {
    ivec2 corner{0}, size{0};
};

/// Returns the square of an eighth of the picture's shorter side, at least 16 pixels, in which the
/// rows differ most: the sum over its pixels of the largest minus the smallest FLIP of a row is
/// largest. Empty if fewer than two rows have a picture.
std::optional<PixelRectangle> choose_crop(const Comparison& comparison);

/// Returns these pixels, each as `scale` x `scale` pixels. The rectangle must lie in the picture.
measure::Picture enlarge_pixels(const measure::Picture& picture, const PixelRectangle& part,
                                int scale);

/// Throws `usage` if the pixels do not lie in a picture of this size.
void check_crop(const PixelRectangle& crop, ivec2 size);

/// Returns the files that write_figures may write, relative to its folder. `images`: names of the
/// rows' pictures.
std::vector<std::filesystem::path> figure_files(const std::vector<std::string>& images);

/// Reads the drawing of the first file, an SVG, and writes it to the second file, a PDF.
using DrawingConverter =
    std::function<void(const std::filesystem::path& svg, const std::filesystem::path& pdf)>;

/// Writes figures.tex, plot.svg, passes.svg, causes.svg, reference.png and crop-ROW.png into an
/// existing folder, and a PDF of each SVG if there is a converter. Without one, removes the PDF
/// files of earlier figures. Figures without data are left out. figures.tex holds a LaTeX figure
/// with a caption for each, and a table of the rows. `crop`: pixels of the crops; empty: where rows
/// differ most. Throws as check_crop and as the converter do, and `io` if a file cannot be written.
void write_figures(const Comparison& comparison, const std::filesystem::path& folder,
                   std::optional<PixelRectangle> crop, const DrawingConverter& make_pdf = {});

} // namespace catoptric::report
