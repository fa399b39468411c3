#include "core/error.hpp"
#include "core/file.hpp"
#include "measure/picture_file.hpp"
#include "report/encoded.hpp"
#include "report/report.hpp"
#include "report/views.hpp"

#include <cerrno>
#include <system_error>

#include <unistd.h>

namespace catoptric::report {

namespace fs = std::filesystem;

void create_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error); // an existing folder is no error
    const bool is_file = fs::exists(folder) && !fs::is_directory(folder);
    check(!is_file, Failure::cannot_create, folder.string(),
          ": the folder cannot be created: wanted a folder or nothing, found a file");
    check(!error, Failure::cannot_create, folder.string(),
          ": the folder cannot be created: ", error.message());
    const bool writable = ::access(folder.c_str(), W_OK | X_OK) == 0;
    const int reason = errno; // saved before another call changes errno
    check(writable, Failure::cannot_create, folder.string(),
          ": files cannot be created there: ", std::generic_category().message(reason));
}

void Writer::write_pictures(const Comparison& comparison) {
    fs::path images = folder_ / "images";
    if (!comparison.images.empty()) images /= comparison.images;
    create_folder(images);
    encode_new(pictures_, comparison);
    if (!has_reference_ && !pictures_.reference.empty()) {
        write_file(images / "reference.png", pictures_.reference);
        has_reference_ = true;
    }
    written_.resize(comparison.rows.size(), -1);
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        const Row& row = comparison.rows[i];
        if (row.hdr.pixels.empty() || written_[i] == row.pictured) continue;
        measure::write_exr(row.hdr, images / (row.image + ".exr"));
        write_file(images / (row.image + ".png"), pictures_.rows[i].picture);
        write_file(images / (row.image + "-error.png"), pictures_.rows[i].error);
        written_[i] = row.pictured;
    }
    worst_.resize(comparison.rows.size());
    for (std::size_t i = 0; i < worst_.size(); ++i) {
        const EncodedPictures::OfRow& encoded = pictures_.rows[i];
        if (worst_[i] == encoded.worst_view) continue;
        write_file(images / worst_image(comparison.rows[i].image), encoded.worst);
        worst_[i] = encoded.worst_view;
    }
    for (std::size_t i = 0; i < comparison.rows.size(); ++i) {
        if (pictures_.rows[i].causes.empty() || rows_with_causes_.contains(i)) continue;
        write_file(images / ("causes-" + comparison.rows[i].image + ".png"),
                   pictures_.rows[i].causes);
        rows_with_causes_.insert(i);
    }
}

void Writer::write(const Comparison& comparison) {
    write_pictures(comparison);
    write_file(folder_ / "rows.csv", to_csv(comparison, csv_));
    write_file(folder_ / "report.md", to_markdown(comparison));
    write_file(folder_ / "report.html", to_html(comparison, pictures_));
    // Written last, so that all files it names exist when a reader sees it.
    write_file(folder_ / "report.json", to_json(comparison));
}

std::vector<fs::path> files_of(const std::vector<std::string>& images, const std::string& folder) {
    const fs::path there = fs::path("images") / folder;
    std::vector<fs::path> files{"report.json", "report.html", "report.md", "rows.csv",
                                there / "reference.png"};
    for (const std::string& image : images) {
        for (const char* ending : {".exr", ".png", "-error.png"})
            files.push_back(there / (image + ending));
        for (const std::string& more : {"causes-" + image + ".png", worst_image(image)})
            files.push_back(there / more);
    }
    return files;
}

ScenesWriter::ScenesWriter(fs::path folder, const std::vector<std::string>& scenes, CsvColumns csv)
    : folder_(std::move(folder)), csv_(csv) {
    scenes_.asked = scenes;
}

void ScenesWriter::write(std::size_t index, const Comparison& comparison) {
    if (sections_.size() == index) sections_.emplace_back(folder_);
    if (scenes_.list.size() == index) scenes_.list.emplace_back();
    Section& section = sections_.at(index);
    section.writer.write_pictures(comparison);
    section.html = html_section(comparison, section.writer.pictures_);
    scenes_.list.at(index) = without_pictures(comparison);
    std::vector<std::string> pages;
    for (const Section& one : sections_) pages.push_back(one.html);
    write_file(folder_ / "rows.csv", to_csv(scenes_, csv_));
    write_file(folder_ / "report.md", to_markdown(scenes_));
    write_file(folder_ / "report.html", to_html(scenes_, pages));
    write_file(folder_ / "report.json", to_json(scenes_));
}

void write(const Comparison& comparison, const fs::path& folder, CsvColumns csv) {
    Writer(folder, csv).write(comparison);
}

} // namespace catoptric::report
