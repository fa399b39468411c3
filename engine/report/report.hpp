#pragma once

#include "report/comparison.hpp"
#include "report/encoded.hpp"
#include "report/write.hpp"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace catoptric::report {

/// The same of several, under one header.
std::string to_csv(const std::vector<const Comparison*>& comparisons, CsvColumns which);
/// Puts what there is into a folder, made as create_folder does: report.json, report.md,
/// report.html, rows.csv, images/<row>.png and .exr, images/<row>-error.png and
/// images/reference.png; of rows with causes images/causes-<row>.png, with drawn views
/// images/worst-<row>.png. Written again and again as rows are added: pictures only where they are
/// others than before, all else anew, every file put into place whole.
class Writer {
public:
    explicit Writer(std::filesystem::path folder, CsvColumns csv = CsvColumns::table)
        : folder_(std::move(folder)), csv_(csv) {}
    /// Rows that were there the last time are the same now. Throws `cannot_create`, `io`.
    void write(const Comparison& comparison);

private:
    friend class ScenesWriter;
    /// Those that are new, encoded and put into their folder.
    void write_pictures(const Comparison& comparison);

    std::filesystem::path folder_;
    CsvColumns csv_;
    EncodedPictures pictures_;
    bool has_reference_ = false; ///< its picture is there
    std::vector<int> written_;   ///< by row: Row::pictured of the pictures that are there
    std::set<std::size_t> rows_with_causes_;        ///< whose picture by cause is there
    std::vector<std::optional<std::size_t>> worst_; ///< by row: view whose picture is there
};

/// One report of several scenes.
struct Scenes {
    std::vector<std::string> asked; ///< as they were asked for
    std::vector<Comparison> list;   ///< so far; each with an `images` of its own
    /// Whether all are there and complete.
    bool is_complete() const;
};
/// "catoptric/compare-scenes/1": version, commit, command, complete, asked, and in "scenes" the
/// document of each.
std::string to_json(const Scenes& scenes);
std::string to_csv(const Scenes& scenes, CsvColumns which = CsvColumns::table);
std::string to_markdown(const Scenes& scenes);
/// `sections`: html_section of each.
std::string to_html(const Scenes& scenes, const std::vector<std::string>& sections);
/// Folder below images/ of the scene asked for at `index`, from 0: "1-room/".
std::string images_folder(std::size_t index, const std::string& scene);
/// All but the pictures, which take most of the memory.
Comparison without_pictures(const Comparison& comparison);

/// As Writer, of several scenes one after the other: pictures in images/N-SCENE/.
class ScenesWriter {
public:
    ScenesWriter(std::filesystem::path folder, const std::vector<std::string>& scenes,
                 CsvColumns csv = CsvColumns::table);
    /// `index`: of the scene, from 0; those before it stay as they were.
    void write(std::size_t index, const Comparison& comparison);
    const Scenes& scenes() const { return scenes_; }

private:
    struct Section {
        explicit Section(const std::filesystem::path& folder) : writer(folder) {}
        Writer writer; ///< of its pictures
        std::string html;
    };
    std::filesystem::path folder_;
    CsvColumns csv_;
    Scenes scenes_;
    std::vector<Section> sections_;
};

/// The files that a writer of rows with these `Row::image`s may put into its folder, relative to
/// it; `folder`: Comparison::images.
std::vector<std::filesystem::path> files_of(const std::vector<std::string>& images,
                                            const std::string& folder = {});

} // namespace catoptric::report
