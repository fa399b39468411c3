#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace CLI { // NOLINT(readability-identifier-naming): theirs
class App;
}

// The command line as a table of verbs; the library that reads it is known to one file.
namespace catoptric::cli {

/// A verb: what it takes and what it does. Parsing fills the variables that its options name, so
/// they must outlive it.
class Verb {
public:
    using Take = std::function<void(const std::string&)>;

    explicit Verb(CLI::App& app) : app_(app) {}

    /// Shown under the help.
    void examples(const std::string& text);
    /// Options from here on stand under this heading of the help. Headings come in the order in
    /// which they are first named, kCommonOptions first.
    void heading(const std::string& text);

    enum class Need : std::uint8_t { optional, required };
    void argument(const std::string& name, const std::string& help, std::string& value, Need need);
    /// Any number of words.
    void arguments(const std::string& name, const std::string& help,
                   std::vector<std::string>& values);
    void flag(const std::string& names, const std::string& help, bool& value);
    /// `names` as in "-o,--output"; `type` stands for the value in the help.
    void option(const std::string& names, const std::string& type, const std::string& help,
                std::string& value);
    /// Takes every word that follows.
    void option(const std::string& names, const std::string& type, const std::string& help,
                std::vector<std::string>& values);
    /// `take` gets the text while the line is parsed; what it throws, `CommandLine::parse` throws.
    void option(const std::string& names, const std::string& type, const std::string& help,
                const Take& take);
    /// The same, each time that it is given.
    void repeated(const std::string& names, const std::string& type, const std::string& help,
                  const Take& take);
    void option_without_value(const std::string& names, const std::string& help,
                              const std::function<void()>& take);

    /// Called once the whole line is parsed; returns the exit code.
    void does(std::function<int()> run) { run_ = std::move(run); }

private:
    friend class CommandLine;
    CLI::App& app_;
    std::function<int()> run_;
};

/// Heading of the options that most users need; those named before any other heading.
inline constexpr const char* kCommonOptions = "Common options";

class CommandLine {
public:
    CommandLine(const std::string& name, const std::string& summary, const std::string& version,
                const std::string& examples);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// A further verb, which lives as long as this.
    Verb& add(const std::string& name, const std::string& summary);
    /// In place of verbs: all words are options and arguments of this one.
    Verb& whole();

    /// What the words after the program's name ask for, to be called: a verb's work, or printing
    /// help ("help", "help VERB", "--help") or version. No word prints help to stderr and returns
    /// `usage`'s exit code. Throws `usage` for a word that is no verb, option or argument, naming
    /// the nearest.
    std::function<int()> parse(std::vector<std::string> words);

private:
    void check_verb(const std::string& word) const;
    std::vector<std::string> without_help_verb(std::vector<std::string> words) const;

    std::unique_ptr<CLI::App> app_;
    std::vector<std::unique_ptr<Verb>> verbs_;
    bool is_whole_ = false;
};

} // namespace catoptric::cli
