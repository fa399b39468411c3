#include "settings.hpp"

#include "core/error.hpp"
#include "core/file.hpp"

#include <nlohmann/json.hpp>

#include <bit>
#include <cmath>
#include <cstdlib>

namespace catoptric::view {

namespace fs = std::filesystem;
using Json = nlohmann::json;

namespace {

constexpr std::uint32_t kMaxWindowSide = 16384;

template <typename Value, typename Good>
void read_setting_member(const Json& document, const char* name, Value& value,
                         const Good& is_good) {
    const auto found = document.find(name);
    if (found == document.end()) return;
    try {
        const Value said = found->get<Value>();
        if (is_good(said)) value = said;
    } catch (const Json::exception&) {
        // A value of another type, written by hand or by another version, is ignored.
    }
}

} // namespace

fs::path settings_file() {
    const auto absolute = [](const char* variable) {
        const char* text = std::getenv(variable);
        const fs::path path = text ? text : "";
        return path.is_absolute() ? path : fs::path();
    };
    const fs::path config = absolute("XDG_CONFIG_HOME"), home = absolute("HOME");
    if (!config.empty()) return config / "catoptric" / "view.json";
    return home.empty() ? home : home / ".config" / "catoptric" / "view.json";
}

ViewerSettings parse_settings(const std::string& text) {
    ViewerSettings settings;
    const Json document = Json::parse(text, nullptr, false);
    if (!document.is_object()) return settings;
    const auto any = [](bool) { return true; };
    const auto pixels = [](std::uint32_t n) { return n > 0 && n <= kMaxWindowSide; };
    read_setting_member(document, "width", settings.window.x, pixels);
    read_setting_member(document, "height", settings.window.y, pixels);
    if (settings.window.x == 0 || settings.window.y == 0) settings.window = {0, 0};
    read_setting_member(document, "panels", settings.shows_panels, any);
    read_setting_member(document, "flies", settings.flies, any);
    read_setting_member(document, "speed", settings.speed,
                        [](double s) { return std::isfinite(s) && std::abs(s) <= 16; });
    read_setting_member(document, "gain", settings.gain, [](int gain) {
        return gain >= 1 && gain <= 64 && std::has_single_bit(static_cast<unsigned>(gain));
    });
    return settings;
}

std::string serialise_settings(const ViewerSettings& settings) {
    return Json{{"width", settings.window.x},      {"height", settings.window.y},
                {"panels", settings.shows_panels}, {"flies", settings.flies},
                {"speed", settings.speed},         {"gain", settings.gain}}
               .dump(2) +
           "\n";
}

ViewerSettings load_settings(const fs::path& file) {
    try {
        if (!file.empty()) return parse_settings(read_file(file));
    } catch (const Error&) {
        // No readable file: use defaults.
    }
    return {};
}

void save_settings(const ViewerSettings& settings, const fs::path& file) {
    if (file.empty()) return;
    std::error_code error; // write_file reports a failure
    fs::create_directories(file.parent_path(), error);
    write_file(file, serialise_settings(settings));
}

} // namespace catoptric::view
