#pragma once

#include "scene/files.hpp"
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

/// A line that says something. The views end with the call that gets it.
struct Line {
    std::string where() const { return *file + ":" + std::to_string(number); }

    const std::string* file;
    std::size_t number;
    std::string_view keyword; ///< first word; "#word" for a `# catoptric word` comment
    std::string_view rest;    ///< everything after it, trimmed
};

/// Calls `body` for each line that is neither empty nor another comment; a backslash at the end of
/// a line joins it with the next.
void for_each_line(const std::string& file, std::string_view text,
                   const std::function<void(const Line&)>& body);

/// Takes the first word off the front of `text`.
std::string_view take_word(std::string_view& text);

/// The words of `line.rest` up to a comment, at most 4096 of them.
std::vector<std::string_view> words(const Line& line);
/// How many words there are up to a comment.
std::size_t count_words(std::string_view text);

/// The finite number that a word is. Throws `bad_data` naming the line.
double number_of(const Line& line, std::string_view word);

/// Words [first, first + count) as finite numbers. Throws `bad_data` naming the line.
std::vector<double> numbers(const Line& line, const std::vector<std::string_view>& words,
                            std::size_t first, std::size_t count);

/// The first three words as finite numbers. Throws as `numbers`.
dvec3 vector_of(const Line& line);

/// Statements that are not read, counted by keyword.
class Unread {
public:
    void add(const Line& line);
    /// As notes; what comes after 40 keywords together.
    void tell(const std::string& file, Notes& notes) const;

private:
    struct Count {
        std::uint64_t lines = 0;
        std::size_t first = 0;
    };
    std::map<std::string, Count, std::less<>> counts_;
};

/// A map of a material: `file` as it is called, and where it lies; empty: it is not there.
struct MapUse {
    std::string file, place;
    std::filesystem::path real;
    std::array<double, 2> scale{1, 1}, offset{0, 0}; ///< v upwards
    bool is_clamped = false;
};

/// What a library says of a material.
struct Draft {
    std::string name, place;
    std::optional<dvec3> diffuse, specular;
    vec3 emission{0};
    std::optional<double> shininess, ior, roughness, metallic, kind, alpha;
    std::optional<MapUse> colour, cut;
    bool two_sided = false, fixed_normals = false; ///< `# catoptric` comments
};

/// Material libraries, all in one.
struct Library {
    std::vector<Draft> drafts;
};

/// What reading needs beside the text.
struct Context {
    Files& files;
    Account& account;
    Notes& notes;
    std::vector<UnsupportedFeature>& unsupported;
};

/// Adds what one .mtl file says of materials.
void read_materials(const std::filesystem::path& real, const std::string& place, Context& context,
                    Library& library);
/// In file order, as scene.md has them; their pictures are read. Throws `bad_data` for one that
/// cannot be decoded.
std::vector<Material> materials_of(const Library& library, Context& context);

/// What the `# catoptric` comments say about objects, by name:
///   # catoptric camera NAME ex ey ez tx ty tz ux uy uz fov
///   # catoptric motion OBJECT harmonic ax ay az period
///   # catoptric motion OBJECT step|linear|cubic N, then N times: t x y z
///       (cubic: t, in-tangent, value, out-tangent)
///   # catoptric sphere OBJECT cx cy cz r
///   # catoptric hidden OBJECT            (camera rays pass through it)
///   # catoptric exposure STOPS           (of the scene)
struct Remarks {
    std::optional<double> exposure;
    std::vector<Camera> cameras;
    std::map<std::string, Motion> motions;
    std::map<std::string, Sphere> spheres;
    std::map<std::string, bool> hidden;
    std::map<std::string, std::string> named_at; ///< each object named, and the line that does
};

/// Adds one comment line. Throws `bad_data` naming it for one that cannot be understood.
void add_remark(Remarks& remarks, const Line& line, Account& account);

/// A corner of a face: numbers from 0.
struct Corner {
    std::uint32_t position;
    std::uint32_t normal; ///< `kNone`: none
    std::uint32_t uv;     ///< `kNone`: none
};
inline constexpr std::uint32_t kNone = ~0u;

/// An .obj file for tinyobjloader.
struct Text {
    /// Nothing but `o NUMBER`, `usemtl NUMBER`, and triangles `f` with indices that exist.
    std::string statements = "mtllib all\no 0\n";
    std::vector<std::string> names{1};     ///< of shapes; the first has none
    std::vector<dvec3> positions, normals; ///< exact; tinyobjloader's are floats
    std::vector<vec3> colours;             ///< of positions, or none
    std::vector<vec2> uv;                  ///< v upwards
    Library library;
    Remarks remarks;
};

/// Throws `bad_data` with file and line.
Text read_text(const std::string& file, Context& context);

/// Cuts a polygon into triangles and appends their corners: a convex quad along its shorter
/// diagonal, other convex ones into a fan, concave ones by their ears. At most corners - 2.
/// `comparisons` counts the work, which may grow with the cube of the corners; it throws `bad_data`
/// naming the line over the budget.
void cut(std::span<const Corner> polygon, const std::vector<dvec3>& positions, Total& comparisons,
         const Line& line, std::vector<Corner>& triangles);

} // namespace catoptric::scene::obj
