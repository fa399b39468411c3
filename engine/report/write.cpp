#include "core/error.hpp"
#include "core/file.hpp"
#include "measure/heat.hpp"
#include "measure/picture_file.hpp"
#include "report/report.hpp"

#include <system_error>

namespace catoptric::report {

namespace fs = std::filesystem;

namespace {

void write_pictures(const Comparison& comparison, const fs::path& images) {
    if (!comparison.reference_display.pixels.empty())
        measure::write_png(comparison.reference_display, images / "reference.png");
    for (const Row& row : comparison.rows) {
        if (row.hdr.pixels.empty()) continue;
        measure::write_exr(row.hdr, images / (row.image + ".exr"));
        measure::write_png(row.display, images / (row.image + ".png"));
        measure::write_png(measure::heat(row.flip_map, row.display.width, row.display.height),
                           images / (row.image + "-error.png"));
    }
}

} // namespace

void create_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error); // what is there already is no error
    check(!error, Failure::cannot_create, folder.string(),
          ": the folder cannot be created: ", error.message());
}

void write(const Comparison& comparison, const fs::path& folder) {
    create_folder(folder / "images");
    write_pictures(comparison, folder / "images");
    write_file(folder / "rows.csv", to_csv(comparison));
    write_file(folder / "report.md", to_markdown(comparison));
    write_file(folder / "report.html", to_html(comparison));
    // Last: who sees it sees the files that it names.
    write_file(folder / "report.json", to_json(comparison));
}

} // namespace catoptric::report
