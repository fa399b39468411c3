#include "scene/obj_text.hpp"

#include "core/text.hpp"
#include "scene/texel.hpp"
#include "scene/unsupported_feature.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <map>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace catoptric::scene::obj {

namespace fs = std::filesystem;

namespace {

/// Reads an .obj file in two passes, because faces and `usemtl` may precede the definitions that
/// they refer to.
class ObjReader {
public:
    ObjReader(const std::string& file, ObjReadContext& context) : file_(file), context_(context) {}

    /// Reads one line of the first pass: everything but faces, groups and uses of materials.
    void read_first_pass_line(const ObjLine& line);
    void index_materials_by_name();
    /// Reads one line of the second pass: faces, groups and uses of materials.
    void read_second_pass_line(const ObjLine& line);
    RewrittenObjText finish();

private:
    void library(const ObjLine& line);
    void library_file(const ObjLine& line, const std::string& name);
    fs::path find_library(const ObjLine& line, std::string_view name);
    void position(const ObjLine& line);
    void texture_coordinates(const ObjLine& line);
    void smoothing_group(const ObjLine& line);
    void face(const ObjLine& line);
    void smooth_face();
    ObjCorner corner(const ObjLine& line, std::string_view word) const;
    void group(const ObjLine& line);
    void select_obj_material(const ObjLine& line);

