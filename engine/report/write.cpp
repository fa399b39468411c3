#include "core/error.hpp"
#include "core/file.hpp"
#include "measure/halves.hpp"
#include "measure/heat.hpp"
#include "measure/picture_file.hpp"
#include "measure/views.hpp"
#include "report/html.hpp"
#include "report/tables.hpp"
#include "report/text.hpp"
#include "report/writer.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <system_error>

#include <unistd.h>

namespace catoptric::report {

namespace fs = std::filesystem;

void create_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error); // an existing folder is no error
    std::error_code ignored;
    const bool is_file = fs::exists(folder, ignored) && !fs::is_directory(folder, ignored);
    check(!is_file, Failure::cannot_create, folder.string(),
          ": the folder cannot be created: wanted a folder or nothing, found a file");
    check(!error, Failure::cannot_create, folder.string(),
          ": the folder cannot be created: ", error.message());
    const bool writable = ::access(folder.c_str(), W_OK | X_OK) == 0;
    const int reason = errno; // saved before another call changes errno
    check(writable, Failure::cannot_create, folder.string(),
          ": files cannot be created there: ", std::generic_category().message(reason));
}

namespace {

/// Returns the folder of a comparison's pictures, which is made.
fs::path make_folder(const fs::path& folder, const Comparison& comparison) {
    fs::path images = folder / "images";
    if (!comparison.images.empty()) images /= comparison.images;
    create_folder(images);
    return images;
}

std::size_t count_picture_bytes(const EncodedPictures& pictures) {
    std::size_t bytes = pictures.reference.size();
    for (const EncodedPictures::RowPictures& row : pictures.rows)
        bytes += row.picture.size() + row.error.size() + row.causes.size() + row.worst.size();
    return bytes;
}

/// Writes the pictures of each row's largest lag that are new since the last call.
void write_lag_pictures(EncodedPictures& pictures, const Comparison& comparison,
                        const fs::path& images) {
    pictures.worst_lags.resize(comparison.lag->rows.size(), {NAN, NAN});
    for (std::size_t i = 0; i < comparison.lag->rows.size(); ++i) {
        const LagRow& row = comparison.lag->rows[i];
        const std::string name = find_lag_image(comparison, row);
        if (!row.worst || name.empty()) continue;
        const std::pair<double, double> place(row.worst->speed, row.worst->seconds);
        if (pictures.worst_lags[i] == place) continue;
        const std::array shown{&row.worst->moving, &row.worst->still, &row.worst->reference};
        for (std::size_t k = 0; k < shown.size(); ++k) {
            const std::string file = name + std::string(kLagPictureNames[k]);
            measure::write_exr(*shown[k], images / (file + ".exr"));
            write_file(images / (file + ".js"),
                       picture_script(*shown[k], image_path(comparison, file + ".js")));
        }
        const std::string mirrors = name + "-mirrors.js";
        write_file(images / mirrors,
                   mirror_script(row.worst->mirror_hits, image_path(comparison, mirrors)));
        pictures.worst_lags[i] = place;
    }
}

/// Writes the report on `shown`, one comparison or several scenes.
template <class Shown>
void write_texts(const fs::path& folder, const Shown& shown, CsvColumns csv,
                 const std::string& html) {
    write_file(folder / "rows.csv", report::to_csv(shown, csv));
    write_file(folder / "report.md", report::to_markdown(shown));
    write_file(folder / "report.html", html);
    // report.json is written last, so that all files that it names exist when a reader finds it.
    write_file(folder / "report.json", report::to_json(shown));
}

} // namespace

std::string picture_file(const Comparison& comparison, const EncodedPictures& pictures,
                         const std::string& name) {
    return pictures.is_inlined ? std::string() : image_path(comparison, name);
}

/// Encodes pictures of reports as PNG, and writes them and their values into a folder.
class PictureEncoder {
public:
    /// `images`: the folder; empty: nothing is written.
    PictureEncoder(const Comparison& comparison, const fs::path& images)
        : comparison_(comparison), images_(images) {}

