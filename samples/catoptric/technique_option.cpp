#include "technique_option.hpp"

#include "core/error.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "session/engine.hpp"
#include "session/technique_choice.hpp"

namespace catoptric::cli {

void add_technique_options(Verb& verb, TechniqueOption& drawn, const std::string& otherwise) {
    const auto store = [](const char* option, std::string& value) {
        return [option, &value](const std::string& text) {
            check(!text.empty(), Failure::usage, option, ": wanted a name, found ''");
            value = text;
        };
    };
    verb.option(
        "--technique", "T",
        "technique of all mirrors, name[:knob=value,...], see 'list techniques'; excludes --plan" +
            (otherwise.empty() ? "" : " (" + otherwise + ")"),
        store("--technique", drawn.technique));
    verb.option(
        "--plan", "P",
        "technique per mirror, as \"PATTERN=T ...\" or a file.json. PATTERN: number from 1, list "
        "2,3, name with * and ?, or * for the rest",
        store("--plan", drawn.plan));
}

std::string check_choice(const TechniqueOption& drawn, const std::string& verb) {
    const auto& [technique, plan] = drawn;
    check(technique.empty() || plan.empty(), Failure::usage,
          "--technique and --plan: wanted one of them, found both");
    if (plan.empty()) {
        require_option(!technique.empty(), verb, "--technique T",
                       "see 'catoptric list techniques'; or --plan");
        const auto parse = [&] { return session::parse_technique(technique); };
        check(parse_option("--technique", parse).technique != "plan", Failure::usage,
              "--technique: wanted one technique for all mirrors, found '", technique,
              "'; --plan takes several");
        return technique;
    }
    const bool is_file = plan.ends_with(".json"); // may hold `auto` for all mirrors
    std::string text = is_file ? "plan:" + plan : plan;
    const auto parse = [&] { return session::parse_technique(text); };
    check(parse_option("--plan", parse).technique == "plan" || is_file, Failure::usage,
          "--plan: wanted \"PATTERN=TECHNIQUE ...\" or a file that ends in .json, found '", plan,
          "'; --technique takes one technique for all mirrors");
    return text;
}

} // namespace catoptric::cli
