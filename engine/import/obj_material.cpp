#include "core/text.hpp"
#include "import/image_file.hpp"
#include "import/obj_text.hpp"
#include "scene/classify.hpp"
#include "scene/material_facts.hpp"
#include "scene/number.hpp"
#include "scene/repair.hpp"
#include "scene/unsupported_feature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace catoptric::scene::obj {

namespace fs = std::filesystem;

namespace {

/// Returns whether a statement names a texture map, such as "map_Kd", "bump", "norm" or "refl".
bool is_map_statement(std::string_view keyword) {
    constexpr std::string_view kMtlMapStatements[] = {"bump", "disp", "decal", "refl", "norm"};
    return keyword.starts_with("map_") ||
           std::ranges::find(kMtlMapStatements, keyword) != std::end(kMtlMapStatements);
}

bool is_bump_statement(std::string_view keyword) {
    return keyword == "bump" || keyword == "map_bump" || keyword == "map_Bump";
}

/// Reads a colour from three numbers, or from one number for all channels. Returns none for the
/// forms "spectral" and "xyz".
std::optional<dvec3> parse_colour(const Line& line) {
    std::string_view rest = line.rest;
    const std::string_view first = take_word(rest);
    if (first == "spectral" || first == "xyz") return std::nullopt;
    if (rest.empty() || rest.front() == '#') return dvec3(parse_word(line, first));
    return parse_line_vector(line);
}

double parse_line_number(const Line& line) { return parse_words(line, split_words(line), 0, 1)[0]; }

/// Reads a map's options and file name. `-s`, `-o` and `-clamp` change the lookup; other options
/// are skipped.
TextureUse parse_map_statement(const Line& line) {
    TextureUse map;
    std::string_view rest = line.rest;
    while (rest.starts_with('-')) {
        const std::string_view option = take_word(rest);
        const bool takes_word = option == "-type" || option == "-imfchan" || option == "-clamp" ||
                                option == "-blendu" || option == "-blendv" || option == "-cc";
        std::string_view after = rest;
        if (takes_word) {
            const bool is_on = take_word(rest) == "on";
            if (option == "-clamp") map.is_clamped = is_on;
            continue;
        }
        std::array<double, 3> values{};
        std::size_t count = 0;
        while (const auto value = parse_number(take_word(after))) {
            if (count < values.size()) values[count] = *value;
            ++count, rest = after;
        }
        for (int i = 0; i < 2 && i < int(count); ++i) {
            if (option == "-s") map.scale[i] = values[std::size_t(i)];
            if (option == "-o") map.offset[i] = values[std::size_t(i)];
        }
    }
    map.file = rest;
    return map;
}

void add_map(const Line& line, ReadContext& context, MtlLibrary& library) {
    TextureUse map = parse_map_statement(line);
    if (map.file.empty()) return;
    map.place = line.place();
    map.real = context.files.find_as_written(map.file, fs::path(*line.file).parent_path(),
                                             map.place);
    MtlMaterial& draft = library.drafts.back();
    if (line.keyword == "map_Kd")
        draft.colour = std::move(map);
    else if (line.keyword == "map_d")
        draft.cut = std::move(map);
    else if (line.keyword == "norm")
        draft.normals = std::move(map);
    else if (line.keyword != "map_Ka") // ambient, which no light of the engine shows
        add_unsupported_material(context.unsupported,
                                 is_bump_statement(line.keyword) ? "normal-texture"
                                                                 : "material-extension",
                                 line.place(), library.drafts.size() - 1);
}

/// A statement with one number, and the member that it sets.
struct NumberStatement {
    std::string_view keyword;
    std::optional<double> MtlMaterial::*member;
    bool is_factor = false; ///< whether it is clamped to 0 to 1
};
constexpr NumberStatement kNumberStatements[] = {
    {"Ns", &MtlMaterial::shininess},       {"Ni", &MtlMaterial::ior},
    {"Pr", &MtlMaterial::roughness, true}, {"Pm", &MtlMaterial::metallic, true},
    {"illum", &MtlMaterial::kind},         {"d", &MtlMaterial::alpha, true},
    {"Pc", &MtlMaterial::clearcoat, true}, {"Pcr", &MtlMaterial::clearcoat_roughness, true}};

/// Notes a statement whose numbers are clamped to 0 to 1.
void note_if_clamped(const Line& line, std::initializer_list<double> numbers, LoaderNotes& notes) {
    if (std::ranges::any_of(numbers, [](double number) { return is_clamped_factor(number); }))
        notes.add(kClampedFactorNote,
                  line.place() + ": " +
                      quote(std::string(line.keyword) + " " + std::string(line.rest)));
}

void add_radiance(const Line& line, const dvec3& radiance, MtlMaterial& draft) {
    draft.emission = vec3(radiance);
    check(is_valid_radiance(draft.emission), Failure::bad_data, line.place(),
          ": 'Ke' wants radiance of at least 0 that fits a float, found ", quote(line.rest));
}

/// Reads a statement into a member of the draft. Returns false if the draft has none for it.
bool add_property(const Line& line, MtlMaterial& draft, LoaderNotes& notes) {
    const auto* const number = std::ranges::find(kNumberStatements, line.keyword,
                                                 &NumberStatement::keyword);
    if (number != std::end(kNumberStatements)) {
        // The number may follow an option: "d -halo .5".
        std::string_view rest = line.rest;
        const Line of{line.file, line.number, line.keyword,
                      take_word(rest) == "-halo" ? rest : line.rest};
        const double value = parse_line_number(of);
        check(line.keyword != "illum" || (value >= 0 && value <= 10 && value == std::floor(value)),
              Failure::bad_data, line.place(),
              ": 'illum' wants a whole number from 0 to 10, found ", value);
        draft.*(number->member) = value;
        if (number->is_factor) note_if_clamped(line, {value}, notes);
        return true;
    }
    if (line.keyword == "Tr") {
        draft.transparency = parse_line_number(line);
        note_if_clamped(line, {*draft.transparency}, notes);
        return true;
    }
    if (line.keyword == "#two_sided") return draft.two_sided = true;
    if (line.keyword == "#fixed_normals") return draft.fixed_normals = true;
    if (line.keyword != "Kd" && line.keyword != "Ks" && line.keyword != "Ke") return false;
    const std::optional<dvec3> colour = parse_colour(line);
    if (!colour) return false;
    if (line.keyword != "Ke") note_if_clamped(line, {colour->x, colour->y, colour->z}, notes);
    if (line.keyword == "Kd") draft.diffuse = colour;
    if (line.keyword == "Ks") draft.specular = colour;
    if (line.keyword == "Ke") add_radiance(line, *colour, draft);
    return true;
}

void add_statement(MtlLibrary& library, const Line& line, UnreadStatements& unread,
                   ReadContext& context, bool& is_in_material) {
    if (line.keyword == "newmtl") {
        context.account.materials.add(1, line.place());
        library.drafts.push_back({.name = std::string(line.rest), .place = line.place()});
        is_in_material = true;
    } else if (!is_in_material) {
        context.notes.add("statements before the first newmtl, left out", line.place());
    } else if (!add_property(line, library.drafts.back(), context.notes)) {
        // A map_d that is not used is listed with its material (set_transparency).
        constexpr std::string_view kKnownStatements[] = {"Ka", "map_Kd", "map_d", "norm"};
        if (std::ranges::find(kKnownStatements, line.keyword) == std::end(kKnownStatements))
            unread.count(line);
        if (is_map_statement(line.keyword)) add_map(line, context, library);
    }
}

/// Decodes each image once.
class ImageReader {
public:
    explicit ImageReader(ReadContext& context) : context_(context) {}

