#include "core/error.hpp"
#include "scene/number.hpp"
#include "scene/obj_text.hpp"

#include <algorithm>

namespace catoptric::scene::obj {

namespace {

constexpr std::string_view kSpace = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
    const std::size_t first = text.find_first_not_of(kSpace);
    if (first == text.npos) return {};
    return text.substr(first, text.find_last_not_of(kSpace) + 1 - first);
}

/// Takes the first word off the front of `text`.
std::string_view take_word(std::string_view& text) {
    text = trimmed(text);
    const std::string_view word = text.substr(0, text.find_first_of(kSpace));
    text = trimmed(text.substr(word.size()));
    return word;
}

/// Takes one line off the front of `text`, joined with those that follow a backslash.
std::string take_line(std::string_view& text, std::size_t& number) {
    std::string line;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        const std::string_view part = text.substr(0, end);
        text.remove_prefix(end == text.npos ? text.size() : end + 1);
        ++number;
        line += trimmed(part);
        if (!line.ends_with('\\')) break;
        line.back() = ' ';
    }
    return line;
}

} // namespace

void for_each_line(const std::string& file, std::string_view text,
                   const std::function<void(const Line&)>& body) {
    for (std::size_t number = 0; !text.empty();) {
        const std::size_t first = number + 1;
        const std::string content = take_line(text, number);
        std::string_view rest = content;
        std::string keyword(take_word(rest));
        if (keyword == "#" && take_word(rest) == "catoptric" && !rest.empty())
            keyword += take_word(rest);
        else if (keyword.empty() || keyword.front() == '#')
            continue;
        body({.where = file + ":" + std::to_string(first), .keyword = keyword, .rest = rest});
    }
}

std::vector<std::string_view> words(const Line& line) {
    std::vector<std::string_view> list;
    std::string_view rest = line.rest;
    while (!rest.empty() && rest.front() != '#') list.push_back(take_word(rest));
    return list;
}

std::vector<double> numbers(const Line& line, const std::vector<std::string_view>& words,
                            std::size_t first, std::size_t count) {
    check(words.size() >= first + count, Failure::bad_data, line.where, ": '", line.keyword,
          "' wants ", count, " numbers, found ", words.size() - std::min(first, words.size()));
    std::vector<double> list;
    for (std::size_t i = first; i < first + count; ++i) {
        const std::optional<double> number = parse_number(words[i]);
        check(number.has_value(), Failure::bad_data, line.where, ": '", line.keyword,
              "' wants finite numbers, found '", words[i], "'");
        list.push_back(*number);
    }
    return list;
}

} // namespace catoptric::scene::obj
