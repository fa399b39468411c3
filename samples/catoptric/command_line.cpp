#include "command_line.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "output.hpp"
#include "parse.hpp"

#include <algorithm>
#include <iostream>
#include <sstream>

#include <CLI/CLI.hpp>

namespace catoptric::cli {

namespace {

/// Help without runs of empty lines.
std::string tidy(std::string text) {
    for (std::size_t at; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);
    return text;
}

/// What CLI11 was told to let through, so that the nearest name can be suggested here.
void refuse_extras(const CLI::App& verb) {
    std::vector<std::string> names;
    for (const CLI::Option* option : verb.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string> extras = verb.remaining();
    for (const std::string& extra : extras) {
        if (!extra.starts_with('-') || extra == "--") continue;
        const std::string name = extra.substr(0, extra.find('='));
        fail(Failure::usage, "'", verb.get_name(), "' has no option '", name, "'",
             did_you_mean(name, names));
    }
    check(extras.empty(), Failure::usage, "'", verb.get_name(),
          "' wanted no further argument, found '", extras.empty() ? "" : extras.front(), "'");
}

} // namespace

void Verb::examples(const std::string& text) { app_.footer(text); }

void Verb::heading(const std::string& text) { app_.option_defaults()->group(text); }

void Verb::argument(const std::string& name, const std::string& help, std::string& value,
                    Need need) {
    app_.add_option(name, value, help)->type_name("")->required(need == Need::required);
}

void Verb::arguments(const std::string& name, const std::string& help,
                     std::vector<std::string>& values) {
    app_.add_option(name, values, help)->type_name("");
}

void Verb::flag(const std::string& names, const std::string& help, bool& value) {
    app_.add_flag(names, value, help);
}

void Verb::option(const std::string& names, const std::string& type, const std::string& help,
                  std::string& value) {
    app_.add_option(names, value, help)->type_name(type);
}

void Verb::option(const std::string& names, const std::string& type, const std::string& help,
                  std::vector<std::string>& values) {
    app_.add_option(names, values, help)->type_name(type);
}

void Verb::option(const std::string& names, const std::string& type, const std::string& help,
                  const Take& take) {
    app_.add_option_function<std::string>(names, take, help)->type_name(type);
}

void Verb::repeated(const std::string& names, const std::string& type, const std::string& help,
                    const Take& take) {
    const auto take_all = [take](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) take(text);
    };
    app_.add_option_function<std::vector<std::string>>(names, take_all, help)
        ->type_name(type)
        ->allow_extra_args(false);
}

void Verb::option_without_value(const std::string& names, const std::string& help,
                                const std::function<void()>& take) {
    app_.add_flag_callback(names, take, help);
}

CommandLine::CommandLine(const std::string& name, const std::string& summary,
                         const std::string& version, const std::string& examples)
    : app_(std::make_unique<CLI::App>(summary, name)) {
    app_->require_subcommand(1);
    app_->footer(examples);
    app_->set_version_flag("--version", version);
    app_->set_help_flag("-h,--help", "this text");
    app_->get_formatter()->label("SUBCOMMAND", "VERB");
}

CommandLine::~CommandLine() = default;

Verb& CommandLine::add(const std::string& name, const std::string& summary) {
    CLI::App* app = app_->add_subcommand(name, summary);
    app->group("Verbs");
    app->set_help_flag("-h,--help", "this text");
    app->allow_extras(); // refuse_extras says more
    return *verbs_.emplace_back(std::make_unique<Verb>(*app));
}

Verb& CommandLine::whole() {
    app_->require_subcommand(0);
    app_->allow_extras();
    is_whole_ = true;
    return *verbs_.emplace_back(std::make_unique<Verb>(*app_));
}

/// The first word is a verb, or asks for help or the version.
void CommandLine::check_verb(const std::string& word) const {
    std::vector<std::string> names;
    for (const CLI::App* verb : app_->get_subcommands(nullptr)) names.push_back(verb->get_name());
    const std::vector<std::string> flags{"-h", "--help", "--version"};
    for (const auto& known : {names, flags})
        if (std::ranges::find(known, word) != known.end()) return;
    fail(Failure::usage, "wanted a verb (", join(names), "), found '", word, "'",
         did_you_mean(word, word.starts_with('-') ? flags : names));
}

std::function<int()> CommandLine::parse(std::vector<std::string> words) {
    if (words.empty() && !is_whole_) {
        std::cerr << tidy(app_->help()) << std::flush;
        return [] { return static_cast<int>(Failure::usage); };
    }
    const std::string program = is_whole_ ? app_->get_name()
                                          : app_->get_name() + " " + words.front();
    if (!is_whole_) check_verb(words.front());
    std::ranges::reverse(words); // as CLI11 wants a vector
    try {
        app_->parse(words);
    } catch (const CLI::ParseError& error) {
        std::ostringstream text, ignored;
        if (app_->exit(error, text, ignored) == 0) // help or version was asked for
            return [text = tidy(text.str())] { return put(text), 0; };
        fail(Failure::usage, error.what(), " (try '", program, " --help')");
    }
    const auto verb = std::ranges::find_if(
        verbs_, [](const std::unique_ptr<Verb>& one) { return one->app_.parsed(); });
    refuse_extras((*verb)->app_);
    return (*verb)->run_;
}

} // namespace catoptric::cli