    std::optional<Texture> read_map(const TextureUse& map, bool srgb = true) {
        const std::shared_ptr<const Image> image = read_image(map, srgb);
        if (!image) {
            context_.notes.add("images that are not there or of a kind that is not read, drawn "
                               "without",
                               map.place + ": " + quote(map.file));
            add_unsupported(context_.unsupported, "missing-image",
                            map.place + ": " + quote(map.file));
            return std::nullopt;
        }
        if (image->is_clamped)
            context_.notes.add("images with light above 1, clamped to 1",
                               map.place + ": " + quote(map.file));
        const Texture::Wrap wrap = map.is_clamped ? Texture::Wrap::clamp : Texture::Wrap::repeat;
        // Mesh v points down and .obj v up: v' = 1 - ((1 - v) scale + offset).
        const auto& [x, y] = map.scale;
        return Texture{.image = image,
                       .wrap_u = wrap,
                       .wrap_v = wrap,
                       .srgb = srgb,
                       .u_row = vec3(x, 0, map.offset[0]),
                       .v_row = vec3(0, y, 1 - y - map.offset[1])};
    }

private:
    std::shared_ptr<const Image> read_image(const TextureUse& map, bool srgb) {
        if (map.real.empty()) return nullptr;
        const auto [entry, is_new] = images_.try_emplace({map.real.string(), srgb});
        if (is_new)
            entry->second = decode_image(context_.files.read(map.real, map.place), map.file,
                                         map.place + ": " + quote(map.file), context_.account,
                                         srgb);
        return entry->second;
    }

