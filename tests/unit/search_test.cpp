// Tests of techniques that a program adds (technique.hpp), without a device. tests/install
// draws with such a technique.
#include "compare.hpp"
#include "core/error.hpp"
#include "import/load.hpp"
#include "reflect/plan.hpp"
#include "require/model.hpp"
#include "scene/built_in.hpp"
#include "session/engine.hpp"
#include "session/technique_choice.hpp"
#include "study/compare_checks.hpp"
#include "technique.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;
using testing::Contains;
using testing::HasSubstr;

const session::RegisteredSearch kTestSearch{
    {.name = "test_search",
     .summary = "For a test.",
     .shader = "test_search.frag",
     .knobs = {{.name = "much", .help = "how much", .high = 2, .value = .5, .is_real = true}},
     .continues = true,
     .compared = {"test_search", "test_search:much=2"}}};

std::string search_error_text(session::Search search) {
    try {
        session::add_search(std::move(search));
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

std::string technique_error_text(const std::string& technique) {
    try {
        static_cast<void>(session::parse_technique(technique));
    } catch (const UsageError& error) {
        return error.what();
    }
    return "nothing was thrown";
}

TEST(Search, AddedSearchIsInTheTableOfTechniques) {
    const session::ParsedTechnique choice = session::parse_technique(
        "test_search:much=1.5,face=64");
    EXPECT_EQ(choice.settings.front().number, 1.5);
    EXPECT_EQ(choice.settings.size(), session::parse_technique("secant").settings.size());
    const scene::Scene room = scene::make_cornell();
    EXPECT_THAT(study::default_techniques({.scene = room}), Contains("test_search:much=2"));
    try {
        session::parse_technique("test_search:much=some");
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(),
                     "knob 'much' of 'test_search' takes a number from 0 to 2, not 'some'");
    }
}

TEST(Search, AddedSearchHasNoKnobWithoutEffect) {
    session::add_search({.name = "test_short", .shader = "test_short.frag"});
    for (const char* knob : {"continue=0", "captures=own", "mirrors=captured"})
        EXPECT_THAT(technique_error_text("test_short:" + std::string(knob)),
                    HasSubstr("technique 'test_short' has no knob '"));
    const session::ParsedTechnique choice = session::parse_technique(
        "test_short:face=64,show=state");
    EXPECT_EQ(choice.settings.size() + 3,
              session::parse_technique("test_search").settings.size() - 1);
}

/// Returns whether a picture of the built-in scene by the technique requires complete captures.
bool does_technique_read_all_captures(const std::string& technique) {
    const scene::Scene room = scene::make_cornell();
    require::WorkModelInput input{.now = room, .camera = room.cameras.front()};
    reflect::add_capture_needs(input, {reflect::parse_plan(technique)});
    return input.asks_all;
}

TEST(Search, AddedSearchMayAskTheCapturesOfAllMirrors) {
    EXPECT_FALSE(does_technique_read_all_captures("test_search"));
    EXPECT_TRUE(does_technique_read_all_captures("test_search:captures=all"));
}

TEST(Search, OwnKnobsMayHaveNamesOfKnobsThatOtherTechniquesHave) {
    session::add_search({.name = "test_names",
                         .shader = "test_names.frag",
                         .knobs = {{.name = "rest"}, {.name = "without"}, {.name = "capture"}}});
    EXPECT_FALSE(does_technique_read_all_captures("test_names:rest=1,without=1,capture=0"));
}

TEST(Search, InvalidSearchIsRefusedWithTheReason) {
    EXPECT_THAT(search_error_text({.name = "Two words"}),
                HasSubstr("'Two words': wanted a name of small letters, digits and '_'"));
    EXPECT_THAT(search_error_text({.name = "secant"}),
                HasSubstr("there is a technique 'secant' already"));
    EXPECT_THAT(search_error_text({.name = "twice", .knobs = {{.name = "face"}}}),
                HasSubstr("technique 'twice' has two knobs 'face'"));
    EXPECT_THAT(search_error_text({.name = "short", .knobs = {{.name = "mirrors"}}}),
                HasSubstr("technique 'short' has two knobs 'mirrors'"));
    EXPECT_THAT(
        search_error_text({.name = "outside", .knobs = {{.name = "a", .high = 1, .value = 2}}}),
        HasSubstr("knob 'a': wanted a value from 0 to 1, found 2"));
    EXPECT_THAT(search_error_text({.name = "auto"}),
                HasSubstr("'auto' is the plan that the program chooses"));
    EXPECT_THAT(search_error_text({.name = "outside", .compared = {"outsid:face=4"}}),
                HasSubstr("wanted rows of its own to compare, found 'outsid:face=4'"));
    EXPECT_THAT(search_error_text({.name = "outside", .knobs = {{.name = "a=b"}}}),
                HasSubstr("knob 'a=b': wanted a name of small letters, digits and '_'"));
    EXPECT_THAT(search_error_text({.name = "outside", .knobs = {{.name = "a", .value = .5}}}),
                HasSubstr("wanted whole numbers from 0 to 4294967295, found 0 to 1 and 0.5"));
    EXPECT_THAT(search_error_text({.name = "outside", .knobs = {{.name = "a", .low = -1}}}),
                HasSubstr("found -1 to 1 and 0; is_real allows others"));
    EXPECT_THROW(session::parse_technique("twice"), UsageError) << "refused ones are not added";
}

TEST(Search, ShaderThatExistsAlreadyIsRefused) {
    const std::uint32_t words[] = {1};
    const session::Shader taken[] = {{"reflect/secant.frag", words}};
    try {
        session::RegisteredShaders{taken};
        FAIL();
    } catch (const UsageError& error) {
        EXPECT_STREQ(error.what(), "there is a shader 'reflect/secant.frag' already");
    }
}

TEST(Errors, EachKindOfFailureThrowsItsOwnType) {
    EXPECT_THROW(fail(Failure::bad_data, "x"), BadData);
    EXPECT_THROW(fail(Failure::missing_input, "x"), MissingInput);
    EXPECT_THROW(fail(Failure::no_device, "x"), NoDevice);
    EXPECT_THROW(fail(Failure::internal, "x"), InternalError);
    EXPECT_THROW(fail(Failure::cannot_create, "x"), CannotCreate);
    EXPECT_THROW(fail(Failure::io, "x"), IoError);
    EXPECT_THROW(fail(Failure::exhausted, "x"), Exhausted);
    EXPECT_THROW(fail(Failure::device_lost, "x"), DeviceLost);
    try {
        fail(Failure::terminated, "stopped by ", 15);
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::terminated);
        EXPECT_STREQ(error.what(), "stopped by 15");
    }
}

} // namespace
