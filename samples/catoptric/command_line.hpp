#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI { // NOLINT(readability-identifier-naming): theirs
class App;
}

// The command line as a table of verbs. Only one file uses the library that parses it.
namespace catoptric::cli {

/// A verb with its options, arguments and action. Parsing fills the variables of the options, so
/// these must outlive the verb.
class Verb {
public:
    using ValueCallback = std::function<void(const std::string&)>;

    explicit Verb(CLI::App& app) : parser_(app) {}

    /// Sets the examples that follow the help.
    void examples(const std::string& text);
    /// Puts the options added from here on under this heading of the help. Headings appear in the
    /// order of their first use, kCommonOptions first.
    void heading(const std::string& text);

    enum class Need : std::uint8_t { optional, required };
    void argument(const std::string& name, const std::string& help, std::string& value, Need need);
    /// Adds an argument of any number of words.
    void arguments(const std::string& name, const std::string& help,
                   std::vector<std::string>& values);
    void flag(const std::string& names, const std::string& help, bool& value);
    /// Adds an option with names such as "-o,--output". `type` stands for the value in the help.
    void option(const std::string& names, const std::string& type, const std::string& help,
                std::string& value);
    /// Adds an option that takes all words that follow it.
    void option(const std::string& names, const std::string& type, const std::string& help,
                std::vector<std::string>& values);
    /// Adds an option whose text is passed to `take` during parsing. `CommandLine::parse` passes
    /// exceptions of `take` on.
    void option(const std::string& names, const std::string& type, const std::string& help,
                const ValueCallback& take);
    /// Adds an option that may be given several times. Each use calls `take`.
    void repeated(const std::string& names, const std::string& type, const std::string& help,
                  const ValueCallback& take);
    void flag(const std::string& names, const std::string& help, const std::function<void()>& take);

    /// Sets the action that is called after the whole line is parsed. It returns the exit code.
    void action(std::function<int()> run) { run_ = std::move(run); }

private:
    friend class CommandLine;
    CLI::App& parser_;
    std::function<int()> run_;
};

/// An option as a shell completes it.
struct CompletionOption {
    std::string name;            ///< "--size", or "-h" if there is no long name
    std::string short_name = {}; ///< "-o" beside a long name, else empty
    std::string help;
    bool takes_value = false;
};

/// A verb as a shell completes it.
struct CompletionVerb {
    std::string name, summary;
    std::vector<CompletionOption> options;
};

/// Heading of the options that most users need. Options added before any other heading belong to
/// it.
inline constexpr const char* kCommonOptions = "Common options";

class CommandLine {
public:
    CommandLine(const std::string& name, const std::string& summary, const std::string& version,
                const std::string& examples);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// Adds a verb, which lives as long as this object.
    Verb& add_verb(const std::string& name, const std::string& summary);
    /// Returns a single verb in place of a list of verbs. It takes all words as options and
    /// arguments.
    Verb& only_verb();

    /// Parses the words after the program's name and returns the function to call. The function
    /// runs a verb, or prints help ("help", "help VERB", "--help") or the version. Without words,
    /// it prints help to stderr and returns the exit code of `usage`. Throws `usage` for an unknown
    /// verb, option or argument, with the nearest name.
    std::function<int()> parse(std::vector<std::string> words);

    /// Returns all verbs added so far with their options, in the order of the help.
    std::vector<CompletionVerb> completion_verbs() const;

private:
    void check_verb(const std::string& word) const;
    std::vector<std::string> help_as_option(std::vector<std::string> words) const;

    std::unique_ptr<CLI::App> parser_;
    std::vector<std::unique_ptr<Verb>> verbs_;
    bool is_whole_ = false;
};

} // namespace catoptric::cli