    void encode(std::string& png, const measure::Picture& picture, const std::string& file) const {
        std::string bytes = picture.pixels.empty() ? "" : measure::encode_png(picture);
        if (!bytes.empty()) write(file, [&] { return bytes; });
        png = std::move(bytes); // after a failed write, the picture still counts as new
    }
    void write_values(const std::string& name, const measure::Picture& picture) const {
        if (!picture.pixels.empty())
            write(name + ".js", [&] { return picture_script(picture, path(name)); });
    }
    /// Writes the bytes of a PNG as a script.
    void write_script(const std::string& name, const std::string& png) const {
        write(name + ".js", [&] { return bytes_script(png, path(name)); });
    }
    void encode_row(EncodedPictures::RowPictures& encoded, const Row& row) const {
        if (!images_.empty() && !row.hdr.pixels.empty())
            measure::write_exr(row.hdr, images_ / (row.image + ".exr"));
        write_values(row.image, row.hdr);
        encode(encoded.picture, row.display, row.image + ".png");
        const bool has_map = !row.flip_map.empty();
        encode(encoded.error,
               has_map ? measure::make_heat_map(row.flip_map, row.display.width, row.display.height)
                       : measure::Picture(),
               row.image + "-error.png");
        if (has_map) write_script(row.image + "-error", encoded.error);
    }
    void encode_reference(std::string& png) const {
        write_values("reference", comparison_.reference_hdr);
        if (!comparison_.mirror_hits.empty())
            write("mirrors.js",
                  [&] { return mirror_script(comparison_.mirror_hits, path("mirrors")); });
        encode(png, comparison_.reference_display, "reference.png");
    }

private:
    std::string path(const std::string& name) const {
        return image_path(comparison_, name + ".js");
    }
    template <typename Text>
    void write(const std::string& file, Text&& text) const {
        if (!images_.empty()) write_file(images_ / file, text());
    }
    const Comparison& comparison_;
    const fs::path& images_;
};

void encode_pictures(EncodedPictures& pictures, const Comparison& comparison,
                     const fs::path& images) {
    const PictureEncoder encoder(comparison, images);
    const int noise_frames = comparison.noise
                                 ? comparison.noise->frames * std::max(comparison.noise->rays, 1)
                                 : 0;
    if (pictures.reference.empty() || pictures.noise_frames != noise_frames)
        encoder.encode_reference(pictures.reference);
    pictures.noise_frames = noise_frames;
    pictures.rows.resize(comparison.rows.size());
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        EncodedPictures::RowPictures& encoded = pictures.rows[i];
        if (encoded.pictured != row.pictured || encoded.noise_frames != noise_frames) {
            encoder.encode_row(encoded, row);
            encoded.pictured = row.pictured;
            encoded.noise_frames = noise_frames;
        }
        if (row.causes && encoded.causes.empty()) {
            const std::string name = "causes-" + row.image;
            encoder.encode(encoded.causes, cause_picture(row), name + ".png");
            encoder.write_script(name, encoded.causes);
        }
        if (row.worst && encoded.worst_view != row.worst->view) {
            encoder.encode(encoded.worst, row.worst->display, worst_view_image(row.image));
            encoded.worst_view = row.worst->view;
        }
    }
    if (!images.empty() && comparison.lag) write_lag_pictures(pictures, comparison, images);
}

void ReportWriter::write(const Comparison& comparison) {
    encode_pictures(pictures_, comparison, make_folder(folder_, comparison));
    pictures_.is_inlined = page_ == PagePictures::inlined ||
                           count_picture_bytes(pictures_) <= kMaxInlinedBytes;
    write_texts(folder_, comparison, csv_, to_html(comparison, pictures_));
}

std::vector<fs::path> list_files(const std::vector<std::string>& images,
                                 const std::string& folder) {
    const fs::path there = fs::path("images") / folder;
    std::vector<fs::path> files{
        "report.json",           "report.html",          "report.md",         "rows.csv",
        there / "reference.png", there / "reference.js", there / "mirrors.js"};
    for (const std::string& image : images) {
        for (const char* ending : {".exr", ".js", ".png", "-error.png", "-error.js"})
            files.push_back(there / (image + ending));
        for (const std::string& more :
             {"causes-" + image + ".png", "causes-" + image + ".js", worst_view_image(image)})
            files.push_back(there / more);
        const std::string lag = lag_image_name(image);
        for (const std::string_view name : kLagPictureNames)
            for (const char* ending : {".exr", ".js"})
                files.push_back(there / (lag + std::string(name) + ending));
        files.push_back(there / (lag + "-mirrors.js"));
    }
    return files;
}

ScenesWriter::ScenesWriter(fs::path folder, const std::vector<std::string>& scenes, CsvColumns csv,
                           PagePictures page)
    : folder_(std::move(folder)), csv_(csv), page_(page) {
    scenes_.asked = scenes;
}

void ScenesWriter::write_scene(std::size_t index, const Comparison& comparison) {
    if (scenes_.list.size() == index) {
        scenes_.list.emplace_back();
        pictures_.emplace_back();
        sections_.emplace_back();
    }
    encode_pictures(pictures_.at(index), comparison, make_folder(folder_, comparison));
    scenes_.list[index] = without_pictures(comparison);
    // The sections of earlier scenes are not written again. If their pictures were few, the
    // sections contain them.
    std::size_t bytes = 0;
    for (const EncodedPictures& pictures : pictures_) bytes += count_picture_bytes(pictures);
    pictures_[index].is_inlined = page_ == PagePictures::inlined || bytes <= kMaxInlinedBytes;
    sections_[index] = html_section(comparison, pictures_[index]);
    write_texts(folder_, scenes_, csv_, to_html(scenes_, sections_));
}

void write(const Comparison& comparison, const fs::path& folder) {
    ReportWriter(folder).write(comparison);
}

} // namespace catoptric::report
