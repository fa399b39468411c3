#include "core/text.hpp"
#include "scene/number.hpp"
#include "scene/obj_text.hpp"
#include "scene/repair.hpp"

#include <algorithm>

#include <glm/gtc/type_ptr.hpp>

namespace catoptric::scene::obj {

namespace {

void check_radiance(const Line& line) {
    check(is_radiance(vec3(vector_of(line))), Failure::bad_data, line.where(),
          ": 'Ke' wants radiance of at least 0 that fits a float, found ", in_quotes(line.rest));
}

/// 0 and 1 are diffuse, 3 is a mirror; others have something that this engine has not.
std::string illum_text(const Line& line, Notes& notes) {
    const double kind = numbers(line, words(line), 0, 1)[0];
    if (kind != 0 && kind != 1 && kind != 3)
        notes.add("materials with illum " + number_text(kind) + ", drawn as diffuse", line.where());
    return kind == 3 ? " 3" : " 0";
}

std::string vector_text(const Line& line) {
    const dvec3 v = vector_of(line);
    return " " + number_text(v.x) + " " + number_text(v.y) + " " + number_text(v.z);
}

/// "map_Kd", "bump", "norm", "refl" and the like.
bool is_map(std::string_view keyword) {
    constexpr std::string_view kMaps[] = {"bump", "disp", "decal", "refl", "norm"};
    return keyword.starts_with("map_") || std::ranges::find(kMaps, keyword) != std::end(kMaps);
}

/// Maps are not read, but they lie where a scene's files may.
void find_map(const Line& line, Files& files) {
    const std::string name = map_file(line);
    if (!name.empty()) files.find(name, line.where());
}

void add_statement(Library& library, const Line& line, Unread& unread, Context& context,
                   bool& is_in_material) {
    const auto say = [&](const std::string& rest) {
        (library.statements += line.keyword).append(rest) += '\n';
    };
    if (line.keyword == "newmtl") {
        context.account.materials.add(1, line.where());
        say(" " + std::to_string(library.names.size()));
        library.names.emplace_back(line.rest);
        library.two_sided.push_back(false);
        is_in_material = true;
    } else if (!is_in_material) {
        context.notes.add("statements before the first newmtl, left out", line.where());
    } else if (line.keyword == "#two_sided") {
        library.two_sided.back() = true;
    } else if (line.keyword == "Kd" || line.keyword == "Ks" || line.keyword == "Ke") {
        if (line.keyword == "Ke") check_radiance(line);
        say(vector_text(line));
    } else if (line.keyword == "illum") {
        say(illum_text(line, context.notes));
    } else {
        unread.add(line);
        if (is_map(line.keyword)) find_map(line, context.files);
    }
}

} // namespace

std::string map_file(const Line& line) {
    std::string_view rest = line.rest;
    while (rest.starts_with('-')) { // an option, and its numbers or its one word
        const std::string_view option = take_word(rest);
        const bool takes_word = option == "-type" || option == "-imfchan" || option == "-clamp" ||
                                option == "-blendu" || option == "-blendv" || option == "-cc";
        std::string_view after = rest;
        if (takes_word) take_word(rest), after = rest;
        while (!takes_word && parse_number(take_word(after))) rest = after;
    }
    return std::string(rest);
}

void read_materials(const std::filesystem::path& real, const std::string& place, Context& context,
                    Library& library) {
    Unread unread;
    bool is_in_material = false;
    const std::string file = real.string();
    for_each_line(file, context.files.read(real, place), [&](const Line& line) {
        add_statement(library, line, unread, context, is_in_material);
    });
    unread.tell(file, context.notes);
}

std::vector<Material> materials_of(const Library& library,
                                   const std::vector<tinyobj::material_t>& read) {
    std::vector<Material> materials;
    const auto reflectance = [](const tinyobj::real_t(&c)[3]) {
        return glm::clamp(vec3(c[0], c[1], c[2]), 0.0f, 1.0f);
    };
    for (const std::string& name : library.names) {
        const tinyobj::material_t& from = read[materials.size()];
        const bool is_mirror = from.illum == 3;
        // Ks of anything but a perfect mirror is a highlight, which this engine has not
        materials.push_back({.name = name,
                             .albedo = reflectance(from.diffuse),
                             .emission = glm::make_vec3(from.emission),
                             .mirror = is_mirror,
                             .reflectance = is_mirror ? reflectance(from.specular) : vec3(1),
                             .two_sided = library.two_sided[materials.size()]});
    }
    return materials;
}

} // namespace catoptric::scene::obj
