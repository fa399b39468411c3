#pragma once

#include "scene/scene.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace catoptric::scene::obj {

/// A line that says something. The views end with the call that gets it.
struct Line {
    std::string where;        ///< "file:number", for messages
    std::string_view keyword; ///< first word; "#word" for a `# catoptric word` comment
    std::string_view rest;    ///< everything after it, trimmed
};

/// Calls `body` for each line that is neither empty nor another comment; a backslash at the end of
/// a line joins it with the next.
void for_each_line(const std::string& file, std::string_view text,
                   const std::function<void(const Line&)>& body);

/// The words of `line.rest`, up to a comment.
std::vector<std::string_view> words(const Line& line);

/// Words [first, first + count) as finite numbers. Throws `bad_data` naming the line.
std::vector<double> numbers(const Line& line, const std::vector<std::string_view>& words,
                            std::size_t first, std::size_t count);

/// The materials of one .mtl file, in file order (mirror = illum 3 with Ks, light = Ke).
std::vector<Material> read_materials(const std::filesystem::path& path);

/// What the `# catoptric` comments say about objects, by name:
///   # catoptric camera NAME ex ey ez tx ty tz ux uy uz fov
///   # catoptric motion OBJECT harmonic ax ay az period
///   # catoptric motion OBJECT step|linear|cubic N, then N times: t x y z
///       (cubic: t, in-tangent, value, out-tangent)
///   # catoptric sphere OBJECT cx cy cz r
///   # catoptric hidden OBJECT            (camera rays pass through it)
struct Remarks {
    std::vector<Camera> cameras;
    std::map<std::string, Motion> motions;
    std::map<std::string, Sphere> spheres;
    std::map<std::string, bool> hidden;
    std::map<std::string, std::string> named_at; ///< each object named, and the line that does
};

/// Adds one comment line. Throws `bad_data` naming it for one that cannot be understood.
void add_remark(Remarks& remarks, const Line& line);

/// What our own scan of an .obj file finds.
struct Text {
    /// Nothing but `o`, `g`, `v`, `usemtl INDEX`, and `f` with absolute indices v or v//vn that
    /// exist: what is left for a parser to do is grouping and cutting polygons.
    std::string statements;
    std::vector<dvec3> positions, normals; ///< exact, unlike a parser's floats
    std::vector<Material> materials;       ///< of all libraries
    Remarks remarks;
};

/// Throws `missing_input` for the file or a material library, `bad_data` with file and line.
Text read_text(const std::filesystem::path& path);

} // namespace catoptric::scene::obj
