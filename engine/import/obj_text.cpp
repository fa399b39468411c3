#include "import/obj_text.hpp"

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
    ObjReader(const std::string& file, ReadContext& context) : file_(file), context_(context) {}

    /// Reads one line of the first pass: everything but faces, groups and uses of materials.
    void read_first_pass(const Line& line);
    void index_materials();
    /// Reads one line of the second pass: faces, groups and uses of materials.
    void read_second_pass(const Line& line);
    RewrittenText finish();

private:
    void library(const Line& line);
    void library_file(const Line& line, const std::string& name);
    fs::path find_library(const Line& line, std::string_view name);
    void position(const Line& line);
    void texture_coordinates(const Line& line);
    void smoothing_group(const Line& line);
    void face(const Line& line);
    void smooth_face();
    Corner corner(const Line& line, std::string_view word) const;
    void group(const Line& line);
    void select_material(const Line& line);

    const std::string& file_;
    ReadContext& context_;
    RewrittenText text_;
    UnreadStatements unread_;
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
    std::vector<Corner> polygon_, triangles_;
};

void ObjReader::library_file(const Line& line, const std::string& name) {
    const std::string place = line.place() + ": mtllib";
    const fs::path real = find_library(line, name);
    if (real.empty()) {
        context_.notes.add("material libraries that are not there", place + ": " + quote(name));
        add_unsupported(context_.unsupported, "missing-material",
                        line.place() + ": " + quote(name));
    } else if (libraries_.insert(real.string()).second)
        read_library(real, place, context_, text_.library);
}

fs::path ObjReader::find_library(const Line& line, std::string_view name) {
    return context_.files.find_as_written(name, fs::path(file_).parent_path(),
                                          line.place() + ": mtllib");
}

