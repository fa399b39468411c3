// Every row of stress names wrong code that is there, and one line of the batches builds it.
#include "places.hpp"
#include "stress/property.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

namespace {

using namespace catoptric;

const std::filesystem::path kMutations = test::source_folder() / "tests/mutations";

bool is_there(const std::string& patch) {
    return std::filesystem::exists(kMutations / "stress" / (patch + ".patch")) ||
           std::filesystem::exists(kMutations / (patch + ".patch"));
}

std::multiset<std::string> batched() {
    std::multiset<std::string> pairs;
    std::ifstream file(kMutations / "stress/batches");
    for (std::string line; std::getline(file, line);) {
        std::istringstream words(line.starts_with('#') ? "" : line);
        for (std::string pair; words >> pair;) pairs.insert(pair);
    }
    return pairs;
}

TEST(StressRows, EachNamesWrongCodeThatIsThere) {
    for (const stress::Property* row : stress::properties())
        EXPECT_TRUE(is_there(std::string(row->turned_red_by)))
            << row->id << " names '" << row->turned_red_by << "'";
}

TEST(StressRows, TheBatchesBuildWhatEachRowNamesOnce) {
    std::multiset<std::string> named;
    for (const stress::Property* row : stress::properties())
        named.insert(std::string(row->id) + ":" + std::string(row->turned_red_by));
    EXPECT_EQ(batched(), named);
}

TEST(StressRows, EveryPatchOfTheFolderIsNamed) {
    std::set<std::string> named;
    for (const stress::Property* row : stress::properties()) named.emplace(row->turned_red_by);
    for (const auto& entry : std::filesystem::directory_iterator(kMutations / "stress"))
        EXPECT_TRUE(entry.path().extension() != ".patch" ||
                    named.contains(entry.path().stem().string()))
            << entry.path();
}

} // namespace
