// Tests of plans as text and as files: which rule applies to which mirror, and which plans are
// refused. Nothing is rendered.
#include "reflect/plan.hpp"
#include "session/plan_file.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include "core/file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace {

using namespace catoptric;
using testing::ElementsAre;

const std::vector<std::string> kMirrorNames{"left ball", "front", "back", "far ball"};

/// Returns the technique that a plan assigns to each mirror, as written in the plan.
std::vector<std::string>
list_technique_labels(const std::string& text,
                      const std::vector<std::string>& names = kMirrorNames) {
    const reflect::Assignment assignment = reflect::assign_techniques(reflect::parse_plan(text),
                                                                      names);
    std::vector<std::string> result;
    for (const std::uint32_t choice : assignment.of_mirror)
        result.push_back(assignment.choices[choice].label);
    return result;
}

TEST(PlanText, SingleTechniqueAppliesToAnyNumberOfMirrors) {
    EXPECT_THAT(
        list_technique_labels("secant:face=64"),
        ElementsAre("secant:face=64", "secant:face=64", "secant:face=64", "secant:face=64"));
    EXPECT_EQ(reflect::assign_techniques(reflect::parse_plan("reuse"), {}).choices.size(), 1u);
}

TEST(PlanText, NumberWinsOverNameAndNameOverStar) {
    EXPECT_THAT(list_technique_labels("*=reuse *ball=secant 4=march"),
                ElementsAre("secant", "reuse", "reuse", "march"));
    EXPECT_THAT(list_technique_labels("4=march *ball=secant *=reuse"),
                ElementsAre("secant", "reuse", "reuse", "march"));
    // A pattern with a wildcard, such as `?*`, ranks as a name even if it matches all mirrors. Only
    // `*` alone ranks below names.
    EXPECT_THAT(list_technique_labels("*=reuse ?*=secant"),
                ElementsAre("secant", "secant", "secant", "secant"));
}

TEST(PlanText, FirstRuleWinsBetweenRulesOfEqualRank) {
    EXPECT_THAT(list_technique_labels("2=march 2=secant *=reuse *=parallax"),
                ElementsAre("reuse", "march", "reuse", "reuse"));
    EXPECT_THAT(list_technique_labels("b*=march *k=secant *=reuse"),
                ElementsAre("reuse", "reuse", "march", "reuse"));
}

TEST(PlanText, RuleListsMixNumbersAndNames) {
    EXPECT_THAT(list_technique_labels("3,front=secant:steps=1 *=reuse"),
                ElementsAre("reuse", "secant:steps=1", "secant:steps=1", "reuse"));
    // Each item of a list is ranked separately: number 2 wins over the name `front`, but number 4
    // wins over the name `far*`.
    EXPECT_THAT(list_technique_labels("front=march 2,far*=secant 4=layered *=reuse"),
                ElementsAre("reuse", "secant", "reuse", "layered"));
}

TEST(PlanText, NumberSelectsAMirrorByPositionNotByName) {
    EXPECT_THAT(list_technique_labels("2=march *=reuse", {"2", "1"}),
                ElementsAre("reuse", "march"));
}

TEST(PlanText, RulesWithEqualTechniquesShareAChoice) {
    const reflect::Assignment assignment = reflect::assign_techniques(
        reflect::parse_plan("1=reuse:face=256 2=march *=reuse"), kMirrorNames);
    EXPECT_EQ(assignment.choices.size(), 2u);
    EXPECT_THAT(assignment.of_mirror, ElementsAre(0, 1, 0, 0));
    EXPECT_THAT(assignment.patterns, ElementsAre("1", "2", "*", "*"));
}

void expect_plan_refused(const std::string& text, const std::vector<std::string>& words,
                         Failure failure = Failure::usage) {
    test::expect_error([&] { reflect::assign_techniques(session::read_plan(text), kMirrorNames); },
                       failure, words);
}

