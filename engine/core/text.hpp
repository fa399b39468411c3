#pragma once

#include <string>
#include <string_view>
#include <vector>

// Text from outside the program (names in a file, a parser's words, a path) before it goes to a
// terminal, a message or a report.
namespace catoptric {

/// Returns `text` with all characters escaped that a terminal might interpret. Control characters
/// and bytes that are not UTF-8 become `\x1b`. The controls U+0080..9F, line separators and marks
/// that change the direction of writing become `\u{202e}`. Printable text and the bytes in `kept`
/// are unchanged.
std::string escape(std::string_view text, std::string_view kept = {});

/// Returns `escape(text)` in single quotes, for messages. Of more than 80 bytes only the first are
/// returned, with the number of bytes.
std::string quote(std::string_view text);

/// Returns the parts between any of `separators`: "a,,b" has three, "" has one.
std::vector<std::string> split(std::string_view text, std::string_view separators);

} // namespace catoptric
