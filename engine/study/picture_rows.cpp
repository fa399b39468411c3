#include "study/picture_rows.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "core/text.hpp"
#include "measure/display.hpp"
#include "measure/findings.hpp"
#include "measure/masks.hpp"
#include "measure/picture_file.hpp"
#include "measure/srgb.hpp"
#include "report/json.hpp"
#include "session/scene_info.hpp"
#include "session/technique_choice.hpp"
#include "study/views.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace catoptric::study {

namespace {

measure::SampleSummary unknown_time() {
    measure::SampleSummary time;
    time.median = time.p05 = time.p95 = time.mad = NAN;
    return time;
}

measure::Picture flip_vertically(const measure::Picture& picture) {
    measure::Picture turned(picture.width, picture.height);
    for (int y = 0; y < picture.height; ++y)
        std::copy_n(&picture.at(0, y), picture.width, &turned.at(0, picture.height - 1 - y));
    return turned;
}

/// Returns the difference over the pixels of the mask, without FLIP, after exposure and clamping.
measure::Difference plain_error(const measure::Picture& picture, const ComparedReference& truth,
                                const measure::Mask& mask, double exposure) {
    const std::vector<float> no_flip(picture.pixels.size());
    return masked_error(picture, {truth.hdr}, mask, no_flip, exposure);
}

/// Returns the picture with a function of each colour channel, clamped to [0,1] before.
template <class Curve>
measure::Picture apply_curve(measure::Picture picture, Curve curve) {
    for (vec3& pixel : picture.pixels)
        for (int channel = 0; channel < 3; ++channel)
            pixel[channel] = static_cast<float>(
                curve(static_cast<double>(std::clamp(pixel[channel], 0.F, 1.F))));
    return picture;
}

/// Returns the fault of the picture's curve as the end of a sentence, empty if there is none. The
/// curve is wrong if the values fit the reference twice as well with the sRGB curve removed (EXR
/// and Radiance files) or applied (PNG files), and better than at any other exposure. `picture`:
/// linear light, as its file was understood.
std::string describe_wrong_curve(const measure::Picture& picture, bool is_png,
                                 const ComparedReference& truth, double exposure) {
    const measure::Mask all(picture.pixels.size(), 255);
    const auto find_rmse = [&](const measure::Picture& tried) {
        return plain_error(tried, truth, all, exposure).rmse;
    };
    const double error = find_rmse(picture);
    if (error < 2 * measure::kEightBitStep) return "";
    double corrected = 0; // error with the other curve
    if (is_png) {
        const measure::Picture shown = apply_curve(measure::apply_exposure(picture, exposure),
                                                   measure::srgb_from_linear);
        corrected = find_rmse(measure::apply_exposure(shown, -exposure));
    } else { // a displayed picture usually contains the exposure
        const measure::Picture decoded = apply_curve(picture, measure::linear_from_srgb);
        corrected = std::min(find_rmse(decoded),
                             find_rmse(measure::apply_exposure(decoded, -exposure)));
    }
    if (corrected > error / 2) return "";
    for (int thirds = -12; thirds <= 12; ++thirds) // of a stop
        if (find_rmse(measure::apply_exposure(picture, thirds / 3.)) <= corrected) return "";
    return is_png ? "its values seem to be linear light; wanted values with the sRGB curve in a PNG"
                  : "its values seem to have the sRGB curve of a display; wanted linear light in "
                    "EXR and Radiance files";
}

// Share of the pixels without reflections that must be off before their light is called different.
// A rasteriser alone puts the outlines of surfaces and shadows on other pixels than rays do.
constexpr double kMinOtherLight = 0.1;

/// Throws `bad_data` if a folder has a views.json with other views than the comparison's own view
/// and the drawn views `drawn`.
void check_folder(const std::string& folder, const std::vector<measure::View>& drawn,
                  const Request& base) {
    const std::filesystem::path file = std::filesystem::path(folder) / "views.json";
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) return;
    const auto document = parse_json<nlohmann::json>(file.string(), read_file(file));
    const nlohmann::json list = document.is_object() ? document.value("views", nlohmann::json())
                                                     : nlohmann::json();
    for (std::size_t i = 0; i <= drawn.size(); ++i) {
        const measure::CameraFacts camera = i == 0 ? make_camera_facts(base.camera, base.time)
                                                   : drawn[i - 1].camera;
        const nlohmann::json wanted{
            {"camera", nlohmann::json(report::camera_json(camera))},
            {"name", view_picture_name(i)},
            {"time", nlohmann::json(report::number_json(i == 0 ? base.time : drawn[i - 1].time))}};
        check(list.is_array() && i < list.size() && list[i] == wanted, Failure::bad_data,
              file.string(), ": wanted the views of this comparison, found another ",
              view_picture_name(i),
              "; scene, --views, --seed, --camera and --time must be those of 'catoptric views'");
    }
}

/// Throws `bad_data` unless the picture can be read to its end, has the size, and all its values
/// are finite.
void check_row_picture(const std::string& file, uvec2 size) {
    measure::PictureReader picture_reader(file, [&](int columns, int rows) {
        check(uvec2(columns, rows) == size, Failure::bad_data, file, ": wanted a picture of ",
              size.x, "x", size.y, " pixels, as the comparison (--size), found ", columns, "x",
              rows);
    });
    std::vector<vec3> row(size.x);
    for (int y = 0; y < picture_reader.height(); ++y) {
        picture_reader.read_rows(y, row);
        for (std::size_t x = 0; x < row.size(); ++x)
            check(std::isfinite(row[x].r) && std::isfinite(row[x].g) && std::isfinite(row[x].b),
                  Failure::bad_data, file, ": pixel (", x, ", ", y,
                  "): wanted three finite numbers, found ", row[x].r, " ", row[x].g, " ", row[x].b);
    }
}

} // namespace

