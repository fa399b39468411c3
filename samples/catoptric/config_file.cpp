#include "config_file.hpp"

#include "core/error.hpp"
#include "core/file.hpp"
#include "core/json.hpp"
#include "core/knob.hpp"
#include "session/folders.hpp"

#include <algorithm>
#include <map>

#include <nlohmann/json.hpp>

namespace catoptric::cli {

namespace {

constexpr const char* kNoConfigOption = "--no-config";

bool is_option_given(const std::vector<std::string>& words, const CompletionOption& option) {
    return std::ranges::any_of(words, [&](const std::string& word) {
        return word == option.name || word.starts_with(option.name + "=") ||
               (!option.short_name.empty() && word.starts_with(option.short_name) &&
                !word.starts_with("--"));
    });
}

const CompletionOption* find_option(const CompletionVerb& verb, const std::string& key) {
    const auto found = std::ranges::find(verb.options, "--" + key, &CompletionOption::name);
    return found == verb.options.end() ? nullptr : &*found;
}

/// Returns the command-line words that set the option to this value.
std::vector<std::string> make_option_words(const std::string& place, const CompletionOption& option,
                                           const nlohmann::json& value) {
    const auto refuse = [&](const char* wanted) {
        fail(Failure::bad_data, place, ": wanted ", wanted, ", found ", value.dump());
    };
    if (!option.takes_value) {
        if (!value.is_boolean()) refuse("true or false");
        return value.get<bool>() ? std::vector{option.name} : std::vector<std::string>{};
    }
    std::vector<std::string> words{option.name};
    for (const nlohmann::json& one : value.is_array() ? value : nlohmann::json::array({value})) {
        if (!one.is_string() && !one.is_number()) refuse("a text, a number or a list of them");
        words.push_back(one.is_string() ? one.get<std::string>() : one.dump());
    }
    if (words.size() == 1) refuse("at least one value");
    return words;
}

} // namespace

std::vector<std::string> add_config_options(std::vector<std::string> words,
                                            const std::vector<CompletionVerb>& verbs) {
    if (std::erase(words, kNoConfigOption) > 0 || words.empty()) return words;
    const auto verb = std::ranges::find(verbs, words.front(), &CompletionVerb::name);
    const std::filesystem::path folder = session::find_config_folder(),
                                path = folder / "config.json";
    std::error_code ignored;
    if (verb == verbs.end() || folder.empty() || !std::filesystem::exists(path, ignored))
        return words;
    const std::string file = path.string();
    const auto document = parse_json<nlohmann::json>(file, read_file(path));
    check(document.is_object(), Failure::bad_data, file, ": wanted an object, found ",
          document.dump());
    std::map<std::string, std::vector<std::string>> added; // words added for each option
    const auto add = [&](const std::string& place, const std::string& key,
                         const nlohmann::json& value) {
        const CompletionOption* option = find_option(*verb, key);
        if (option != nullptr && !is_option_given(words, *option))
            added[key] = make_option_words(place, *option, value);
    };
    std::vector<std::string> names;
    for (const CompletionVerb& one : verbs) {
        names.push_back(one.name);
        for (const CompletionOption& option : one.options) names.push_back(option.name.substr(2));
    }
    for (const auto& [key, value] : document.items()) {
        const std::string place = file + ": '" + key + "'";
        check(std::ranges::find(names, key) != names.end(), Failure::bad_data, place,
              ": wanted the name of a verb or an option", suggest_name(key, names));
        if (std::ranges::find(verbs, key, &CompletionVerb::name) == verbs.end())
            add(place, key, value);
    }
    for (const CompletionVerb& one : verbs) {
        if (!document.contains(one.name)) continue;
        const nlohmann::json& options = document[one.name];
        const std::string place = file + ": '" + one.name + "'";
        check(options.is_object(), Failure::bad_data, place, ": wanted an object, found ",
              options.dump());
        std::vector<std::string> of_verb;
        for (const CompletionOption& option : one.options) of_verb.push_back(option.name.substr(2));
        for (const auto& [key, value] : options.items()) {
            check(find_option(one, key) != nullptr, Failure::bad_data, place,
                  ": wanted the name of an option of this verb, found '", key, "'",
                  suggest_name(key, of_verb));
            if (one.name == verb->name) add(place + ": '" + key + "'", key, value);
        }
    }
    for (const auto& [key, option_words] : added)
        words.insert(words.end(), option_words.begin(), option_words.end());
    return words;
}

} // namespace catoptric::cli