TEST(PlanText, InvalidPlansAreRefusedWithTheReason) {
    expect_plan_refused("9=reuse *=march", {"pattern '9'", "matches no mirror", "4 mirrors",
                                            "1 'left ball'", "4 'far ball'"});
    expect_plan_refused("0=reuse *=march", {"pattern '0'"});
    expect_plan_refused("auto:face=64", {"'auto:face=64'", "auto alone", "found ':face=64'"});
    expect_plan_refused("2,frnt=reuse *=march", {"pattern 'frnt'", "did you mean 'front'"});
    expect_plan_refused("1=reuse 2=march 4=secant", {"no rule for mirror 3 'back'"});
    expect_plan_refused("1=rouse *=march", {"no technique 'rouse'", "did you mean 'reuse'"});
    expect_plan_refused("1=reuse:fase=3 *=march", {"fase"});
    expect_plan_refused("1=reuse secant", {"wanted PATTERN=TECHNIQUE, found 'secant'"});
    expect_plan_refused("=reuse *=march", {"found '=reuse'"});
    expect_plan_refused("1,,2=reuse *=march", {"pattern '1,,2' has an empty entry"});
    expect_plan_refused("1= *=march", {"no technique ''"});
}

/// Returns a word of one to five characters that often stand in plans.
std::string draw_plan_word(std::mt19937& random) {
    constexpr std::string_view kCharacters = "abuto*?=:,. \t019-_%{}\"'\\/~[]#\xc3\xa9\x01";
    std::string word(1 + random() % 5, ' ');
    for (char& c : word) c = kCharacters[random() % kCharacters.size()];
    return word;
}

TEST(PlanText, DrawnWordsAreRefusedAsUsage) {
    std::mt19937 random(1);
    std::vector<std::string> words{"x", "=", "*=x", ",", ":", "auto:", "auto:x", "*", "*=", "=x"};
    while (words.size() < 3000) words.push_back(draw_plan_word(random));
    for (const std::string& word : words) {
        try {
            reflect::parse_plan(word);
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::usage) << word;
            const std::string text = error.what();
            EXPECT_TRUE(text.find("there are naive, ") != text.npos ||
                        text.find("wanted ") != text.npos || text.find("empty") != text.npos)
                << word << ": " << text;
        } // any other exception fails the test
    }
}

TEST(PlanText, DrawnKnobsAndValuesAreRefusedWithTheNearestOrAllNames) {
    std::mt19937 random(2);
    for (const reflect::Technique* technique : reflect::techniques()) {
        const std::string name(technique->name);
        const auto refusal = [&](const std::string& knob, const std::string& value) -> std::string {
            KnobSettings settings(technique->knobs);
            try {
                settings.set(name, knob, value);
                return "";
            } catch (const Error& error) {
                EXPECT_EQ(error.failure, Failure::usage) << knob << "=" << value;
                return error.what();
            }
        };
        for (int i = 0; i < 30; ++i) {
            const std::string word = draw_plan_word(random);
            const std::string text = refusal(word, "1");
            EXPECT_NE(text.find("'" + name + "' has no knob '" + word + "'"), text.npos) << text;
            EXPECT_TRUE(text.find("did you mean '") != text.npos ||
                        text.find("there are " + std::string(technique->knobs[0].name)) !=
                            text.npos)
                << text;
        }
        for (const Knob& knob : technique->knobs)
            for (int i = 0; i < 5; ++i) {
                const std::string word = draw_plan_word(random);
                const std::string text = refusal(std::string(knob.name), word);
                if (text.empty()) continue; // a number that fits
                EXPECT_NE(text.find("knob '" + std::string(knob.name) + "'"), text.npos) << text;
                const std::span<const std::string_view> choices = knob.names();
                EXPECT_NE(text.find(choices.empty() ? " to " : choices[0]), text.npos) << text;
            }
    }
}

TEST(PlanText, PlanHasAShortUniqueFileName) {
    EXPECT_EQ(reflect::parse_plan("secant:face=64").file_name(), "secant-face64");
    EXPECT_EQ(reflect::parse_plan("1=reuse 2,3=secant:face=64 *=march").file_name(),
              "plan-1reuse-2-3secant-face64--march");
    std::string a = "1=reuse:face=1", b;
    for (int i = 0; i < 30; ++i) a += " 1=reuse:face=2";
    b = a + "3";
    EXPECT_LE(reflect::parse_plan(a).file_name().size(), 80u);
    EXPECT_NE(reflect::parse_plan(a).file_name(), reflect::parse_plan(b).file_name());
}

