// Tests that each row of `catoptric stress` names its mutation: the one rule of
// tests/mutations/rules.toml whose wrong code the row must detect.
#include "places.hpp"
#include "stress/property.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <map>
#include <regex>

namespace {

using namespace catoptric;

/// Returns the names of the mutation rules, by the stress row that must detect each.
std::multimap<std::string, std::string> list_mutation_rules_by_row() {
    std::multimap<std::string, std::string> rules;
    std::ifstream file(test::source_folder() / "tests/mutations/rules.toml");
    const std::regex entry(R"re((name|row) = "(\w+)")re");
    std::string name;
    for (std::string line; std::getline(file, line);) {
        std::smatch match;
        if (!std::regex_match(line, match, entry)) continue;
        if (match[1] == "name")
            name = match[2];
        else
            rules.emplace(match[2], name);
    }
    return rules;
}

TEST(StressRows, EachStressRowNamesTheMutationThatItDetects) {
    std::multimap<std::string, std::string> named;
    for (const stress::Property* row : stress::properties())
        named.emplace(row->id, row->turned_red_by);
    EXPECT_FALSE(named.empty());
    EXPECT_EQ(list_mutation_rules_by_row(), named);
}

} // namespace
