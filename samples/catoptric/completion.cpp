// catoptric completion: prints a script with which a shell completes verbs, options, techniques and
// scenes. The script follows from the tables of the program.
#include "core/error.hpp"
#include "options.hpp"
#include "output.hpp"
#include "parse.hpp"
#include "report/text.hpp"
#include "scene/built_in.hpp"
#include "session/engine.hpp"
#include "verbs.hpp"

#include <algorithm>
#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kCompletionExamples = R"(Examples:
  source <(catoptric completion bash)       for this shell
  catoptric completion fish > ~/.config/fish/completions/catoptric.fish)";

const std::vector<std::string> kShells{"bash", "zsh", "fish"};
/// Options whose value is the name of a technique.
const std::vector<std::string> kTechniqueOptions{"--technique", "--techniques", "--reference"};
/// Verbs whose arguments are no scenes or files.
const std::vector<std::string> kVerbsWithoutFiles{"list", "stress", "completion"};

bool is_one_of(const std::vector<std::string>& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

std::vector<std::string> technique_names() {
    std::vector<std::string> names{"auto"};
    for (const session::TechniqueInfo& technique : session::techniques())
        names.push_back(technique.name);
    return names;
}

/// Returns the words that complete the verb's arguments, beside names of files.
std::vector<std::string> argument_words(const std::string& verb) {
    if (verb == "list") return {"techniques", "scenes", "devices", "metrics", "costs"};
    if (verb == "completion") return kShells;
    std::vector<std::string> names;
    if (!is_one_of(kVerbsWithoutFiles, verb) && verb != "diff")
        for (const scene::BuiltInScene& scene : scene::built_in_scenes())
            names.push_back(scene.name);
    return names;
}

std::vector<std::string> option_names(const CompletionVerb& verb) {
    std::vector<std::string> names;
    for (const CompletionOption& option : verb.options) names.push_back(option.name);
    return names;
}

/// Returns the text in single quotes in a form that bash, zsh and fish read as plain words, without
/// characters that have a special meaning in one of them.
std::string quote_for_shells(std::string text) {
    std::erase_if(text, [](char c) { return c == '\'' || c == '\\' || c == '[' || c == ']'; });
    std::ranges::replace(text, ':', ',');
    return "'" + text + "'";
}

std::string write_bash_completion(const std::vector<CompletionVerb>& verbs) {
    std::string names, cases;
    for (const CompletionVerb& verb : verbs) {
        names += verb.name + " ";
        cases += "    " + verb.name + ")\n        options='" +
                 report::join_texts(option_names(verb), " ") + "'\n        words='" +
                 report::join_texts(argument_words(verb.name), " ") +
                 "'\n        files=" + (is_one_of(kVerbsWithoutFiles, verb.name) ? "" : "-f") +
                 " ;;\n";
    }
    return "# bash completion of catoptric; written by 'catoptric completion bash'\n"
           "_catoptric() {\n"
           "    local cur=${COMP_WORDS[COMP_CWORD]} verb=${COMP_WORDS[1]} options words files\n"
           "    if ((COMP_CWORD == 1)); then\n"
           "        COMPREPLY=($(compgen -W '" +
           names +
           "help --help --version' -- \"$cur\"))\n        return\n    fi\n"
           "    case $verb in\n" +
           cases + "    help) options= words='" + names +
           "' files= ;;\n    *) return ;;\n    esac\n"
           "    case ${COMP_WORDS[COMP_CWORD-1]} in\n    " +
           report::join_texts(kTechniqueOptions, "|") + ") words='" +
           report::join_texts(technique_names(), " ") +
           "' files= ;;\n    esac\n"
           "    [[ $cur != -* ]] || words=$options files=\n"
           "    COMPREPLY=($(compgen -W \"$words\" -- \"$cur\") $(compgen $files -- \"$cur\"))\n"
           "}\n"
           "complete -o filenames -F _catoptric catoptric\n";
}

std::string write_zsh_completion(const std::vector<CompletionVerb>& verbs) {
    std::string names, cases;
    for (const CompletionVerb& verb : verbs) {
        names += "        " + verb.name + ":" + quote_for_shells(verb.summary) + "\n";
        cases += "    " + verb.name + ") _arguments \\\n";
        for (const CompletionOption& option : verb.options) {
            const bool is_technique = is_one_of(kTechniqueOptions, option.name);
            const std::string value = is_technique
                                          ? ":technique:(" +
                                                report::join_texts(technique_names(), " ") + ")"
                                      : option.takes_value ? ":value:_files"
                                                           : "";
            std::string help = quote_for_shells(option.help);
            help = help.substr(1, help.size() - 2);
            cases += "        '" + option.name + "[" + help + "]" + value + "' \\\n";
        }
        const std::vector<std::string> words = argument_words(verb.name);
        cases += "        '*:argument:_alternative \"words:word:(" +
                 report::join_texts(words, " ") + ")\" \"files:file:_files\"' ;;\n";
    }
    return "#compdef catoptric\n"
           "# zsh completion of catoptric; written by 'catoptric completion zsh'\n"
           "_catoptric() {\n    local -a verbs=(\n" +
           names +
           "        help:'options of a verb'\n    )\n"
           "    if ((CURRENT == 2)); then\n        _describe verb verbs\n        return\n    fi\n"
           "    local verb=$words[2]\n"
           "    shift words\n    ((CURRENT--))\n"
           "    case $verb in\n" +
           cases + "    help) _describe verb verbs ;;\n    esac\n}\n_catoptric \"$@\"\n";
}

std::string write_fish_completion(const std::vector<CompletionVerb>& verbs) {
    std::string text = "# fish completion of catoptric; written by 'catoptric completion fish'\n"
                       "complete -c catoptric -n __fish_use_subcommand -f\n";
    for (const CompletionVerb& verb : verbs)
        text += "complete -c catoptric -n __fish_use_subcommand -a " + verb.name + " -d " +
                quote_for_shells(verb.summary) + "\n";
    for (const CompletionVerb& verb : verbs) {
        const std::string start = "complete -c catoptric -n '__fish_seen_subcommand_from " +
                                  verb.name + "'";
        if (const std::vector<std::string> words = argument_words(verb.name); !words.empty())
            text += start + (is_one_of(kVerbsWithoutFiles, verb.name) ? " -f" : "") + " -a '" +
                    report::join_texts(words, " ") + "'\n";
        for (const CompletionOption& option : verb.options) {
            const bool is_long = option.name.starts_with("--");
            text += start + (is_long ? " -l " : " -s ") + option.name.substr(is_long ? 2 : 1) +
                    (option.takes_value ? " -r" : "");
            if (is_one_of(kTechniqueOptions, option.name))
                text += " -f -a '" + report::join_texts(technique_names(), " ") + "'";
            text += " -d " + quote_for_shells(option.help) + "\n";
        }
    }
    return text;
}

} // namespace

void add_completion_verb(CommandLine& program) {
    Verb& verb = program.add_verb("completion",
                                  "print a script that completes commands in bash, zsh or fish");
    verb.examples(kCompletionExamples);
    const auto shell = std::make_shared<std::string>();
    verb.argument("SHELL", "bash, zsh or fish", *shell, Verb::Need::required);
    verb.action([shell, &program] {
        const std::size_t index = parse_choice("completion", *shell, kShells);
        const std::vector<CompletionVerb> verbs = program.completion_verbs();
        print_result(index == 0   ? write_bash_completion(verbs)
                     : index == 1 ? write_zsh_completion(verbs)
                                  : write_fish_completion(verbs));
        return 0;
    });
}

} // namespace catoptric::cli
