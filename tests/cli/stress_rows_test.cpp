// Runs every row of `catoptric stress` in small pictures, because a row that nobody runs can crash
// for days.
#include "cli/program.hpp"
#include "stress/property.hpp"

namespace {

using nlohmann::json;

TEST_F(CommandLineTest, EveryStressRowHoldsInSmallPictures) {
    const test::ProcessResult ended = run_cli({"stress", "--json", "--size", "64x64"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err << ended.out;
    const json document = json::parse(ended.out);
    EXPECT_EQ(document["complete"], true);
    EXPECT_EQ(document["rows"].size(), catoptric::stress::properties().size());
    for (const json& row : document["rows"]) {
        EXPECT_THAT(row["verdict"], testing::AnyOf("pass", "quality-warning")) << row;
        EXPECT_FALSE(row["cases"].empty()) << row["id"];
        for (const json& one : row["cases"])
            EXPECT_TRUE(one["holds"] == true || !one["seen"].get<std::string>().empty()) << one;
    }
}

} // namespace
