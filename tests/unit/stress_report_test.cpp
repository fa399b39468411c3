// What is written about properties at the extremes.
#include "report/stress.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace {

using namespace catoptric::report;

StressRow row(std::vector<StressCase> cases) {
    return {"N1", "a <stimulus>", "a property", Verdict::pass, "", std::move(cases), {}, 1};
}

TEST(StressRow, TheWorstCaseIsTheOneFurthestBeyondItsLimit) {
    EXPECT_EQ(row({{"half", .5, 1}, {"all", 4, 4}, {"little", 9, 100}}).worst()->what, "all");
    EXPECT_EQ(row({{"over nothing", 1e-9, 0}, {"ten times", 10, 1}}).worst()->what, "over nothing");
    EXPECT_EQ(row({{"no number", std::nan(""), 1}, {"fine", 0, 0}}).worst()->what, "no number");
    EXPECT_EQ(row({{"ugly", 100, 1, true}, {"wrong", 1.1, 1}, {"fine", 1, 1}}).worst()->what,
              "wrong");
    EXPECT_EQ(row({{"ugly", 2, 1, true}, {"fine", 1, 1}}).worst()->what, "ugly");
    EXPECT_EQ(row({}).worst(), nullptr);
}

TEST(StressCase, NoNumberDoesNotHold) {
    EXPECT_FALSE((StressCase{"", std::nan(""), 1}).holds());
    EXPECT_TRUE((StressCase{"", 0, 0}).holds());
    EXPECT_FALSE((StressCase{"", 1e-300, 0}).holds());
}

TEST(Stress, FailsByItsRows) {
    Stress stress;
    stress.rows = {row({}), row({})};
    EXPECT_FALSE(stress.failed());
    for (const Verdict verdict :
         {Verdict::quality_warning, Verdict::unsupported, Verdict::waived}) {
        stress.rows[1].verdict = verdict;
        EXPECT_FALSE(stress.failed()) << name_of(verdict);
    }
    stress.rows[1].verdict = Verdict::fail;
    EXPECT_TRUE(stress.failed());
}

TEST(Stress, JsonHasEveryCaseAndHtmlNoMarkupOfItsTexts) {
    Stress stress;
    stress.rows = {row({{"a", .25, .5}, {"b", std::nan(""), .5}, {"c", 1, .5, true}})};
    const nlohmann::json json = nlohmann::json::parse(to_json(stress));
    EXPECT_EQ(json["rows"][0]["cases"][0], (nlohmann::json{{"what", "a"},
                                                           {"measured", .25},
                                                           {"threshold", .5},
                                                           {"holds", true},
                                                           {"quality", false}}));
    EXPECT_TRUE(json["rows"][0]["measured"].is_null());
    EXPECT_EQ(json["rows"][0]["cases"][1]["holds"], false);
    EXPECT_EQ(json["rows"][0]["cases"][2]["quality"], true);
    EXPECT_THAT(to_html(stress), testing::HasSubstr("a &lt;stimulus&gt;"));
}

} // namespace
