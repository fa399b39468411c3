// Tests of error messages for invalid JSON. Every reader of JSON files gives the same message.
#include "core/json.hpp"
#include "import/load.hpp"
#include "import/scene_file.hpp"
#include "report/benchmarks.hpp"
#include "session/plan_file.hpp"
#include "session/profile.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <random>

namespace {

using namespace catoptric;
using testing::HasSubstr;
using testing::Not;

std::string json_error_text(const std::string& text) {
    return test::catch_error_text(Failure::bad_data, [&] { check_json("x.json", text); });
}

TEST(Json, JsonErrorNamesPlaceExpectedAndFound) {
    const std::pair<std::string, std::string> cases[] = {
        {"", "line 1, column 1: wanted a value, found the end"},
        {"{", "line 1, column 2: wanted a key in quotation marks, found the end"},
        {"{x", "line 1, column 2: wanted a key in quotation marks, found 'x'"},
        {"{\n  \"a\" 3}", "line 2, column 7: wanted ':', found '3'"},
        {"{\"a\": 3 \"b\"}", "line 1, column 9: wanted ',' or '}', found '\"b\"'"},
        {"[1,\n2,\n3 4]", "line 3, column 3: wanted ',' or ']', found '4'"},
        {"[1, ]", "line 1, column 5: wanted a value, found ']'"},
        {"[1] 2", "line 1, column 5: wanted the end, found '2'"},
        {"[\"a", "line 1, column 4: wanted a closing quotation mark, found the end"},
        {"[\"a\nb\"]", "wanted control characters of a text written as"},
        {"[\"\\q\"]", "line 1, column 4: wanted a complete escape sequence"},
        {"[\"\xff\"]", "line 1, column 3: wanted UTF-8, found '\\xff'"},
        {"[1e]", "line 1, column 4: wanted a digit, found ']'"},
        {"[1e999]", "line 1, column 2: wanted a number that a double can hold, found '1e999'"},
        {"[trxe]", "line 1, column 4: wanted a value, found 'x'"},
        {std::string(64, '['), "wanted nesting below 64, found more"}};
    for (const auto& [text, message] : cases) {
        EXPECT_THAT(json_error_text(text), HasSubstr("x.json: JSON: ")) << text;
        EXPECT_THAT(json_error_text(text), HasSubstr(message)) << text;
    }
    EXPECT_LT(json_error_text("[\"" + std::string(100000, 'x') + "\" 3").size(), 200U);
}

/// JSON text with one damaged byte, or cut off, is either read or refused with a message that our
/// code wrote.
TEST(Json, JsonErrorContainsNoTextOfTheParser) {
    const std::string sound =
        R"({"a": [1, 2.5e3, true, null], "text": "b\u00e9\n", "c": {"d": -7}})";
    std::mt19937 random(1);
    int refused = 0;
    for (int i = 0; i < 2000; ++i) {
        std::string text = sound;
        text[random() % text.size()] = static_cast<char>(random() % 256);
        if (i % 3 == 0) text.resize(random() % text.size());
        try {
            check_json("x.json", text);
        } catch (const BadData& error) {
            ++refused;
            const std::string said = error.what();
            EXPECT_THAT(said,
                        testing::MatchesRegex("x.json: JSON: line [12], column [0-9]+: wanted "
                                              ".*, found .*"));
            for (const char* word : {"exception", "syntax error", "literal", "invalid", "expected"})
                EXPECT_THAT(said, Not(HasSubstr(word))) << text;
        }
    }
    EXPECT_GT(refused, 1000);
}

using JsonFileTest = test::InFolder;

TEST_F(JsonFileTest, AllReadersGiveTheSameJsonError) {
    const auto put = [&](const std::string& name, const std::string& text) {
        std::ofstream(folder / name, std::ios::binary) << text;
        return (folder / name).string();
    };
    const std::string broken = "{\"asset\":\n 3 4}", place = ": JSON: line 2, column 4: wanted ',' "
                                                             "or '}', found '4'";
    put("scene.obj", "");
    put("scene.obj.catoptric.json", broken);
    for (const auto& [reader, read] : std::map<std::string, std::function<void()>>{
             {"glTF", [&] { scene::load(put("scene.gltf", broken)); }},
             {"scene file", [&] { scene::read_scene_file(folder / "scene.obj", {}); }},
             {"plan", [&] { session::read_plan("plan:" + put("plan.json", broken)); }},
             {"benchmarks", [&] { report::read_benchmarks(broken, "b.json"); }},
             {"profile", [&] { session::parse_profile(broken, "p.json", {}); }}})
        EXPECT_THAT(test::catch_error_text(Failure::bad_data, read), HasSubstr(place)) << reader;
}

} // namespace
