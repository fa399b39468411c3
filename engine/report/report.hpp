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

/// Returns rows.csv of several comparisons under one header.
std::string to_csv(const std::vector<const Comparison*>& comparisons, CsvColumns which);
/// Writes the results so far into a folder, which is made as create_folder does. Files:
/// report.json, report.md, report.html, rows.csv, images/<row>.png and .exr, images/<row>-error.png
/// and images/reference.png. Rows with causes add images/causes-<row>.png, and drawn views add
/// images/worst-<row>.png. `write` is called again as rows are added. It replaces only pictures
/// that changed and all other files, each as a whole.
class Writer {
public:
    explicit Writer(std::filesystem::path folder, CsvColumns csv = CsvColumns::table)
        : folder_(std::move(folder)), csv_(csv) {}
    /// Writes the comparison. Rows that an earlier call wrote must be unchanged. Throws
    /// `cannot_create`, `io`.
    void write(const Comparison& comparison);

private:
    friend class ScenesWriter;
    /// Encodes and writes the pictures that are new.
    void write_pictures(const Comparison& comparison);

    std::filesystem::path folder_;
    CsvColumns csv_;
    EncodedPictures pictures_;
    bool has_reference_ = false; ///< whether the reference's picture is written
    std::vector<int> written_;   ///< by row: Row::pictured of the pictures that are written
    std::set<std::size_t> rows_with_causes_;        ///< rows whose picture by cause is written
    std::vector<std::optional<std::size_t>> worst_; ///< by row: view whose picture is written
};

/// Data of one report on several scenes.
struct Scenes {
    std::vector<std::string> asked; ///< scenes as they were asked for
    std::vector<Comparison> list;   ///< comparisons so far, each with its own `images`
    /// Returns whether all scenes are there and complete.
    bool is_complete() const;
};
/// Returns JSON of schema "catoptric/compare-scenes/1": version, commit, command, complete, asked,
/// and in "scenes" the document of each scene.
std::string to_json(const Scenes& scenes);
std::string to_csv(const Scenes& scenes, CsvColumns which = CsvColumns::table);
std::string to_markdown(const Scenes& scenes);
/// Returns the page of all scenes. `sections` holds html_section of each.
std::string to_html(const Scenes& scenes, const std::vector<std::string>& sections);
/// Returns the folder below images/ of the scene at `index`, from 0, such as "1-room/".
std::string images_folder(std::size_t index, const std::string& scene);
/// Returns a copy without pictures, because they take most of the memory.
Comparison without_pictures(const Comparison& comparison);

/// Writes several scenes one after the other as Writer does, with pictures in images/N-SCENE/.
class ScenesWriter {
public:
    ScenesWriter(std::filesystem::path folder, const std::vector<std::string>& scenes,
                 CsvColumns csv = CsvColumns::table);
    /// Writes the scene at `index`, from 0. Scenes before it stay unchanged.
    void write(std::size_t index, const Comparison& comparison);
    const Scenes& scenes() const { return scenes_; }

private:
    struct Section {
        explicit Section(const std::filesystem::path& folder) : writer(folder) {}
        Writer writer; ///< writer of the scene's pictures
        std::string html;
    };
    std::filesystem::path folder_;
    CsvColumns csv_;
    Scenes scenes_;
    std::vector<Section> sections_;
};

/// Returns the files that a writer may put into its folder, relative to it, for rows with these
/// `Row::image`s. `folder` is Comparison::images.
std::vector<std::filesystem::path> files_of(const std::vector<std::string>& images,
                                            const std::string& folder = {});

} // namespace catoptric::report
