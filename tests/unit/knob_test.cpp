// Tests of knobs: reading a knob's value from text, and writing the value as text.
#include "core/knob.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>

namespace {

using namespace catoptric;

constexpr Knob kExampleTechniqueKnobs[] = {
    {.name = "steps", .help = "", .low = 0, .high = 8, .value = 2},
    {.name = "face", .help = "", .low = 1, .high = 64, .value = 16, .special = "auto"}};

std::string knob_error_text(std::string_view knob, std::string_view text) {
    KnobSettings settings(kExampleTechniqueKnobs);
    return test::catch_error_text(Failure::usage, [&] { settings.set("row", knob, text); });
}

TEST(Knob, SpecialWordReplacesANumber) {
    KnobSettings settings(kExampleTechniqueKnobs);
    EXPECT_FALSE(settings.is_special(kExampleTechniqueKnobs[1]));
    settings.set("row", "face", "auto");
    EXPECT_TRUE(settings.is_special(kExampleTechniqueKnobs[1]));
    EXPECT_EQ(settings.format(kExampleTechniqueKnobs[1]), "auto");
    EXPECT_FALSE(settings == KnobSettings(kExampleTechniqueKnobs));
    settings.set("row", "face", "16");
    EXPECT_EQ(settings.number(kExampleTechniqueKnobs[1]), 16);
    EXPECT_TRUE(settings == KnobSettings(kExampleTechniqueKnobs));
}

TEST(Knob, ReadingASpecialWordAsANumberIsAnError) {
    KnobSettings settings(kExampleTechniqueKnobs);
    settings.set("row", "face", "auto");
    try {
        settings.number(kExampleTechniqueKnobs[1]);
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.failure, Failure::internal);
        EXPECT_THAT(error.what(),
                    testing::AllOf(testing::HasSubstr("face"), testing::HasSubstr("auto")));
    }
}

TEST(Knob, LargeNumbersAreWrittenWithoutAnExponent) {
    const Knob range{.name = "range", .low = 1, .high = 1e6, .value = 1000};
    KnobSettings settings(std::span(&range, 1));
    settings.set("row", "range", "100000");
    EXPECT_EQ(settings.format(range), "100000");
    try {
        settings.set("row", "range", "0");
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("1 to 1000000,"));
    }
}

TEST(Knob, RefusalNamesTheAllowedValues) {
    for (const std::string_view text : {"0", "65", "2.5", "atuo", "", "automatic", "nan"})
        EXPECT_THAT(knob_error_text("face", text),
                    testing::AllOf(testing::HasSubstr("'face' of 'row'"),
                                   testing::HasSubstr("1 to 64 or auto"),
                                   testing::HasSubstr(std::string(text))));
    EXPECT_THAT(knob_error_text("face", "atuo"), testing::HasSubstr("did you mean 'auto'?"));
    EXPECT_THAT(knob_error_text("steps", "a"), testing::Not(testing::HasSubstr("did you mean")));
    for (const std::string_view text : {"9", "auto"}) // this knob has no special word
        EXPECT_THAT(knob_error_text("steps", text),
                    testing::AllOf(testing::HasSubstr("0 to 8"),
                                   testing::Not(testing::HasSubstr("or auto"))))
            << text;
}

} // namespace
