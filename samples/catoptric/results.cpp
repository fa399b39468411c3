// catoptric results: writes a site of static pages about many reports.
#include "core/error.hpp"
#include "options.hpp"
#include "parse.hpp"
#include "report/json.hpp"
#include "results_site.hpp"
#include "verbs.hpp"

#include <fmt/format.h>

#include <memory>

namespace catoptric::cli {

namespace {

constexpr const char* kResultsExamples = R"(Examples:
  catoptric results add out/report.json site
  catoptric results add merged/results.json site
  catoptric results build site

'add' checks a report of compare, or the results.json of 'sweep merge', and puts it into SITE/reports. 'build' writes index.html and a page for each scene:
the front of each device, from its latest report, and the history of each row by commit.)";

struct ResultsOptions {
    std::vector<std::string> words;
    OutputOptions output_options;
};

int run_results(const ResultsOptions& options) {
    const std::vector<std::string>& words = options.words;
    check(!words.empty(), Failure::usage, "'results' needs an action: add or build");
    const bool adds = parse_choice("results", words.front(), {"add", "build"}) == 0;
    check(words.size() == (adds ? 3 : 2), Failure::usage, "'results ", words.front(), "': wanted ",
          adds ? "REPORT.json SITE" : "SITE", ", found ", words.size() - 1, " arguments");
    if (adds) {
        check_output_folder(words[2]);
        const AddedReport added = add_report(words[1], words[2]);
        if (options.output_options.json)
            print_result(report::serialise({{"schema", "catoptric/results-added/1"},
                                            {"report", added.name},
                                            {"comparisons", added.comparisons},
                                            {"known", added.is_known}}));
        print_note(options.output_options,
                   added.is_known
                       ? "the site has this report: " + added.name
                       : fmt::format("added: {}, {} {}", added.name, added.comparisons,
                                     added.comparisons == 1 ? "comparison" : "comparisons"));
        return 0;
    }
    const BuiltSite built = build_site(words[1]);
    if (options.output_options.json)
        print_result(report::serialise({{"schema", "catoptric/results-built/1"},
                                        {"index", words[1] + "/index.html"},
                                        {"pages", built.pages},
                                        {"reports", built.reports}}));
    print_note(options.output_options, fmt::format("written: {}/index.html, {} pages from {} "
                                                   "reports",
                                                   words[1], built.pages, built.reports));
    return 0;
}

} // namespace

void add_results_verb(CommandLine& program) {
    const auto options = std::make_shared<ResultsOptions>();
    Verb& verb = program.add_verb("results",
                                  "collect reports, and write a site with a page for each scene");
    verb.examples(kResultsExamples);
    verb.arguments("ACTION", "add REPORT.json SITE, or build SITE", options->words);
    add_output_options(verb, options->output_options);
    verb.action([options] { return run_results(*options); });
}

} // namespace catoptric::cli