    const std::string& file_;
    ObjReadContext& context_;
    RewrittenObjText text_;
    UnreadStatementCounts unread_;
    std::unordered_set<std::string> libraries_; ///< real paths of the libraries read so far
    std::unordered_map<std::string, std::size_t> material_of_;
    std::optional<std::size_t> material_;               ///< material of the next faces
    std::size_t positions_ = 0, normals_ = 0, uvs_ = 0; ///< counts in the second pass so far
    std::size_t file_normals_ = 0; ///< count in the file; those of smoothing groups follow
    bool has_faces_ = false;       ///< whether the last shape has faces
    std::uint32_t smoothing_ = 0;  ///< smoothing group of the next faces; 0: they are flat
    /// Index in text_.normals by smoothing group and position. Until the end, these normals are
    /// sums over faces, weighted by area.
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> smooth_normals_;
    /// Corners and triangles of the current face.
    std::vector<ObjCorner> polygon_, triangles_;
};

void ObjReader::library_file(const ObjLine& line, const std::string& name) {
    const std::string place = line.describe_line_place() + ": mtllib";
    const fs::path real = find_library(line, name);
    if (real.empty()) {
        context_.notes.add_note("material libraries that are not there",
                                place + ": " + quote(name));
        add_unsupported_feature(context_.unsupported, "missing-material",
                                line.describe_line_place() + ": " + quote(name));
    } else if (libraries_.insert(real.string()).second)
        read_material_library(real, place, context_, text_.library);
}

fs::path ObjReader::find_library(const ObjLine& line, std::string_view name) {
    return context_.files.find_as_written(name, fs::path(file_).parent_path(),
                                          line.describe_line_place() + ": mtllib");
}

/// Splits file names at blanks that are not in quotes, up to a comment.
std::vector<std::string_view> split_quoted_names(const ObjLine& line) {
    std::vector<std::string_view> names;
    std::string_view rest = line.rest;
    while (!rest.empty() && rest.front() != '#') {
        const std::size_t end = rest.front() == '"' ? rest.find('"', 1) : rest.npos;
        if (end == rest.npos) {
            names.push_back(remove_first_word(rest));
            continue;
        }
        names.push_back(rest.substr(0, end + 1));
        rest.remove_prefix(end + 1);
        rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    }
    return names;
}

/// Returns whether a name ends in ".mtl", perhaps with a quote behind it.
bool ends_in_library(std::string_view word) {
    if (word.ends_with('"')) word.remove_suffix(1);
    if (word.size() < 4) return false;
    std::string end(word.substr(word.size() - 4));
    std::ranges::transform(end, end.begin(), [](unsigned char c) { return std::tolower(c); });
    return end == ".mtl";
}

/// Reads `mtllib`: several names, of which each may have blanks. A name ends with the first word in
/// .mtl, if a file has this name; else with fewer words.
void ObjReader::library(const ObjLine& line) {
    constexpr std::size_t kMostJoinedWords = 16; // each number of words asks for a file
    const std::vector<std::string_view> words = split_quoted_names(line);
    check(!words.empty(), Failure::bad_data, line.describe_line_place(),
          ": mtllib wants a file name, found none");
    for (std::size_t first = 0; first < words.size();) {
        const auto last = std::find_if(words.begin() + std::ptrdiff_t(first), words.end(),
                                       ends_in_library);
        std::size_t end = last == words.end() ? words.size()
                                              : std::size_t(last - words.begin()) + 1;
        end = std::min(end, first + kMostJoinedWords);
        const auto name = [&] {
            return std::string(words[first].data(), words[end - 1].data() + words[end - 1].size());
        };
        while (end > first + 1 && (name().size() > SceneFileOpener::kMaxFileNameLength ||
                                   find_library(line, name()).empty()))
            --end;
        library_file(line, name());
        first = end;
    }
}

/// Maps names to materials. If materials share a name, the first is used.
void ObjReader::index_materials_by_name() {
    for (std::size_t i = 0; i < text_.library.drafts.size(); ++i)
        material_of_.try_emplace(text_.library.drafts[i].name, i);
    file_normals_ = text_.normals.size();
}

void ObjReader::select_obj_material(const ObjLine& line) {
    const std::string name(line.rest);
    const auto found = material_of_.find(name);
    if (found == material_of_.end()) {
        // Without any material, the missing library has been noted already.
        const bool has_any = !text_.library.drafts.empty();
        context_.notes.add_note("uses of materials that no library has, drawn grey",
                                line.describe_line_place() + ": " + quote(name), has_any ? 1 : 0);
        add_unsupported_feature(context_.unsupported, "missing-material",
                                line.describe_line_place() + ": " + quote(name));
        if (material_) text_.statements += "usemtl none\n";
        material_.reset();
        return;
    }
    if (material_ == found->second) return;
    material_ = found->second;
    text_.statements += "usemtl " + std::to_string(*material_) + "\n";
}

/// Starts a shape. The rest of an `o` line is one name. `g` lists several names, which are joined
/// by spaces.
void ObjReader::group(const ObjLine& line) {
    std::string name(line.rest);
    if (line.keyword == "g") {
        name.clear();
        for (std::string_view rest = line.rest; !rest.empty();)
            name.append(name.empty() ? "" : " ").append(remove_first_word(rest));
    }
    if (std::exchange(has_faces_, false)) {
        text_.statements += "o " + std::to_string(text_.names.size()) + "\n";
        text_.names.emplace_back();
    }
    text_.names.back() = std::move(name);
}

/// Parses an index and returns it from 0. A negative index counts back from the last of the
/// `so_far` elements before the line. Throws `bad_data` if no element has the index.
std::uint32_t parse_obj_index(const ObjLine& line, std::string_view digits, std::size_t so_far,
                              std::size_t count, std::string_view what) {
    std::int64_t value = 0;
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || value == 0)
        fail(Failure::bad_data, line.describe_line_place(),
             ": face wants an index other than 0, found ", quote(digits));
    if (value < 0 && std::uint64_t(0) - std::uint64_t(value) > so_far)
        fail(Failure::bad_data, line.describe_line_place(), ": face wants one of ", so_far, " ",
             what, " so far, found ", value);
    if (value > 0 && std::uint64_t(value) > count)
        fail(Failure::bad_data, line.describe_line_place(), ": face wants one of ", count, " ",
             what, ", found ", value);
    return static_cast<std::uint32_t>(value > 0 ? value - 1 : std::int64_t(so_far) + value);
}