/// Splits file names at blanks that are not in quotes, up to a comment.
std::vector<std::string_view> split_quoted_names(const Line& line) {
    std::vector<std::string_view> names;
    std::string_view rest = line.rest;
    while (!rest.empty() && rest.front() != '#') {
        const std::size_t end = rest.front() == '"' ? rest.find('"', 1) : rest.npos;
        if (end == rest.npos) {
            names.push_back(take_word(rest));
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
void ObjReader::library(const Line& line) {
    constexpr std::size_t kMostJoinedWords = 16; // each number of words asks for a file
    const std::vector<std::string_view> words = split_quoted_names(line);
    check(!words.empty(), Failure::bad_data, line.place(),
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
        while (end > first + 1 &&
               (name().size() > FileOpener::kMaxNameLength || find_library(line, name()).empty()))
            --end;
        library_file(line, name());
        first = end;
    }
}

/// If materials share a name, the first is used.
void ObjReader::index_materials() {
    for (std::size_t i = 0; i < text_.library.drafts.size(); ++i)
        material_of_.try_emplace(text_.library.drafts[i].name, i);
    file_normals_ = text_.normals.size();
}

void ObjReader::select_material(const Line& line) {
    const std::string name(line.rest);
    const auto found = material_of_.find(name);
    if (found == material_of_.end()) {
        // Without any material, the missing library has been noted already.
        const bool has_any = !text_.library.drafts.empty();
        context_.notes.add("uses of materials that no library has, drawn grey",
                           line.place() + ": " + quote(name), has_any ? 1 : 0);
        add_unsupported(context_.unsupported, "missing-material",
                        line.place() + ": " + quote(name));
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
void ObjReader::group(const Line& line) {
    std::string name(line.rest);
    if (line.keyword == "g") {
        name.clear();
        for (std::string_view rest = line.rest; !rest.empty();)
            name.append(name.empty() ? "" : " ").append(take_word(rest));
    }
    if (std::exchange(has_faces_, false)) {
        text_.statements += "o " + std::to_string(text_.names.size()) + "\n";
        text_.names.emplace_back();
    }
    text_.names.back() = std::move(name);
}

/// Parses an index and returns it from 0. A negative index counts back from the last of the
/// `so_far` elements before the line. Throws `bad_data` if no element has the index.
std::uint32_t parse_index(const Line& line, std::string_view digits, std::size_t so_far,
                          std::size_t count, std::string_view what) {
    std::int64_t value = 0;
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || value == 0)
        fail(Failure::bad_data, line.place(), ": face wants an index other than 0, found ",
             quote(digits));
    if (value < 0 && std::uint64_t(0) - std::uint64_t(value) > so_far)
        fail(Failure::bad_data, line.place(), ": face wants one of ", so_far, " ", what,
             " so far, found ", value);
    if (value > 0 && std::uint64_t(value) > count)
        fail(Failure::bad_data, line.place(), ": face wants one of ", count, " ", what, ", found ",
             value);
    return static_cast<std::uint32_t>(value > 0 ? value - 1 : std::int64_t(so_far) + value);
}

/// Parses a face corner: "v", "v/vt", "v//vn" or "v/vt/vn".
Corner ObjReader::corner(const Line& line, std::string_view word) const {
    const std::size_t slash = word.find('/'), last = word.rfind('/');
    Corner corner{
        parse_index(line, word.substr(0, slash), positions_, text_.positions.size(), "vertices"),
        kNoIndex, kNoIndex};
    if (last != slash && last + 1 != word.size())
        corner.normal = parse_index(line, word.substr(last + 1), normals_, file_normals_,
                                    "normals");
    if (slash == word.npos) return corner;
    const std::string_view uv = word.substr(slash + 1,
                                            last == slash ? word.npos : last - slash - 1);
    if (!uv.empty())
        corner.uv = parse_index(line, uv, uvs_, text_.uv.size(), "texture coordinates");
    return corner;
}

/// Reads `s`: the number of a smoothing group, or "off" or 0 for flat faces.
void ObjReader::smoothing_group(const Line& line) {
    std::string_view rest = line.rest;
    const std::string_view word = take_word(rest);
    smoothing_ = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), smoothing_);
    const bool is_number = result.ec == std::errc() && result.ptr == word.data() + word.size();
    if (!is_number) smoothing_ = 0;
    context_.notes.add("smoothing groups that are no numbers, drawn flat", line.place(),
                       is_number || word == "off" ? 0 : 1);
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
    for (Corner& corner : polygon_) {
        if (corner.normal != kNoIndex) continue;
        const auto [entry, is_new] = smooth_normals_.try_emplace(
            {smoothing_, corner.position}, static_cast<std::uint32_t>(text_.normals.size()));
        if (is_new) {
            context_.account.normals.add(1, file_);
            text_.normals.emplace_back(0);
        }
        corner.normal = entry->second;
        text_.normals[corner.normal] += area;
    }
}

void ObjReader::face(const Line& line) {
    const std::size_t count = count_words(line.rest);
    if (count < 3) {
        context_.notes.add("faces of one or two corners, left out", line.place());
        return add_unsupported(context_.unsupported, "points-lines", line.place());
    }
    context_.account.mesh_triangles.add(count - 2, *line.file, ":", line.number);
    polygon_.clear(), triangles_.clear();
    std::string_view rest = line.rest;
    for (std::size_t i = 0; i < count; ++i) polygon_.push_back(corner(line, take_word(rest)));
    smooth_face();
    triangulate(polygon_, text_.positions, context_.account.cuts, line, triangles_);
    for (std::size_t i = 0; i < triangles_.size(); ++i) {
        const auto [position, normal, uv] = triangles_[i];
        (text_.statements += i % 3 == 0 ? "f " : " ") += std::to_string(position + 1);
        if (uv != kNoIndex || normal != kNoIndex) text_.statements += '/';
        if (uv != kNoIndex) text_.statements += std::to_string(uv + 1);
        if (normal != kNoIndex) (text_.statements += '/') += std::to_string(normal + 1);
        if (i % 3 == 2) text_.statements += '\n';
    }
    has_faces_ = true;
}

/// Reads a position: x y z, optionally followed by w, r g b, or w r g b. w is ignored.
void ObjReader::position(const Line& line) {
    context_.account.positions.add(1, *line.file, ":", line.number);
    text_.positions.push_back(parse_line_vector(line));
    const std::size_t count = count_words(line.rest);
    if (count < 6 && text_.colours.empty()) return;
    text_.colours.resize(text_.positions.size(), vec3(1));
    if (count < 6) return;
    const std::vector<double> rgb = parse_words(line, split_words(line), count > 6 ? 4 : 3, 3);
    for (int channel = 0; channel < 3; ++channel)
        text_.colours.back()[channel] = static_cast<float>(
            linear_from_srgb_value(std::clamp(rgb[std::size_t(channel)], 0.0, 1.0)));
    context_.notes.add("colours of vertices, read as sRGB", line.place());
    if (std::ranges::any_of(rgb, [](double value) { return is_clamped_factor(value); }))
        context_.notes.add(kClampedFactorNote, line.place());
}

void ObjReader::texture_coordinates(const Line& line) {
    context_.account.attributes.add(1, *line.file, ":", line.number);
    std::string_view rest = line.rest;
    const double u = parse_word(line, take_word(rest));
    const bool has_v = !rest.empty() && rest.front() != '#';
    text_.uv.emplace_back(u, has_v ? parse_word(line, take_word(rest)) : 0);
}

void ObjReader::read_first_pass(const Line& line) {
    if (line.keyword == "v") {
        position(line);
    } else if (line.keyword == "vt") {
        texture_coordinates(line);
    } else if (line.keyword == "vn") {
        context_.account.normals.add(1, *line.file, ":", line.number);
        text_.normals.push_back(parse_line_vector(line));
    } else if (line.keyword == "mtllib") {
        library(line);
    } else if (line.keyword.front() == '#') {
        add_comment(text_.remarks, line, context_.account);
    } else if (line.keyword != "f" && line.keyword != "o" && line.keyword != "g" &&
               line.keyword != "usemtl" && line.keyword != "s") {
        if (line.keyword == "p" || line.keyword == "l")
            add_unsupported(context_.unsupported, "points-lines", line.place());
        unread_.count(line);
    }
}

void ObjReader::read_second_pass(const Line& line) {
    if (line.keyword == "v") ++positions_;
    if (line.keyword == "vn") ++normals_;
    if (line.keyword == "vt") ++uvs_;
    if (line.keyword == "f") face(line);
    if (line.keyword == "s") smoothing_group(line);
    if (line.keyword == "o" || line.keyword == "g") group(line);
    if (line.keyword == "usemtl") select_material(line);
}

RewrittenText ObjReader::finish() {
    unread_.report(file_, context_.notes);
    if (!has_faces_) text_.names.pop_back();
    return std::move(text_);
}

} // namespace

RewrittenText read_obj_text(const std::string& file, ReadContext& context) {
    ObjReader obj_reader(file, context);
    const std::string bytes = context.files.read_main();
    check(!bytes.starts_with("\xff\xfe") && !bytes.starts_with("\xfe\xff"), Failure::bad_data, file,
          ": wanted text in UTF-8, found UTF-16");
    for_each_line(file, bytes, [&](const Line& line) { obj_reader.read_first_pass(line); });
    obj_reader.index_materials();
    for_each_line(file, bytes, [&](const Line& line) { obj_reader.read_second_pass(line); });
    return obj_reader.finish();
}

} // namespace catoptric::scene::obj
