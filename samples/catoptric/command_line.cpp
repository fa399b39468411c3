#include "command_line.hpp"

#include "core/error.hpp"
#include "core/knob.hpp"
#include "core/text.hpp"
#include "output.hpp"
#include "parse.hpp"

#include <algorithm>
#include <iostream>
#include <sstream>
#include <utility>

#include <CLI/CLI.hpp>

namespace catoptric::cli {

namespace {

constexpr const char* kHelpVerb = "help";
constexpr std::size_t kHelpWidth = 80;
constexpr std::size_t kHelpColumn = 28;   ///< column of the descriptions of options
constexpr std::ptrdiff_t kHelpLines = 80; ///< a longer help names less common options only

/// Returns `text` in lines of at most kHelpWidth columns. The first line starts in column
/// `indent`; the others are indented to it.
std::string wrap_text(const std::string& text, std::size_t indent) {
    std::istringstream words(text);
    std::string lines, word;
    std::size_t column = indent;
    while (words >> word) {
        const bool is_first = column == indent;
        if (!is_first && column + 1 + word.size() > kHelpWidth) {
            lines += "\n" + std::string(indent, ' ');
            column = indent;
        } else if (!is_first) {
            lines += ' ';
            ++column;
        }
        lines += word;
        column += word.size();
    }
    return lines;
}

/// Returns `left` with `help` beside it, or below it if `left` is too wide.
std::string format_entry(const std::string& left, const std::string& help) {
    const std::string start = "  " + left;
    const bool fits = start.size() + 2 <= kHelpColumn;
    return start +
           (fits ? std::string(kHelpColumn - start.size(), ' ')
                 : "\n" + std::string(kHelpColumn, ' ')) +
           wrap_text(help, kHelpColumn) + "\n";
}

/// Returns the text with each paragraph in lines of kHelpWidth columns. Lines that begin with
/// a blank, and the heading above them, stay as they are.
std::string wrap_paragraphs(const std::string& text) {
    std::istringstream lines(text);
    std::string result, line, prose;
    const auto end_paragraph = [&] {
        if (!prose.empty()) result += wrap_text(std::exchange(prose, {}), 0) + "\n";
    };
    while (std::getline(lines, line)) {
        if (!line.empty() && line.front() != ' ' && !line.ends_with(':')) {
            prose += line + ' ';
            continue;
        }
        end_paragraph();
        result += line + "\n";
    }
    end_paragraph();
    return result;
}

std::string merge_empty_lines(std::string text) {
    for (std::size_t at; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);
    return text;
}

/// Formats the help of CLI11 in kHelpWidth columns. A help of more than kHelpLines lines
/// describes the common options, names the others, and keeps the examples of the footer if all of
/// it does not fit; --help-all describes all.
class HelpFormatter : public CLI::Formatter {
public:
    std::string make_help(const CLI::App* app, std::string name,
                          CLI::AppFormatMode mode) const override {
        const std::string whole = merge_empty_lines(CLI::Formatter::make_help(app, name, mode));
        if (mode != CLI::AppFormatMode::Normal || std::ranges::count(whole, '\n') <= kHelpLines)
            return whole;
        std::string text = make_description(app) + make_usage(app, std::move(name)) +
                           make_positionals(app) +
                           make_group(kCommonOptions, false, list_options(app, kCommonOptions)) +
                           "\nFurther options, which --help-all describes:\n";
        for (const std::string& group : app->get_groups()) {
            if (group.empty() || group == kCommonOptions) continue;
            std::string names;
            for (const CLI::Option* option : list_options(app, group))
                names += (names.empty() ? "" : " ") + option->get_name();
            if (!names.empty()) text += format_entry(group, names);
        }
        const std::string footer = make_footer(app);
        if (std::ranges::count(text + footer, '\n') <= kHelpLines) return text + footer;
        return text + footer.substr(0, footer.find("\n\n", 1) + 1) +
               "\n--help-all explains the options further.\n";
    }
    std::string make_option(const CLI::Option* option, bool is_positional) const override {
        return format_entry(make_option_name(option, is_positional) + make_option_opts(option),
                            make_option_desc(option));
    }
    std::string make_subcommand(const CLI::App* verb) const override {
        return format_entry(verb->get_name(), verb->get_description());
    }
    std::string make_footer(const CLI::App* app) const override {
        return app->get_footer().empty() ? "" : "\n" + wrap_paragraphs(app->get_footer());
    }

private:
    static std::vector<const CLI::Option*> list_options(const CLI::App* app,
                                                        const std::string& group) {
        return app->get_options([&](const CLI::Option* option) {
            return option->get_group() == group && option->nonpositional();
        });
    }
};

/// Throws `usage` for unknown words, with the nearest known name. CLI11 is told to accept unknown
/// words, because its own message suggests no name.
void refuse_unknown_words(const CLI::App& verb, const std::string& program) {
    std::vector<std::string> names;
    for (const CLI::Option* option : verb.get_options())
        for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    const std::vector<std::string> extras = verb.remaining();
    for (const std::string& extra : extras) {
        if (!extra.starts_with('-') || extra == "--") continue;
        const std::string name = extra.substr(0, extra.find('='));
        const std::string nearest = suggest_name(name, names);
        fail(Failure::usage, "'", verb.get_name(), "' has no option '", name, "'",
             nearest.empty() ? "; '" + program + " --help-all' lists all" : nearest);
    }
    check(extras.empty(), Failure::usage, "'", verb.get_name(),
          "' wanted no further argument, found '", extras.empty() ? "" : extras.front(), "'");
}

/// Returns the option of `app` or of the parsed verb with the longest name that the parser's
/// message contains; null: none.
const CLI::Option* find_named_option(const CLI::App& app, const std::string& words) {
    const CLI::Option* longest = nullptr;
    std::vector<const CLI::App*> apps{&app};
    for (const CLI::App* verb : app.get_subcommands()) apps.push_back(verb);
    for (const CLI::App* one : apps)
        for (const CLI::Option* option : one->get_options())
            if (const std::string name = option->get_name();
                words.find(name) != std::string::npos &&
                (longest == nullptr || name.size() > longest->get_name().size()))
                longest = option;
    return longest;
}

/// Returns the error message for an error of the parser CLI11, in the wording of this program.
std::string describe_parse_error(const CLI::App& app, const CLI::ParseError& error) {
    const CLI::Option* option = find_named_option(app, error.what());
    if (option == nullptr) return "wanted one verb with options and arguments of its own";
    const std::string name = option->get_name(), type = option->get_type_name();
    const auto found = [&] { return ", found '" + join_with_commas(option->results()) + "'"; };
    if (dynamic_cast<const CLI::RequiredError*>(&error) != nullptr)
        return "wanted " + name + ", " + option->get_description() + ", found nothing";
    if (option->get_expected_max() == 0) return name + ": wanted no value" + found();
    const auto most = static_cast<std::size_t>(option->get_items_expected_max());
    if (option->count() > most)
        return name + ": wanted once, found " + std::to_string(option->count()) + " times";
    return name + ": wanted a value" + (type.empty() ? "" : ", " + type) +
           (option->count() == 0 ? ", found none" : found());
}

} // namespace

void Verb::examples(const std::string& text) { parser_.footer(text); }

void Verb::heading(const std::string& text) { parser_.option_defaults()->group(text); }

void Verb::argument(const std::string& name, const std::string& help, std::string& value,
                    Need need) {
    parser_.add_option(name, value, help)->type_name("")->required(need == Need::required);
}

void Verb::arguments(const std::string& name, const std::string& help,
                     std::vector<std::string>& values) {
    parser_.add_option(name, values, help)->type_name("");
}

void Verb::flag(const std::string& names, const std::string& help, bool& value) {
    parser_.add_flag(names, value, help);
}

void Verb::option(const std::string& names, const std::string& type, const std::string& help,
                  std::string& value) {
    parser_.add_option(names, value, help)->type_name(type);
}

void Verb::option(const std::string& names, const std::string& type, const std::string& help,
                  std::vector<std::string>& values) {
    parser_.add_option(names, values, help)->type_name(type);
}

void Verb::option(const std::string& names, const std::string& type, const std::string& help,
                  const ValueCallback& take) {
    parser_.add_option_function<std::string>(names, take, help)->type_name(type);
}

void Verb::repeated(const std::string& names, const std::string& type, const std::string& help,
                    const ValueCallback& take) {
    const auto take_all = [take](const std::vector<std::string>& texts) {
        for (const std::string& text : texts) take(text);
    };
    parser_.add_option_function<std::vector<std::string>>(names, take_all, help)
        ->type_name(type)
        ->allow_extra_args(false);
}

void Verb::flag(const std::string& names, const std::string& help,
                const std::function<void()>& take) {
    parser_.add_flag_callback(names, take, help);
}

CommandLine::CommandLine(const std::string& name, const std::string& summary,
                         const std::string& version, const std::string& examples)
    : parser_(std::make_unique<CLI::App>(summary, name)) {
    parser_->formatter(std::make_shared<HelpFormatter>());
    parser_->option_defaults()->group(kCommonOptions);
    parser_->require_subcommand(1);
    parser_->footer(examples);
    parser_->set_version_flag("-V,--version", version);
    parser_->set_help_flag("-h,--help", "print this help");
    parser_->get_formatter()->label("SUBCOMMAND", "VERB");
}

CommandLine::~CommandLine() = default;

Verb& CommandLine::add_verb(const std::string& name, const std::string& summary) {
    CLI::App* app = parser_->add_subcommand(name, summary);
    app->group("Verbs");
    app->set_help_flag("-h,--help", "print this help");
    app->set_help_all_flag("--help-all", "describe all options");
    app->allow_extras(); // refuse_unknown_words has the better message
    return *verbs_.emplace_back(std::make_unique<Verb>(*app));
}

Verb& CommandLine::only_verb() {
    parser_->require_subcommand(0);
    parser_->set_help_all_flag("--help-all", "describe all options");
    parser_->allow_extras();
    is_whole_ = true;
    return *verbs_.emplace_back(std::make_unique<Verb>(*parser_));
}

/// Replaces "help" by "--help", and "help VERB" by "VERB --help".
std::vector<std::string> CommandLine::help_as_option(std::vector<std::string> words) const {
    if (is_whole_ || words.front() != kHelpVerb) return words;
    check(words.size() <= 2, Failure::usage, "'help' wanted at most one verb, found '",
          words.size() > 2 ? words[2] : "", "'");
    words.erase(words.begin());
    if (!words.empty()) check_verb(words.front());
    words.emplace_back("--help");
    return words;
}

/// Throws `usage` unless the first word is a verb or asks for help or the version.
void CommandLine::check_verb(const std::string& word) const {
    std::vector<std::string> names;
    for (const CLI::App* verb : parser_->get_subcommands(nullptr))
        names.push_back(verb->get_name());
    names.emplace_back(kHelpVerb);
    const std::vector<std::string> flags{"-h", "--help", "-V", "--version"};
    for (const auto& known : {names, flags})
        if (std::ranges::find(known, word) != known.end()) return;
    fail(Failure::usage, "wanted a verb (", join_with_commas(names), "), found '", word, "'",
         suggest_name(word, word.starts_with('-') ? flags : names));
}

std::vector<CompletionVerb> CommandLine::completion_verbs() const {
    std::vector<CompletionVerb> verbs;
    for (const CLI::App* app : parser_->get_subcommands(nullptr)) {
        CompletionVerb verb{app->get_name(), app->get_description(), {}};
        for (const CLI::Option* option : app->get_options()) {
            const std::vector<std::string>&longs = option->get_lnames(),
                  &shorts = option->get_snames();
            if (longs.empty() && shorts.empty()) continue; // the option is a positional argument
            verb.options.push_back(
                {.name = longs.empty() ? "-" + shorts.front() : "--" + longs.front(),
                 .short_name = longs.empty() || shorts.empty() ? "" : "-" + shorts.front(),
                 .help = option->get_description(),
                 .takes_value = option->get_items_expected_max() > 0});
        }
        verbs.push_back(std::move(verb));
    }
    return verbs;
}

std::function<int()> CommandLine::parse(std::vector<std::string> words) {
    if (words.empty() && !is_whole_) {
        std::cerr << merge_empty_lines(parser_->help()) << std::flush;
        return [] { return static_cast<int>(Failure::usage); };
    }
    words = help_as_option(std::move(words));
    const std::string program = is_whole_ ? parser_->get_name()
                                          : parser_->get_name() + " " + words.front();
    if (!is_whole_) check_verb(words.front());
    std::ranges::reverse(words); // CLI11 takes a vector in reverse order
    try {
        parser_->parse(words);
    } catch (const CLI::ParseError& error) {
        std::ostringstream text, ignored;
        if (parser_->exit(error, text, ignored) == 0) // the user asked for help or version
            return [text = merge_empty_lines(text.str())] { return print_result(text), 0; };
        fail(Failure::usage, describe_parse_error(*parser_, error), " (try '", program,
             " --help')");
    }
    const auto verb = std::ranges::find_if(
        verbs_, [](const std::unique_ptr<Verb>& one) { return one->parser_.parsed(); });
    refuse_unknown_words((*verb)->parser_, program);
    return (*verb)->run_;
}

} // namespace catoptric::cli
