// Tests of text from users and files that is printed to a terminal, a message or a report.
#include "core/knob.hpp"
#include "core/text.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

using namespace catoptric;

TEST(Text, ControlCharactersAreEscaped) {
    EXPECT_EQ(escape("a\x1b[2Jb"), "a\\x1b[2Jb");
    EXPECT_EQ(escape(std::string("a\0b\x7f\r\n\t", 7)), "a\\x00b\\x7f\\x0d\\x0a\\x09");
    EXPECT_EQ(escape("\xc2\x9b"
                     "31m"),
              "\\u{9b}31m"); // the control character U+009B (CSI)
    EXPECT_EQ(escape("\xe2\x80\xae"
                     "gpj\xe2\x81\xa6"),
              "\\u{202e}gpj\\u{2066}");
    EXPECT_EQ(escape("one\ntwo\r", "\n"), "one\ntwo\\x0d");
}

TEST(Text, BytesThatAreNotUtf8AreEscaped) {
    EXPECT_EQ(escape("\x9b"
                     "31m"),
              "\\x9b31m");
    EXPECT_EQ(escape("\xc0\x9b"), "\\xc0\\x9b"); // overlong UTF-8 encoding
    EXPECT_EQ(escape("\xe0\x80\x9b"),
              "\\xe0\\x80\\x9b"); // overlong UTF-8 encoding
    EXPECT_EQ(escape("\xed\xa0\x80"),
              "\\xed\\xa0\\x80"); // half of a surrogate pair
    EXPECT_EQ(escape("\xf4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");
    EXPECT_EQ(escape("x\xe2\x82"), "x\\xe2\\x82"); // truncated UTF-8 character
}

TEST(Text, PrintableTextIsUnchanged) {
    for (const std::string text : {"plain 'text' \\x1b", "Küche – 台所 🪞", ""})
        EXPECT_EQ(escape(text), text);
    EXPECT_EQ(escape(escape("\x1b\xff")), escape("\x1b\xff"));
}

TEST(Text, QuotesOfLongTextsAreCut) {
    EXPECT_EQ(quote("a\x1b"), "'a\\x1b'");
    EXPECT_EQ(quote(std::string(80, 'x')), "'" + std::string(80, 'x') + "'");
    EXPECT_EQ(quote(std::string(20'000, 'x')), "'" + std::string(80, 'x') + "...' (20000 bytes)");
    // A quote never ends in the middle of a character.
    EXPECT_EQ(quote(std::string(79, 'x') + "üüü"), "'" + std::string(79, 'x') + "...' (85 bytes)");
}

TEST(Suggestion, NearestNameFindsTyposWithinItsLimits) {
    std::vector<std::string> names(200'000, "material");
    names[7] = "materiel";
    EXPECT_EQ(nearest_name("materiell", names), "materiel");
    EXPECT_EQ(nearest_name(std::string(65, 'm'), std::vector{std::string(65, 'm')}), "");
    EXPECT_EQ(nearest_name("abc", std::vector{std::string(1 << 20, 'a'), std::string("abd")}),
              "abd");
    names.assign(200'000, "zzzzzzzz");
    names.back() = "material"; // the name is after the last name that is searched
    EXPECT_EQ(nearest_name("materia", names), "");
    EXPECT_EQ(suggest_name("a\x1b"
                           "b",
                           std::vector{std::string("a\x1b")}),
              " (did you mean 'a\\x1b'?)");
}

} // namespace
