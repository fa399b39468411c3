#include "scene/obj_text.hpp"

#include "core/knob.hpp"
#include "core/text.hpp"

#include <charconv>
#include <cstdint>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace catoptric::scene::obj {

namespace fs = std::filesystem;

namespace {

/// The highest number that a face used, checked at the end: a face may come before its vertices.
struct Highest {
    std::uint64_t number = 0;
    std::size_t line = 0;
};

/// A name that `usemtl` gave, looked up at the end: a library may come after it.
struct Use {
    std::string name, where;
};

class Reader {
public:
    Reader(const std::string& file, Context& context) : file_(file), context_(context) {}

    void statement(const Line& line);
    Text finish();

private:
    void library(const Line& line);
    void library_file(const Line& line, const std::string& name);
    void face(const Line& line);
    Corner corner(const Line& line, std::string_view word);
    std::uint32_t index(const Line& line, std::string_view digits, std::size_t count,
                        Highest& highest);
    void group(const Line& line);
    void use_material(const Line& line);
    void check_highest(const Highest& highest, std::size_t count, std::string_view what) const;
    void name_materials();

    const std::string& file_;
    Context& context_;
    Text text_;
    Unread unread_;
    std::unordered_set<std::string> libraries_; ///< real paths of those that have been read
    std::vector<Use> uses_;                     ///< what a face's material means until the end
    std::unordered_map<std::string, std::uint32_t> use_of_;
    std::uint32_t use_ = kNoMaterial;
    Highest position_, normal_;
};

void Reader::library_file(const Line& line, const std::string& name) {
    const std::string place = line.where() + ": mtllib";
    const fs::path real = context_.files.get(name, place);
    if (libraries_.insert(real.string()).second)
        read_materials(real, place, context_, text_.materials);
}

/// One name with spaces, or several names.
void Reader::library(const Line& line) {
    const std::vector<std::string_view> names = words(line);
    check(!names.empty(), Failure::bad_data, line.where(),
          ": mtllib wants a file name, found none");
    const std::string all(line.rest);
    const bool is_one = names.size() > 1 && all.size() <= Files::kLongestName &&
                        !context_.files.find(all, line.where() + ": mtllib").empty();
    if (is_one) return library_file(line, all);
    for (const std::string_view name : names) library_file(line, std::string(name));
}

void Reader::use_material(const Line& line) {
    const auto [entry, is_new] = use_of_.try_emplace(std::string(line.rest),
                                                     static_cast<std::uint32_t>(uses_.size()));
    if (is_new) {
        context_.account.material_names.add(1, *line.file, ":", line.number);
        uses_.push_back({std::string(line.rest), line.where()});
    }
    use_ = entry->second;
}

/// `o` has one name, all of the line; `g` has several, of which one is made.
void Reader::group(const Line& line) {
    std::string name(line.rest);
    if (line.keyword == "g") {
        name.clear();
        for (std::string_view rest = line.rest; !rest.empty();)
            name.append(name.empty() ? "" : " ").append(take_word(rest));
    }
    if (text_.shapes.back().first == text_.faces.size()) // nothing in it
        text_.shapes.back().name = std::move(name);
    else
        text_.shapes.push_back({.name = std::move(name), .first = text_.faces.size()});
}

/// From 0; negative ones count from the last one so far.
std::uint32_t Reader::index(const Line& line, std::string_view digits, std::size_t count,
                            Highest& highest) {
    std::int64_t value = 0;
    const char* end = digits.data() + digits.size();
    const auto result = std::from_chars(digits.data(), end, value);
    if (result.ec != std::errc() || result.ptr != end || value == 0)
        fail(Failure::bad_data, line.where(), ": face wants an index other than 0, found ",
             in_quotes(digits));
    const bool exists = value > 0 || std::uint64_t(0) - std::uint64_t(value) <= count;
    if (!exists)
        fail(Failure::bad_data, line.where(), ": face wants one of ", count,
             " vertices so far, found ", value);
    const std::uint64_t number = value > 0 ? std::uint64_t(value)
                                           : count + 1 + std::uint64_t(value);
    if (number > highest.number) highest = {number, line.number};
    return static_cast<std::uint32_t>(number - 1); // `highest` knows of larger ones
}

/// "v", "v/vt", "v//vn" or "v/vt/vn" without the vt.
Corner Reader::corner(const Line& line, std::string_view word) {
    const std::size_t slash = word.find('/'), last = word.rfind('/');
    Corner corner{index(line, word.substr(0, slash), text_.positions.size(), position_), kNoNormal};
    if (last != slash && last + 1 != word.size())
        corner.normal = index(line, word.substr(last + 1), text_.normals.size(), normal_);
    return corner;
}

void Reader::face(const Line& line) {
    const std::size_t count = count_words(line.rest);
    if (count < 3)
        fail(Failure::bad_data, line.where(), ": face wants at least 3 corners, found ", count);
    context_.account.mesh_triangles.add(count - 2, *line.file, ":", line.number);
    text_.faces.push_back({static_cast<std::uint32_t>(text_.corners.size()), use_});
    std::string_view rest = line.rest;
    for (std::size_t i = 0; i < count; ++i) text_.corners.push_back(corner(line, take_word(rest)));
}

void Reader::statement(const Line& line) {
    if (line.keyword == "v") {
        context_.account.positions.add(1, *line.file, ":", line.number);
        text_.positions.push_back(vector_of(line));
    } else if (line.keyword == "vn") {
        context_.account.normals.add(1, *line.file, ":", line.number);
        text_.normals.push_back(vector_of(line));
    } else if (line.keyword == "f") {
        face(line);
    } else if (line.keyword == "o" || line.keyword == "g") {
        group(line);
    } else if (line.keyword == "usemtl") {
        use_material(line);
    } else if (line.keyword == "mtllib") {
        library(line);
    } else if (line.keyword.front() == '#') {
        add_remark(text_.remarks, line, context_.account);
    } else {
        unread_.add(line);
    }
}

void Reader::check_highest(const Highest& highest, std::size_t count, std::string_view what) const {
    check(highest.number <= count, Failure::bad_data, file_, ":", highest.line,
          ": face wants one of ", count, " ", what, ", found ", highest.number);
}

/// Of materials with the same name the first is meant.
void Reader::name_materials() {
    std::vector<std::string> names;
    std::unordered_map<std::string, std::uint32_t> index_of;
    for (const Material& material : text_.materials) {
        index_of.try_emplace(material.name, static_cast<std::uint32_t>(names.size()));
        names.push_back(material.name);
    }
    std::vector<std::uint32_t> meant;
    for (const auto& [name, where] : uses_) {
        const auto found = index_of.find(name);
        if (found == index_of.end())
            fail(Failure::bad_data, where, ": usemtl wants a material of the libraries, found ",
                 in_quotes(name), did_you_mean(name, names));
        meant.push_back(found->second);
    }
    for (Face& face : text_.faces)
        if (face.material != kNoMaterial) face.material = meant[face.material];
}

Text Reader::finish() {
    check_highest(position_, text_.positions.size(), "positions");
    check_highest(normal_, text_.normals.size(), "normals");
    name_materials();
    unread_.tell(file_, context_.notes);
    return std::move(text_);
}

} // namespace

Text read_text(const std::string& file, Context& context) {
    Reader reader(file, context);
    for_each_line(file, context.files.read_scene(),
                  [&](const Line& line) { reader.statement(line); });
    return reader.finish();
}

} // namespace catoptric::scene::obj
