#include "core/text.hpp"
#include "import/obj_text.hpp"
#include "scene/number.hpp"

#include <algorithm>

namespace catoptric::scene::obj {

namespace {

constexpr std::string_view kBlankCharacters = " \t\r\v\f";
constexpr std::size_t kMaxWordsPerLine =
    4096; // no valid statement that is split into words has more

std::string_view trim_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kBlankCharacters);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(kBlankCharacters) + 1 - first);
}

/// Removes one line from the front of `text` and returns it, trimmed. `line_end` ends it. Lines
/// that end in a backslash are joined with the next in `joined`. Adds the number of lines read to
/// `number`.
std::string_view take_line(std::string_view& text, char line_end, std::size_t& number,
                           std::string& joined) {
    joined.clear();
    while (!text.empty()) {
        const std::size_t end = text.find(line_end);
        std::string_view part = trim_blanks(text.substr(0, end));
        text.remove_prefix(end == text.npos ? text.size() : end + 1);
        ++number;
        const bool goes_on = part.ends_with('\\');
        if (!goes_on && joined.empty()) return part;
        if (goes_on) part.remove_suffix(1);
        joined.append(part).append(" ");
        if (!goes_on) break;
    }
    return joined;
}

} // namespace

std::string_view take_word(std::string_view& text) {
    text = trim_blanks(text);
    const std::string_view word = text.substr(0, text.find_first_of(kBlankCharacters));
    text = trim_blanks(text.substr(word.size()));
    return word;
}

void for_each_line(const std::string& file, std::string_view text,
                   const std::function<void(const Line&)>& body) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
    // Without any line feed, carriage returns end the lines, as on the Macintosh of old.
    const char line_end = text.find('\n') == text.npos ? '\r' : '\n';
    std::string joined, remark;
    for (std::size_t number = 0; !text.empty();) {
        const std::size_t first = number + 1;
        std::string_view rest = take_line(text, line_end, number, joined);
        std::string_view keyword = take_word(rest);
        if (keyword == "#" && take_word(rest) == "catoptric" && !rest.empty()) {
            remark = "#";
            remark += take_word(rest);
            keyword = remark;
        } else if (keyword.empty() || keyword.front() == '#') {
            continue;
        }
        body({.file = &file, .number = first, .keyword = keyword, .rest = rest});
    }
}

std::vector<std::string_view> split_words(const Line& line) {
    std::vector<std::string_view> list;
    std::string_view rest = line.rest;
    while (!rest.empty() && rest.front() != '#' && list.size() < kMaxWordsPerLine)
        list.push_back(take_word(rest));
    return list;
}

std::size_t count_words(std::string_view text) {
    std::size_t count = 0;
    for (; !text.empty() && text.front() != '#'; ++count) take_word(text);
    return count;
}

double parse_word(const Line& line, std::string_view word) {
    if (const std::optional<double> number = parse_number(word)) return *number;
    fail(Failure::bad_data, line.place(), ": '", line.keyword, "' wants finite numbers, found ",
         quote(word));
}

std::vector<double> parse_words(const Line& line, const std::vector<std::string_view>& words,
                                std::size_t first, std::size_t count) {
    if (words.size() < first + count)
        fail(Failure::bad_data, line.place(), ": '", line.keyword, "' wants ", count,
             " numbers, found ", words.size() - std::min(first, words.size()));
    std::vector<double> list;
    for (std::size_t i = first; i < first + count; ++i) list.push_back(parse_word(line, words[i]));
    return list;
}

void UnreadStatements::count(const Line& line) {
    auto at = counts_.find(line.keyword);
    if (at == counts_.end())
        at = counts_
                 .try_emplace(counts_.size() < 40 ? std::string(line.keyword) : "", KeywordCount())
                 .first;
    if (at->second.lines++ == 0) at->second.first = line.number;
}

void UnreadStatements::report(const std::string& file, LoaderNotes& notes) const {
    for (const auto& [keyword, count] : counts_)
        notes.add(keyword.empty() ? "other statements, not read"
                                  : "statements " + quote(keyword) + ", not read",
                  file + ":" + std::to_string(count.first), count.lines);
}

dvec3 parse_line_vector(const Line& line) {
    dvec3 vector(0);
    std::string_view rest = line.rest;
    for (int i = 0; i < 3; ++i) {
        if (rest.empty() || rest.front() == '#')
            fail(Failure::bad_data, line.place(), ": '", line.keyword, "' wants 3 numbers, found ",
                 i);
        vector[i] = parse_word(line, take_word(rest));
    }
    return vector;
}

} // namespace catoptric::scene::obj
