#include "scene/obj_text.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/knob.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace catoptric::scene::obj {

namespace fs = std::filesystem;

namespace {

/// The highest index that a face used, checked at the end: a face may come before its vertices.
struct Highest {
    std::int64_t index = 0;
    std::string where;
};

struct Reader {
    fs::path folder;
    Text text;
    std::vector<std::string> material_names;
    Highest position, normal;

    void library(const Line& line);
    void library_file(const Line& line, const fs::path& name);
    void statement(const Line& line);
    void face(const Line& line);
    std::string corner(const Line& line, std::string_view word);
    std::int64_t index(const Line& line, std::string_view digits, std::size_t count,
                       Highest& highest) const;
    void material(const Line& line);
};

dvec3 vector_of(const Line& line) {
    const std::vector<double> n = numbers(line, words(line), 0, 3);
    return {n[0], n[1], n[2]};
}

void Reader::library_file(const Line& line, const fs::path& name) {
    const bool stays = name.is_relative() && *name.lexically_normal().begin() != "..";
    check(stays, Failure::bad_data, line.where,
          ": mtllib wants a file in the folder of the .obj, found '", name.string(), "'");
    const fs::path path = folder / name;
    std::error_code ignored;
    check(fs::is_regular_file(path, ignored), Failure::missing_input, line.where,
          ": material library '", path.string(), "' is not there");
    for (Material& material : read_materials(path)) {
        material_names.push_back(material.name);
        text.materials.push_back(std::move(material));
    }
}

/// One name with spaces, or several names.
void Reader::library(const Line& line) {
    std::error_code ignored;
    if (fs::is_regular_file(folder / line.rest, ignored)) return library_file(line, line.rest);
    const std::vector<std::string_view> names = words(line);
    check(!names.empty(), Failure::bad_data, line.where, ": mtllib wants a file name, found none");
    for (const std::string_view name : names) library_file(line, name);
}

void Reader::material(const Line& line) {
    const auto found = std::ranges::find(material_names, line.rest);
    check(found != material_names.end(), Failure::bad_data, line.where,
          ": usemtl wants a material of the libraries, found '", line.rest, "'",
          did_you_mean(line.rest, material_names));
    text.statements += "usemtl " + std::to_string(found - material_names.begin()) + "\n";
}

/// Absolute index from 1; negative ones count from the last one so far.
std::int64_t Reader::index(const Line& line, std::string_view digits, std::size_t count,
                           Highest& highest) const {
    std::int64_t value = 0;
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    const bool is_index = result.ec == std::errc() && result.ptr == end && value != 0;
    check(is_index, Failure::bad_data, line.where, ": face wants an index other than 0, found '",
          digits, "'");
    const std::int64_t absolute = value < 0 ? std::int64_t(count) + 1 + value : value;
    check(absolute > 0, Failure::bad_data, line.where, ": face wants one of ", count,
          " vertices so far, found ", value);
    if (absolute > highest.index) highest = {absolute, line.where};
    return absolute;
}

/// "v", "v/vt", "v//vn" or "v/vt/vn" without the vt.
std::string Reader::corner(const Line& line, std::string_view word) {
    const std::size_t slash = word.find('/');
    const std::int64_t v = index(line, word.substr(0, slash), text.positions.size(), position);
    const std::size_t last = word.rfind('/');
    if (last == slash || last + 1 == word.size()) return std::to_string(v);
    const std::int64_t vn = index(line, word.substr(last + 1), text.normals.size(), normal);
    return std::to_string(v) + "//" + std::to_string(vn);
}

void Reader::face(const Line& line) {
    const std::vector<std::string_view> corners = words(line);
    check(corners.size() >= 3, Failure::bad_data, line.where,
          ": face wants at least 3 corners, found ", corners.size());
    text.statements += "f";
    for (const std::string_view word : corners) text.statements += " " + corner(line, word);
    text.statements += "\n";
}

void Reader::statement(const Line& line) {
    if (line.keyword == "v") {
        text.positions.push_back(vector_of(line));
        text.statements += "v " + std::string(line.rest) + "\n";
    } else if (line.keyword == "vn") {
        text.normals.push_back(vector_of(line));
    } else if (line.keyword == "f") {
        face(line);
    } else if (line.keyword == "o" || line.keyword == "g") {
        text.statements += std::string(line.keyword) + " " + std::string(line.rest) + "\n";
    } else if (line.keyword == "usemtl") {
        material(line);
    } else if (line.keyword.front() == '#') {
        add_remark(text.remarks, line);
    }
}

void check_highest(const Highest& highest, std::size_t count, std::string_view what) {
    check(highest.index <= std::int64_t(count), Failure::bad_data, highest.where,
          ": face wants one of ", count, " ", what, ", found ", highest.index);
}

} // namespace

Text read_text(const fs::path& path) {
    const std::string content = read_file(path);
    Reader reader{.folder = path.parent_path()};
    for_each_line(path.string(), content, [&](const Line& line) {
        if (line.keyword == "mtllib") reader.library(line);
    });
    for_each_line(path.string(), content, [&](const Line& line) { reader.statement(line); });
    check_highest(reader.position, reader.text.positions.size(), "positions");
    check_highest(reader.normal, reader.text.normals.size(), "normals");
    return std::move(reader.text);
}

} // namespace catoptric::scene::obj
