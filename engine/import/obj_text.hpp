#pragma once

#include "import/files.hpp"
#include "scene/notes.hpp"
#include "scene/scene.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <tiny_obj_loader.h>

namespace catoptric::scene::obj {

/// A line with a statement or a `# catoptric` comment. The views are valid only during the call
/// that receives the line.
struct Line {
    std::string place() const { return *file + ":" + std::to_string(number); }

    const std::string* file;
    std::size_t number;       ///< from 1
    std::string_view keyword; ///< first word; "#word" for a `# catoptric word` comment
    std::string_view rest;    ///< the text after the keyword, trimmed
};

/// Calls `body` for each statement and each `# catoptric` comment. Empty lines and other comments
/// are skipped. A backslash at the end of a line joins it with the next line.
void for_each_line(const std::string& file, std::string_view text,
                   const std::function<void(const Line&)>& body);

/// Removes the first word from the front of `text` and returns it.
std::string_view take_word(std::string_view& text);

/// Returns the words of `line.rest` up to a comment, at most 4096 words.
std::vector<std::string_view> split_words(const Line& line);
/// Returns the number of words up to a comment.
std::size_t count_words(std::string_view text);

/// Parses a word as a finite number. Throws `bad_data` naming the line.
double parse_word(const Line& line, std::string_view word);

/// Parses the words [first, first + count) as finite numbers. Throws `bad_data` naming the line.
std::vector<double> parse_words(const Line& line, const std::vector<std::string_view>& words,
                                std::size_t first, std::size_t count);

/// Parses the first three words of `line.rest` as finite numbers. Throws `bad_data` naming the
/// line.
dvec3 parse_line_vector(const Line& line);

/// Counts the statements that are not read, by keyword.
class UnreadStatements {
public:
    void count(const Line& line);
    /// Adds a note for each keyword. Keywords after the first 40 share one note.
    void report(const std::string& file, LoaderNotes& notes) const;

private:
    struct KeywordCount {
        std::uint64_t lines = 0;
        std::size_t first = 0;
    };
    std::map<std::string, KeywordCount, std::less<>> counts_;
};

/// A texture map of a material.
struct TextureUse {
    std::string file, place;    ///< name in the library; "FILE:LINE" of the statement
    std::filesystem::path real; ///< real path; empty if the file does not exist
    /// Scale and offset of u and v, with v upwards.
    std::array<double, 2> scale{1, 1}, offset{0, 0};
    bool is_clamped = false;
};

/// A material as its library defines it.
struct MtlMaterial {
    std::string name, place;
    std::optional<dvec3> diffuse, specular;
    vec3 emission{0};
    std::optional<double> shininess, ior, roughness, metallic, kind, alpha, transparency, clearcoat,
        clearcoat_roughness;
    std::optional<TextureUse> colour, cut, normals; ///< map_Kd, map_d and norm
    bool two_sided = false, fixed_normals = false;  ///< set by `# catoptric` comments
};

/// The materials of all libraries of a file.
struct MtlLibrary {
    std::vector<MtlMaterial> drafts;
};

/// The inputs and lists that readers use besides the text.
struct ReadContext {
    FileOpener& files;
    LoadAccount& account;
    LoaderNotes& notes;
    std::vector<UnsupportedFeature>& unsupported;
};

/// Reads one .mtl file and appends its materials to `library`. Throws `bad_data`, `missing_input`
/// or `io`.
void read_library(const std::filesystem::path& real, const std::string& place, ReadContext& context,
                  MtlLibrary& library);
/// Builds the materials in file order, as docs/your-scenes.md describes them, and reads their
/// images. Throws `bad_data` for an image that cannot be decoded.
std::vector<Material> make_materials(const MtlLibrary& library, ReadContext& context);

/// The contents of the `# catoptric` comments, by object name:
///   # catoptric camera NAME ex ey ez tx ty tz ux uy uz fov [HEIGHT]
///       (HEIGHT: that of an orthographic picture, in world units)
///   # catoptric motion OBJECT harmonic ax ay az period
///   # catoptric motion OBJECT step|linear|cubic N, then N times: t x y z
///       (cubic: t, in-tangent, value, out-tangent)
///   # catoptric sphere OBJECT cx cy cz r
///   # catoptric hidden OBJECT            (camera rays pass through it)
///   # catoptric exposure STOPS           (of the scene)
struct CatoptricComments {
    std::optional<double> exposure;
    std::vector<Camera> cameras;
    std::map<std::string, Motion> motions;
    std::map<std::string, Sphere> spheres;
    std::map<std::string, bool> hidden;
    /// For each object name, the first line with the name.
    std::map<std::string, std::string> named_at;
};

/// Throws `bad_data`, naming the line, for an invalid comment.
void add_comment(CatoptricComments& comments, const Line& line, LoadAccount& account);

/// A corner of a face, as indices from 0.
struct Corner {
    std::uint32_t position;
    std::uint32_t normal; ///< `kNoIndex` if absent
    std::uint32_t uv;     ///< `kNoIndex` if absent
};
inline constexpr std::uint32_t kNoIndex = ~0u;

/// An .obj file, rewritten for tinyobjloader.
struct RewrittenText {
    /// Holds only `mtllib`, `o NUMBER`, `usemtl`, and triangles `f` with valid indices.
    std::string statements = "mtllib all\no 0\n";
    std::vector<std::string> names{1};     ///< names of shapes, by the number of `o`
    std::vector<dvec3> positions, normals; ///< doubles, since tinyobjloader rounds to floats
    std::vector<vec3> colours;             ///< one per position, or empty
    std::vector<vec2> uv;                  ///< texture coordinates, with v upwards
    MtlLibrary library;
    CatoptricComments remarks;
};

/// Reads an .obj file and its material libraries. Throws `bad_data` with file and line.
RewrittenText read_obj_text(const std::string& file, ReadContext& context);

/// Cuts a polygon into triangles and appends their corners. A convex quad is cut along its shorter
/// diagonal, any other convex polygon into a fan, and a concave polygon by clipping ears. There are
/// at most corners - 2 triangles. The work may grow with the cube of the corners; `comparisons`
/// counts it. Throws `bad_data` naming the line if the count exceeds the budget.
void triangulate(std::span<const Corner> polygon, const std::vector<dvec3>& positions,
                 LimitedSum& comparisons, const Line& line, std::vector<Corner>& triangles);

} // namespace catoptric::scene::obj
