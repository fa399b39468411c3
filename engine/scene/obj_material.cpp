#include "core/text.hpp"
#include "scene/number.hpp"
#include "scene/obj_text.hpp"
#include "scene/repair.hpp"

#include <algorithm>

namespace catoptric::scene::obj {

namespace {

vec3 colour(const Line& line) { return vec3(vector_of(line)); }

vec3 reflectance(const Line& line) { return glm::clamp(colour(line), 0.0f, 1.0f); }

vec3 radiance(const Line& line) {
    const vec3 emission = colour(line);
    check(is_radiance(emission), Failure::bad_data, line.where(),
          ": 'Ke' wants radiance of at least 0 that fits a float, found ", in_quotes(line.rest));
    return emission;
}

/// 0 and 1 are diffuse, 3 is a mirror; others have something that this engine has not.
bool is_mirror(const Line& line, Notes& notes) {
    const double kind = numbers(line, words(line), 0, 1)[0];
    if (kind != 0 && kind != 1 && kind != 3)
        notes.add("materials with illum " + number_text(kind) + ", drawn as diffuse", line.where());
    return kind == 3;
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

void add_statement(std::vector<Material>& materials, const Line& line, Unread& unread,
                   Context& context) {
    if (line.keyword == "newmtl") {
        context.account.materials.add(1, *line.file);
        materials.push_back({.name = std::string(line.rest)});
    } else if (materials.empty()) {
        return; // nothing to say it of
    } else if (line.keyword == "Kd") {
        materials.back().albedo = reflectance(line);
    } else if (line.keyword == "Ks") {
        materials.back().reflectance = reflectance(line);
    } else if (line.keyword == "Ke") {
        materials.back().emission = radiance(line);
    } else if (line.keyword == "illum") {
        materials.back().mirror = is_mirror(line, context.notes);
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
                    std::vector<Material>& materials) {
    std::vector<Material> found;
    Unread unread;
    const std::string file = real.string();
    for_each_line(file, context.files.read(real, place),
                  [&](const Line& line) { add_statement(found, line, unread, context); });
    unread.tell(file, context.notes);
    // Ks of anything but a perfect mirror is a highlight, which this engine has not
    for (Material& material : found) {
        if (!material.mirror) material.reflectance = vec3(1);
        materials.push_back(std::move(material));
    }
}

} // namespace catoptric::scene::obj