/// Parses a face corner: "v", "v/vt", "v//vn" or "v/vt/vn".
ObjCorner ObjReader::corner(const ObjLine& line, std::string_view word) const {
    const std::size_t slash = word.find('/'), last = word.rfind('/');
    ObjCorner corner{parse_obj_index(line, word.substr(0, slash), positions_,
                                     text_.positions.size(), "vertices"),
                     kMissingObjIndex, kMissingObjIndex};
    if (last != slash && last + 1 != word.size())
        corner.normal = parse_obj_index(line, word.substr(last + 1), normals_, file_normals_,
                                        "normals");
    if (slash == word.npos) return corner;
    const std::string_view uv = word.substr(slash + 1,
                                            last == slash ? word.npos : last - slash - 1);
    if (!uv.empty())
        corner.uv = parse_obj_index(line, uv, uvs_, text_.uv.size(), "texture coordinates");
    return corner;
}

/// Reads `s`: the number of a smoothing group, or "off" or 0 for flat faces.
void ObjReader::smoothing_group(const ObjLine& line) {
    std::string_view rest = line.rest;
    const std::string_view word = remove_first_word(rest);
    smoothing_ = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), smoothing_);
    const bool is_number = result.ec == std::errc() && result.ptr == word.data() + word.size();
    if (!is_number) smoothing_ = 0;
    context_.notes.add_note("smoothing groups that are no numbers, drawn flat",
                            line.describe_line_place(), is_number || word == "off" ? 0 : 1);
}

/// Gives the corners without a normal that of their position in the smoothing group.
void ObjReader::smooth_face() {
    if (smoothing_ == 0) return;
    dvec3 area(0); // along the normal, as long as the area is large (Newell)
    for (std::size_t i = 0; i < polygon_.size(); ++i)
        area += glm::cross(text_.positions[polygon_[i].position] -
                               text_.positions[polygon_[0].position],
                           text_.positions[polygon_[(i + 1) % polygon_.size()].position] -
                               text_.positions[polygon_[0].position]);
    for (ObjCorner& corner : polygon_) {
        if (corner.normal != kMissingObjIndex) continue;
        const auto [entry, is_new] = smooth_normals_.try_emplace(
            {smoothing_, corner.position}, static_cast<std::uint32_t>(text_.normals.size()));
        if (is_new) {
            context_.account.normals.add_amount_within_budget(1, file_);
            text_.normals.emplace_back(0);
        }
        corner.normal = entry->second;
        text_.normals[corner.normal] += area;
    }
}

void ObjReader::face(const ObjLine& line) {
    const std::size_t count = count_words(line.rest);
    if (count < 3) {
        context_.notes.add_note("faces of one or two corners, left out",
                                line.describe_line_place());
        return add_unsupported_feature(context_.unsupported, "points-lines",
                                       line.describe_line_place());
    }
    context_.account.mesh_triangles.add_amount_within_budget(count - 2, *line.file, ":",
                                                             line.number);
    polygon_.clear(), triangles_.clear();
    std::string_view rest = line.rest;
    for (std::size_t i = 0; i < count; ++i)
        polygon_.push_back(corner(line, remove_first_word(rest)));
    smooth_face();
    triangulate_polygon(polygon_, text_.positions, context_.account.cuts, line, triangles_);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const auto [position, normal, uv] = triangles_[i];
        (text_.statements += i % 3 == 0 ? "f " : " ") += std::to_string(position + 1);
        if (uv != kMissingObjIndex || normal != kMissingObjIndex) text_.statements += '/';
        if (uv != kMissingObjIndex) text_.statements += std::to_string(uv + 1);
        if (normal != kMissingObjIndex) (text_.statements += '/') += std::to_string(normal + 1);
        if (i % 3 == 2) text_.statements += '\n';
    }
    has_faces_ = true;
}