std::string picture_row_name(const std::string& name, std::size_t index) {
    std::string safe;
    for (const char c : name.substr(0, 40)) {
        const bool is_plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') ||
                              (c >= 'a' && c <= 'z') || c == '-' || c == '_';
        safe += is_plain ? c : '-';
    }
    return fmt::format("picture{}-{}", index + 1, safe);
}

std::string view_picture_name(std::size_t view) { return fmt::format("view-{:03}", view); }

std::optional<std::string> find_view_picture(const std::string& path, std::size_t view) {
    namespace fs = std::filesystem;
    std::error_code error; // a path that cannot be examined is read as a file, which gives the
                           // error
    const auto [folder, layer] = measure::locate_picture(path);
    if (!fs::is_directory(folder, error))
        return view == 0 ? std::optional<std::string>(path) : std::nullopt;
    std::vector<std::string> found;
    for (const char* ending : {".exr", ".hdr", ".png"})
        if (const fs::path file = folder / (view_picture_name(view) + ending);
            fs::exists(file, error))
            found.push_back(file.string() + (layer.empty() ? "" : ":" + layer));
    check(found.size() == 1, Failure::bad_data, path, ": wanted one ", view_picture_name(view),
          ".exr, .hdr or .png, found ", found.empty() ? "none" : "several");
    return found.front();
}

void check_picture_rows(const CompareRequest& request) {
    std::vector<std::string> names;
    const auto drawn = std::ranges::find(request.studies, "views", &StudyChoice::name);
    const std::size_t views = drawn != request.studies.end() && drawn->count > 1
                                  ? static_cast<std::size_t>(drawn->count)
                                  : 0;
    const bool has_folder = std::ranges::any_of(request.pictures, [](const auto& picture) {
        std::error_code error;
        return std::filesystem::is_directory(measure::locate_picture(picture.second).file, error);
    });
    std::vector<measure::View> drawn_views;
    if (has_folder && views > 0) drawn_views = draw_views(request.base, static_cast<int>(views));
    for (const std::string& text : request.base.techniques)
        names.push_back(parse_technique(text).label);
    for (const auto& [name, file] : request.pictures) {
        check(!name.empty(), Failure::usage, "--row ", quote("=" + file),
              ": wanted NAME=PICTURES with a name, found none");
        check(std::ranges::find(names, name) == names.end(), Failure::usage, "--row ", quote(name),
              ": wanted a name that no other row has");
        names.push_back(name);
        check_folder(file, drawn_views, request.base);
        for (std::size_t view = 0; view <= views; ++view)
            if (const std::optional<std::string> picture = find_view_picture(file, view))
                check_row_picture(*picture, request.base.size);
    }
}

measure::Picture read_row_picture(const std::string& file, double exposure) {
    const measure::Picture picture = measure::read_picture(file);
    return measure::is_png(file) ? measure::apply_exposure(picture, -exposure) : picture;
}

report::Row make_picture_row(const std::string& name, std::size_t index,
                             const measure::Picture& picture, const ComparedReference& truth,
                             const std::vector<std::uint32_t>& hits, std::size_t mirrors,
                             double exposure) {
    report::Row row;
    row.technique = "picture";
    row.label = name;
    row.image = picture_row_name(name, index);
    for (measure::SampleSummary report::Row::*time :
         {&report::Row::gpu_ms, &report::Row::frame_ms, &report::Row::cpu_record_ms,
          &report::Row::wall_ms, &report::Row::cpu_ms})
        row.*time = unknown_time();
    TechniqueResult part;
    part.hdr = picture;
    part.display = measure::to_display(picture, exposure);
    fill_row_errors(row, part, truth, hits, mirrors, exposure);
    return row;
}

std::vector<std::string> picture_row_warnings(const std::string& name, const std::string& file,
                                              const measure::Picture& picture, double rmse,
                                              const ComparedReference& truth,
                                              const std::vector<std::uint32_t>& hits,
                                              double exposure) {
    const std::string begin = "'" + name + "': ";
    const std::string curve = describe_wrong_curve(picture, measure::is_png(file), truth, exposure);
    if (!curve.empty()) return {begin + curve};
    // Only surfaces that reflect nothing are compared, because techniques draw reflections
    // differently.
    measure::Mask beside(hits.size());
    std::ranges::transform(hits, beside.begin(),
                           [](std::uint32_t hit) { return hit == 0 ? 255 : 0; });
    if (std::ranges::count(beside, 255) == 0) return {};
    std::vector<std::string> warnings;
    const measure::Difference error = plain_error(picture, truth, beside, exposure),
                              turned = plain_error(flip_vertically(picture), truth, beside,
                                                   exposure);
    if (turned.rmse < error.rmse / 2)
        warnings.push_back(begin + "its picture is upside down, as far as the pixels beside the "
                                   "mirrors tell");
    else if (error.rmse > std::max(std::abs(rmse), measure::kEightBitStep) &&
             error.off > kMinOtherLight)
        warnings.push_back(begin +
                           fmt::format("its rmse is {:.3g} beside the mirrors and {:.3g} on them: "
                                       "its light, exposure or camera differs, not its reflections "
                                       "alone",
                                       error.rmse, rmse));
    return warnings;
}

} // namespace catoptric::study
