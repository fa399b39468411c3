#pragma once

#include "report.hpp"
#include "report/comparison.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace catoptric::report {

/// Columns of rows.csv.
enum class CsvColumns : std::uint8_t {
    table, ///< metrics of the report's table of rows, and fields that tell runs apart
    all,   ///< each metric over each mask, mirror, pass and round
};
/// Where the pictures of report.html are.
enum class PagePictures : std::uint8_t {
    automatic, ///< pictures are in the page up to kMaxInlinedBytes, else in files beside it
    inlined    ///< pictures are in the page, however large it becomes
};
/// Pages with more bytes of pictures load them from files, as they come into view.
inline constexpr std::size_t kMaxInlinedBytes = std::size_t{16} << 20;

/// Pictures of a comparison as PNG. Each is encoded once, however often the page is written.
struct EncodedPictures {
    struct RowPictures {
        int pictured = -1;    ///< Row::pictured at the time of encoding
        int noise_frames = 0; ///< ReferenceNoise::frames of the reference at that time
        std::string picture;  ///< picture as displayed
        /// Heat map of the row's FLIP error; empty if the row has no such picture.
        std::string error;
        std::string causes; ///< picture by cause; empty if causes are not known
        /// Picture of the row in the finished view with its largest error; empty if no view was
        /// drawn.
        std::string worst;
        std::optional<std::size_t> worst_view;
    };
    std::string reference; ///< empty if the reference was not rendered
    int noise_frames = 0;  ///< value of ReferenceNoise::frames when the reference was encoded
    std::vector<RowPictures> rows;
    /// Speed and instant of the largest lag of each row of LagResults whose pictures were written.
    std::vector<std::pair<double, double>> worst_lags;
    bool is_inlined = true; ///< whether the page holds the pictures, and not the names of files
};
/// Returns the file of a picture relative to the page, for html_figure; empty if the page
/// holds its pictures. `name`: of the file in the comparison's folder of pictures.
std::string picture_file(const Comparison& comparison, const EncodedPictures& pictures,
                         const std::string& name);

/// Encodes pictures that are new since the last call. Rows are added, show a later frame or get
/// causes, and their worst views may change. Writes the new pictures into the folder `images`,
/// unless it is empty.
void encode_pictures(EncodedPictures& pictures, const Comparison& comparison,
                     const std::filesystem::path& images = {});

std::string to_csv(const Comparison& comparison, CsvColumns which);
/// Returns rows.csv of several comparisons under one header.
std::string to_csv(const std::vector<const Comparison*>& comparisons, CsvColumns which);
/// Writes the results of the finished rows into a folder, which is made as create_folder does.
/// Files: report.json, report.md, report.html, rows.csv, images/<row>.png and .exr,
/// images/<row>-error.png and images/reference.png. The linear values for the page lie in
/// images/<row>.js, images/reference.js and images/mirrors.js, and its heat maps in
/// images/<row>-error.js. Rows with causes add images/causes-<row>.png, and drawn views add
/// images/worst-<row>.png. Rows with lag add images/lag-<row>-moving.exr and .js, the same of
/// -still and -reference, and images/lag-<row>-mirrors.js. `write` is called again as rows are
/// added. It replaces only pictures that changed and all other files, each as a whole.
class ReportWriter {
public:
    explicit ReportWriter(std::filesystem::path folder, CsvColumns csv = CsvColumns::table,
                          PagePictures page = PagePictures::automatic)
        : folder_(std::move(folder)), csv_(csv), page_(page) {}
    /// Writes the comparison. Rows that an earlier call wrote must be unchanged, unless they show
    /// another frame or the noise of the reference was reduced. Throws `cannot_create`, `io`.
    void write(const Comparison& comparison);

private:
    std::filesystem::path folder_;
    CsvColumns csv_;
    PagePictures page_;
    EncodedPictures pictures_;
};

struct ScenesReport {
    std::vector<std::string> asked; ///< scenes as the user named them
    std::vector<Comparison> list;   ///< finished comparisons, each with its own `images`
    /// Returns whether the list has a complete comparison of every requested scene.
    bool is_complete() const;
};
/// Returns JSON of schema "catoptric/compare-scenes/1": version, commit, command, complete, asked,
/// and in "scenes" the document of each scene.
std::string to_json(const ScenesReport& scenes);
std::string to_csv(const ScenesReport& scenes, CsvColumns which = CsvColumns::table);
std::string to_markdown(const ScenesReport& scenes);
/// Returns the page of all scenes. `sections` holds the html_section of each.
std::string to_html(const ScenesReport& scenes, const std::vector<std::string>& sections);
/// Returns the folder below images/ of the scene at `index`, from 0, such as "1-room/".
std::string images_folder(std::size_t index, const std::string& scene);
/// Returns a copy without pictures, because they take most of the memory.
Comparison without_pictures(const Comparison& comparison);

/// Writes several scenes one after the other as ReportWriter does, with pictures in
/// images/N-SCENE/.
class ScenesWriter {
public:
    ScenesWriter(std::filesystem::path folder, const std::vector<std::string>& scenes,
                 CsvColumns csv = CsvColumns::table, PagePictures page = PagePictures::automatic);
    /// Writes the scene at `index`, from 0. Scenes before it stay unchanged.
    void write_scene(std::size_t index, const Comparison& comparison);
    const ScenesReport& scene_reports() const { return scenes_; }

private:
    std::filesystem::path folder_;
    CsvColumns csv_;
    PagePictures page_;
    ScenesReport scenes_;
    std::vector<EncodedPictures> pictures_; ///< encoded pictures of each scene
    std::vector<std::string> sections_;     ///< html_section of each scene
};

/// Returns the files that a writer may put into its folder, relative to it, for rows with these
/// `Row::image`s. `folder` is Comparison::images.
std::vector<std::filesystem::path> list_files(const std::vector<std::string>& images,
                                              const std::string& folder = {});

} // namespace catoptric::report
