#pragma once

#include "command_line.hpp"

#include <string>
#include <vector>

// Defaults of options from a file of the user: $XDG_CONFIG_HOME/catoptric/config.json, or
// ~/.config/catoptric/config.json.
namespace catoptric::cli {

/// Returns the words after the program's name, and after them the options that the user's file sets
/// and the words do not. Without such a file, with --no-config (which is removed), or if the first
/// word is no verb, nothing is added. Throws `bad_data` with the file, the member, and what was
/// wanted and found.
///
/// The file holds an object. A member with the name of an option sets it for each verb that has it:
/// {"size": "256x256"}. A member with the name of a verb holds options of this verb, which win:
/// {"compare": {"techniques": ["reuse", "secant"], "quiet": true}}. Values are texts, numbers,
/// lists of them, and true for options without a value.
std::vector<std::string> add_config_options(std::vector<std::string> words,
                                            const std::vector<CompletionVerb>& verbs);

} // namespace catoptric::cli
