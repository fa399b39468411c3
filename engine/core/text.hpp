#pragma once

#include <string>
#include <string_view>
#include <vector>

// Text that came from outside (names in a file, a parser's words, a path) on its way to a terminal,
// a message or a report.
namespace catoptric {

/// `text` with everything that a terminal might obey written out: control characters and bytes that
/// are not UTF-8 as `\x1b`, the controls U+0080..9F, line separators and marks that turn the
/// direction of writing as `\u{202e}`. What is printable already comes back as it is, and so do the
/// bytes of `kept`.
std::string printable(std::string_view text, std::string_view kept = {});

/// `printable` in single quotes, for messages: of more than 80 bytes only the first, and how many
/// there are.
std::string in_quotes(std::string_view text);

/// Parts between any of `separators`; "a,,b" has three, "" has one.
std::vector<std::string> split(std::string_view text, std::string_view separators);

} // namespace catoptric