/// Reads a position: x y z, optionally followed by w, r g b, or w r g b. w is ignored.
void ObjReader::position(const ObjLine& line) {
    context_.account.positions.add_amount_within_budget(1, *line.file, ":", line.number);
    text_.positions.push_back(parse_line_vector(line));
    const std::size_t count = count_words(line.rest);
    if (count < 6 && text_.colours.empty()) return;
    text_.colours.resize(text_.positions.size(), vec3(1));
    if (count < 6) return;
    const std::vector<double> rgb = parse_word_numbers(line, split_words(line), count > 6 ? 4 : 3,
                                                       3);
    for (int channel = 0; channel < 3; ++channel)
        text_.colours.back()[channel] = static_cast<float>(
            linear_from_srgb_value(std::clamp(rgb[std::size_t(channel)], 0.0, 1.0)));
    context_.notes.add_note("colours of vertices, read as sRGB", line.describe_line_place());
    if (std::ranges::any_of(rgb, [](double value) { return is_clamped_factor(value); }))
        context_.notes.add_note(kClampedFactorNote, line.describe_line_place());
}

void ObjReader::texture_coordinates(const ObjLine& line) {
    context_.account.attributes.add_amount_within_budget(1, *line.file, ":", line.number);
    std::string_view rest = line.rest;
    const double u = parse_word_number(line, remove_first_word(rest));
    const bool has_v = !rest.empty() && rest.front() != '#';
    text_.uv.emplace_back(u, has_v ? parse_word_number(line, remove_first_word(rest)) : 0);
}

void ObjReader::read_first_pass_line(const ObjLine& line) {
    if (line.keyword == "v") {
        position(line);
    } else if (line.keyword == "vt") {
        texture_coordinates(line);
    } else if (line.keyword == "vn") {
        context_.account.normals.add_amount_within_budget(1, *line.file, ":", line.number);
        text_.normals.push_back(parse_line_vector(line));
    } else if (line.keyword == "mtllib") {
        library(line);
    } else if (line.keyword.front() == '#') {
        add_catoptric_comment(text_.remarks, line, context_.account);
    } else if (line.keyword != "f" && line.keyword != "o" && line.keyword != "g" &&
               line.keyword != "usemtl" && line.keyword != "s") {
        if (line.keyword == "p" || line.keyword == "l")
            add_unsupported_feature(context_.unsupported, "points-lines",
                                    line.describe_line_place());
        unread_.count_statement(line);
    }
}

void ObjReader::read_second_pass_line(const ObjLine& line) {
    if (line.keyword == "v") ++positions_;
    if (line.keyword == "vn") ++normals_;
    if (line.keyword == "vt") ++uvs_;
    if (line.keyword == "f") face(line);
    if (line.keyword == "s") smoothing_group(line);
    if (line.keyword == "o" || line.keyword == "g") group(line);
    if (line.keyword == "usemtl") select_obj_material(line);
}

RewrittenObjText ObjReader::finish() {
    unread_.report_unread_obj_statements(file_, context_.notes);
    if (!has_faces_) text_.names.pop_back();
    return std::move(text_);
}

} // namespace

RewrittenObjText read_obj_text(const std::string& file, ObjReadContext& context) {
    ObjReader obj_reader(file, context);
    const std::string bytes = context.files.read_main_scene_file();
    check(!bytes.starts_with("\xff\xfe") && !bytes.starts_with("\xfe\xff"), Failure::bad_data, file,
          ": wanted text in UTF-8, found UTF-16");
    for_each_obj_line(file, bytes,
                      [&](const ObjLine& line) { obj_reader.read_first_pass_line(line); });
    obj_reader.index_materials_by_name();
    for_each_obj_line(file, bytes,
                      [&](const ObjLine& line) { obj_reader.read_second_pass_line(line); });
    return obj_reader.finish();
}

} // namespace catoptric::scene::obj