    ReadContext& context_;
    std::map<std::pair<std::string, bool>, std::shared_ptr<const Image>> images_; ///< by file, sRGB
};

constexpr double kUsualGlassIor = 1.5; // index of refraction of a material without Ni

vec3 clamp_colour(const dvec3& colour) { return vec3(glm::clamp(colour, 0.0, 1.0)); }

/// Turns an .obj material, as read from its file, into a material of the engine.
class MaterialConverter {
public:
    MaterialConverter(const MtlMaterial& draft, std::size_t index, ImageReader& maps,
                      ReadContext& context)
        : draft_(draft), index_(index), maps_(maps), context_(context) {}

    Material make_material() {
        kind_ = static_cast<int>(draft_.kind.value_or(0));
        material_ = {.name = draft_.name, .emission = draft_.emission};
        // Without Kd the albedo is white under a map, black if emissive or illum 3, else grey.
        const bool shines = draft_.emission != vec3(0) || kind_ == 3;
        material_.albedo = clamp_colour(draft_.diffuse.value_or(draft_.colour ? dvec3(1)
                                                                : shines      ? dvec3(0)
                                                                              : dvec3(0.8)));
        if (draft_.colour) material_.albedo_texture = maps_.read_map(*draft_.colour);
        if (draft_.normals) material_.normal_texture = maps_.read_map(*draft_.normals, false);
        set_sides();
        set_transparency();
        if (is_glass_)
            set_glass();
        else if (draft_.roughness || draft_.metallic)
            set_factors();
        else
            set_reflection();
        set_clear_coat();
        return material_;
    }

private:
    void report_unsupported(const char* id) {
        add_unsupported_material(context_.unsupported, id, draft_.place, index_);
    }

    void set_sides() {
        const bool is_lamp = draft_.emission != vec3(0);
        material_.two_sided = is_lamp ? draft_.two_sided : !draft_.fixed_normals;
    }

    /// Returns the alpha of `d`, else of `Tr`, which some programs write with the meaning of `d`.
    double read_alpha() {
        const auto unit = [](double number) { return std::clamp(number, 0.0, 1.0); };
        const double by_tr = 1 - unit(draft_.transparency.value_or(0));
        if (!draft_.alpha) return by_tr;
        const double alpha = unit(*draft_.alpha);
        const bool contradicts = draft_.transparency && std::abs(alpha - by_tr) > 1e-4;
        context_.notes.add("materials whose d and Tr contradict each other, drawn by d",
                           draft_.place, contradicts ? 1 : 0);
        return alpha;
    }

    void set_transparency() {
        const double alpha = read_alpha();
        const bool is_glass = kind_ == 4 || kind_ == 6 || kind_ == 7 || kind_ == 9 ||
                              (alpha < 1 && draft_.ior.value_or(1) > 1.01);
        if (is_glass) {
            is_glass_ = true;
            if (draft_.cut) report_unsupported("material-extension");
            return report_unsupported("glass-approximated"), report_unsupported("glass-shadow");
        }
        const bool is_cut = draft_.cut && material_.albedo_texture &&
                            draft_.cut->real == draft_.colour->real;
        if (draft_.cut && !is_cut) report_unsupported("material-extension");
        if (alpha == 1 && !is_cut) return;
        report_unsupported("blend-shadow");
        material_.alpha = static_cast<float>(alpha);
        material_.blended = true, material_.alpha_cutoff = .5f;
    }

