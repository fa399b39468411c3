#pragma once

#include "command_line.hpp"
#include "report/figures.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::cli {

/// Options of `compare` for figures of a paper.
struct FigureOptions {
    std::string folder;                         ///< empty: no figures
    std::optional<report::PixelRectangle> crop; ///< empty: where the rows differ most
    /// `images`: see measure::Comparison::images.
    std::filesystem::path scene_folder(const std::string& images) const {
        return std::filesystem::path(folder) / images;
    }
};

/// Adds --figures and --crop. `options` must outlive the parsing.
void add_figure_options(Verb& verb, FigureOptions& options);

/// Returns a converter that runs the program rsvg-convert; empty if PATH does not hold it.
report::DrawingConverter pdf_converter();

/// Throws `usage` for a crop without figures or outside a picture of this size, and
/// `cannot_create` if the folder cannot be made.
void check_figure_options(const FigureOptions& options, uvec2 size);

} // namespace catoptric::cli
