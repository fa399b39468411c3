#include "core/json.hpp"

#include "core/file.hpp"
#include "core/text.hpp"

#include <algorithm>
#include <array>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

namespace catoptric {

namespace {

using Json = nlohmann::json;

constexpr int kMaxNestingDepth = 64;
constexpr int kRangeError = 406; // the parser's error number for a number too large for a double

/// Pairs of a part of the parser's message and the expected token. The first match counts.
constexpr std::array<std::pair<std::string_view, std::string_view>, 12> kTokenNames{
    {{"missing closing quote", "a closing quotation mark"},
     {"control character", "control characters of a text written as \\n, \\t or \\u00XX"},
     {"ill-formed UTF-8", "UTF-8"},
     {"invalid string", "a complete escape sequence, such as \\n or \\u00e9"},
     {"invalid number", "a digit"},
     {"invalid BOM", "the byte order mark of UTF-8, or none"},
     {"; expected string literal", "a key in quotation marks"},
     {"; expected ':'", "':'"},
     {"; expected ']'", "',' or ']'"},
     {"; expected '}'", "',' or '}'"},
     {"; expected end of input", "the end"},
     {"", "a value"}}};

std::string json_position(const std::string& file, std::string_view text, std::size_t at) {
    const std::string_view before = text.substr(0, at);
    const auto lines = std::ranges::count(before, '\n');
    const std::size_t line_start = lines == 0 ? 0 : before.rfind('\n') + 1;
    return file + ": JSON: line " + std::to_string(lines + 1) + ", column " +
           std::to_string(at - line_start + 1);
}

/// Returns the length of the last word of the parser's token, which may also contain the text
/// before the word.
std::size_t last_word_length(const std::string& token) {
    constexpr std::string_view kJsonPunctuation = "[]{}:,";
    if (token.empty() || kJsonPunctuation.find(token.back()) != kJsonPunctuation.npos) return 1;
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    // For a number or a string, the parser's token contains nothing else.
    if (!is_letter(token.back())) return token.size();
    const auto before = std::find_if_not(token.rbegin(), token.rend(), is_letter);
    return static_cast<std::size_t>(before - token.rbegin());
}

/// Returns the text at `at` for a message: the word of `length` characters, cut to 40, or one
/// character.
std::string quote_at(std::string_view text, std::size_t at, std::size_t length) {
    constexpr std::size_t kMaxQuotedBytes = 40;
    if (at >= text.size()) return "the end";
    const std::string_view word = text.substr(at,
                                              std::clamp<std::size_t>(length, 1, kMaxQuotedBytes));
    return "'" + escape(word) + "'" + (length > kMaxQuotedBytes ? "..." : "");
}

class JsonChecker : public nlohmann::json_sax<Json> {
public:
    JsonChecker(const std::string& file, std::string_view text, const JsonMemoryUse& spends)
        : file_(file), text_(text), spends_(spends) {}

    bool null() override { return spend(); }
    bool boolean(bool) override { return spend(); }
    bool number_integer(number_integer_t) override { return spend(); }
    bool number_unsigned(number_unsigned_t) override { return spend(); }
    bool number_float(number_float_t, const string_t&) override { return spend(); }
    bool string(string_t& text) override { return spend(32 + text.size()); }
    bool binary(binary_t&) override { return spend(); }
    bool key(string_t& text) override { return spend(64 + text.size()); }
    bool start_object(std::size_t) override { return enter(); }
    bool start_array(std::size_t) override { return enter(); }
    bool end_object() override { return --depth_ >= 0; }
    bool end_array() override { return --depth_ >= 0; }

    /// `read`: characters read so far, one more at the end of the text. `token`: the last
    /// characters read.
    bool parse_error(std::size_t read, const std::string& token,
                     const Json::exception& error) override {
        const std::string_view words = error.what();
        const bool is_whole = words.find("unexpected") != words.npos || error.id == kRangeError;
        const bool is_end = words.find("unexpected end of input") != words.npos;
        const std::size_t length = is_whole ? last_word_length(token) : 1;
        const std::size_t at = is_end ? text_.size()
                                      : std::min(read - std::min(read, length), text_.size());
        const auto* wanted = std::ranges::find_if(
            kTokenNames, [&](const auto& one) { return words.find(one.first) != words.npos; });
        fail(Failure::bad_data, json_position(file_, text_, at), ": wanted ",
             error.id == kRangeError ? "a number that a double can hold" : wanted->second,
             ", found ", quote_at(text_, at, length));
    }

private:
    /// Reports the memory of a value: 32 bytes in its list or map, and `more` bytes of its own.
    bool spend(std::uint64_t more = 0) {
        if (spends_) spends_(32 + more);
        return true;
    }
    bool enter() {
        check(++depth_ < kMaxNestingDepth, Failure::bad_data, file_,
              ": JSON: wanted nesting below ", kMaxNestingDepth, ", found more");
        return spend(64);
    }

    const std::string& file_;
    std::string_view text_;
    const JsonMemoryUse& spends_;
    int depth_ = 0;
};

} // namespace

void check_json(const std::string& file, std::string_view text, const JsonMemoryUse& spends) {
    JsonChecker reader(file, text, spends);
    Json::sax_parse(text, &reader);
}

std::string read_json_text(const std::filesystem::path& file, const std::string& what,
                           std::uintmax_t max_bytes) {
    std::error_code error;
    check(!std::filesystem::exists(file, error) || std::filesystem::is_regular_file(file, error),
          Failure::bad_data, file.string(), ": wanted a file with ", what,
          ", found something else");
    const std::uintmax_t bytes = std::filesystem::file_size(file, error);
    check(error || bytes <= max_bytes, Failure::bad_data, file.string(), ": wanted ", what,
          " of at most ", max_bytes, " bytes, found ", bytes);
    return read_file(file);
}

} // namespace catoptric
