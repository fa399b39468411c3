#include "command.hpp"

#include "session/access.hpp"
#include "session/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace catoptric::view {

namespace {

/// Options that the state replaces, or that a single picture does not need.
constexpr std::array<std::string_view, 16> kReplacedOptions{
    "--camera",    "--time",   "--size",        "--technique",    "--plan",   "--model",
    "--frames",    "--warmup", "--screenshot",  "--exposure",     "--timing", "--progress",
    "--budget-ms", "--audit",  "--audit-every", "--audit-percent"};
constexpr std::array<std::string_view, 5> kIgnoredFlags{"--animate", "--validate", "--json",
                                                        "--quiet", "--verbose"};

template <std::size_t N>
bool is_one_of(const std::array<std::string_view, N>& names, std::string_view word) {
    return std::ranges::find(names, word) != names.end();
}

/// Returns whether the word is -q, -v, or both, such as -qv.
bool is_quiet_or_verbose_flag(const std::string& word) {
    return word.size() > 1 && word.starts_with('-') &&
           word.find_first_not_of("qv", 1) == std::string::npos;
}

} // namespace

std::vector<std::string> render_words(const std::vector<std::string>& words, const ViewState& state,
                                      const std::string& camera, uvec2 size) {
    std::vector<std::string> made{"render"};
    const auto end = std::ranges::find(words,
                                       "--"); // end of the options; the scene's name may follow
    const auto options = static_cast<std::size_t>(end - words.begin());
    for (std::size_t i = 0; i < options; ++i) {
        const std::string& word = words[i];
        const std::string name = word.substr(0, word.find('='));
        if (is_one_of(kIgnoredFlags, word) || is_quiet_or_verbose_flag(word)) continue;
        if (is_one_of(kReplacedOptions, name)) {
            if (name == word) ++i; // the next word is the option's value
            continue;
        }
        made.push_back(word);
    }
    for (const std::string& word : plan_words(
             state.mode == ViewMode::answers ? set_knob(state.plan, "show", "state") : state.plan))
        made.push_back(word);
    made.insert(made.end(), {"--camera", camera, "--time", fmt::format("{}", state.motion.time),
                             "--size", fmt::format("{}x{}", size.x, size.y), "--exposure",
                             fmt::format("{}", state.exposure), "--model",
                             session::work_name(state.model), "-o", "view.png"});
    made.insert(made.end(), end, words.end());
    return made;
}

std::string quote_for_shell(const std::string& word) {
    constexpr std::string_view kUnquotedCharacters =
        "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
        "0123456789_-+=:,./@%";
    const bool is_plain = !word.empty() &&
                          word.find_first_not_of(kUnquotedCharacters) == std::string::npos;
    return is_plain ? word : session::quote_for_shell(word);
}

std::string render_command(const std::vector<std::string>& words, const ViewState& state,
                           const std::string& camera, uvec2 size) {
    std::string text = "catoptric";
    for (const std::string& word : render_words(words, state, camera, size))
        text += " " + quote_for_shell(word);
    return text;
}

} // namespace catoptric::view