    /// Makes a smooth body of glass. Kd tints it, unless Kd is black.
    void set_glass() {
        material_.transmission = 1, material_.roughness = 0, material_.solid = true;
        constexpr double kLargest = std::numeric_limits<float>::max();
        material_.ior = static_cast<float>(
            std::clamp(draft_.ior.value_or(kUsualGlassIor), 1.0, kLargest));
        material_.dielectric_f0 = vec3(static_cast<float>(f0_from_ior(material_.ior)));
        material_.dielectric_f90 = vec3(1);
        if (material_.albedo == vec3(0)) material_.albedo = vec3(1);
    }

    void set_clear_coat() {
        material_.clearcoat = static_cast<float>(
            std::clamp(draft_.clearcoat.value_or(0), 0.0, 1.0));
        material_.clearcoat_roughness = static_cast<float>(
            std::clamp(draft_.clearcoat_roughness.value_or(0), 0.0, 1.0));
        if (material_.clearcoat > 0 && !has_clear_coat(material_)) report_unsupported("clearcoat");
    }

    void set_factors() {
        material_.metallic = static_cast<float>(std::clamp(draft_.metallic.value_or(0), 0.0, 1.0));
        material_.roughness = static_cast<float>(
            std::clamp(draft_.roughness.value_or(1), 0.0, 1.0));
        material_.dielectric_f0 = vec3(kUsualDielectricF0), material_.dielectric_f90 = vec3(1);
    }

    /// Sets the reflection. illum 2, 3 and 8 reflect Ks at any angle, illum 5 follows Schlick's
    /// approximation, and illum 0 and 1 have no highlight. Illum 2 is always rough. The others are
    /// sharp from Ns 100 on and without an Ns. A rough surface has the lobe of width alpha whose
    /// density of normals falls off near the normal as that of Blinn and Phong: alpha^2 = 2 / (Ns +
    /// 2) (Walter et al., "Microfacet Models for Refraction through Rough Surfaces", 2007).
    void set_reflection() {
        const bool reflects_scene = kind_ == 3 || kind_ == 5 || kind_ == 8;
        if (!reflects_scene && draft_.kind.value_or(2) != 2) return;
        const vec3 f0 = clamp_colour(draft_.specular.value_or(dvec3(0)));
        const bool is_sharp = reflects_scene && draft_.shininess.value_or(100) >= 100;
        if (kind_ != 5 && is_sharp && largest_channel(f0) >= kMinMirrorF0) {
            material_.mirror = true, material_.reflectance = f0;
            return;
        }
        const double shininess = std::max(draft_.shininess.value_or(0), 0.0);
        material_.roughness = is_sharp ? 0 : static_cast<float>(std::pow(2 / (shininess + 2), .25));
        material_.dielectric_f0 = f0;
        material_.dielectric_f90 = kind_ == 5 ? vec3(1) : f0;
    }

    const MtlMaterial& draft_;
    std::size_t index_;
    ImageReader& maps_;
    ReadContext& context_;
    Material material_;
    int kind_ = 0;
    bool is_glass_ = false;
};

} // namespace

void read_library(const fs::path& real, const std::string& place, ReadContext& context,
                  MtlLibrary& library) {
    UnreadStatements unread;
    bool is_in_material = false;
    const std::string file = real.string();
    for_each_line(file, context.files.read(real, place), [&](const Line& line) {
        add_statement(library, line, unread, context, is_in_material);
    });
    unread.report(file, context.notes);
}

std::vector<Material> make_materials(const MtlLibrary& library, ReadContext& context) {
    std::vector<Material> materials;
    ImageReader maps(context);
    for (const MtlMaterial& draft : library.drafts)
        materials.push_back(
            MaterialConverter(draft, materials.size(), maps, context).make_material());
    return materials;
}

} // namespace catoptric::scene::obj