class PlanFileTest : public test::InFolder {
protected:
    std::string write_plan_file(const std::string& content) {
        const std::string path = (folder / "plan.json").string();
        write_file(path, content);
        return "plan:" + path;
    }
};

TEST_F(PlanFileTest, PlanFileMeansTheSameAsThePlanText) {
    const reflect::TechniquePlan text = reflect::parse_plan(
        "1=reuse:face=64 2,back=hybrid *=march");
    EXPECT_TRUE(session::read_plan(write_plan_file(R"([{"mirror": 1, "technique": "reuse:face=64"},
                                        {"mirror": "2,back", "technique": "hybrid"},
                                        {"mirror": "*", "technique": "march"}])"))
                    .is_same(text));
    // A row of a report stores the same plan as an object with more fields.
    const reflect::TechniquePlan row = session::read_plan(
        write_plan_file(R"({"plan": [{"mirror": 1, "name": "left ball", "technique": "reuse",
                           "settings": {"face": 64, "colour": "half"}, "why": "rule '1'"},
                          {"mirror": "2,back", "technique": "hybrid", "settings": {}},
                          {"mirror": "*", "technique": "march"}]})"));
    EXPECT_TRUE(row.is_same(text));
    EXPECT_TRUE(row.label.starts_with("plan:"));
    EXPECT_TRUE(session::read_plan(write_plan_file(R"([{"mirror": "*", "technique": "reuse",
                                         "settings": {"face": "auto"}}])"))
                    .is_same(reflect::parse_plan("*=reuse:face=auto")));
}

TEST_F(PlanFileTest, InvalidPlanFilesAreRefusedWithThePlaceOfTheError) {
    const auto bad = [&](const std::string& content, const std::vector<std::string>& words,
                         Failure failure = Failure::bad_data) {
        expect_plan_refused(write_plan_file(content), words, failure);
    };
    bad("{", {"plan.json: JSON: line 1, column 2: wanted a key"});
    bad("[]", {"wanted a list of rules"});
    bad(R"({"plans": []})", {"wanted a list of rules", "an object"});
    bad(R"({"schema": "other/1", "plan": [{"mirror": "*", "technique": "reuse"}]})",
        {".schema: wanted one that begins with \"catoptric/\"", "\"other/1\""});
    bad(R"({"schema": 1, "plan": [{"mirror": "*", "technique": "reuse"}]})", {".schema", "1"});
    bad(R"([{"mirror": -1, "technique": "reuse"}])",
        {"plan[0].mirror: wanted a mirror's number or a pattern, found -1"});
    bad(R"([{"mirror": 1}])", {"plan[0].technique: wanted text, found nothing"});
    bad(R"([{"mirror": 1, "technique": "reuse", "settings": [1]}])",
        {"plan[0].settings: wanted an object, found a list"});
    bad(R"([{"mirror": 1, "technique": "reuse", "settings": {"face": null}}])",
        {"plan[0].settings.face: wanted a number or text, found null"});
    bad(R"([{"mirror": "*", "technique": "reuse"}, {"mirrors": 2, "technique": "reuse"}])",
        {"plan[1]: wanted mirror, technique and settings, found 'mirrors'"});
    bad(R"([{"mirror": 1, "technique": "rouse"}])", {"did you mean 'reuse'"}, Failure::usage);
    bad(R"([{"mirror": 9, "technique": "reuse"}])", {"pattern '9' matches no mirror"},
        Failure::usage);
    expect_plan_refused("plan:" + (folder / "none.json").string(), {"none.json"},
                        Failure::missing_input);
    expect_plan_refused("plan:" + folder.string(), {"wanted a file with a plan"},
                        Failure::bad_data);
}

} // namespace
