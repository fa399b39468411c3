// Tests of device profiles: which measured choices a profile stores, and which profiles are
// accepted.
#include "render/tracing.hpp"
#include "session/profile.hpp"
#include "support/folder.hpp"
#include "support/refusal.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace {

using namespace catoptric;
using nlohmann::json;
using testing::Pair;

session::DeviceInfo make_device_info(const std::string& driver = "driver 1.2 (build 3)") {
    session::DeviceInfo device;
    device.name = "A device";
    device.driver = driver;
    device.id = "10de-2330";
    device.type = "cpu";
    return device;
}

/// Returns a measurement of a variant's second choice. In round i this choice takes `ratios[i]`
/// times as long as the default.
measure::VariantTrial make_shader_variant_trial(std::size_t variant,
                                                const std::vector<double>& ratios) {
    const gpu::ShaderVariant& row = gpu::shader_variants()[variant];
    measure::VariantTrial one{.variant = std::string(row.name),
                              .choice = std::string(row.choices[1]),
                              .standard = std::string(row.choices[0]),
                              .benchmark = "frame/x"};
    for (const double ratio : ratios) one.ms.push_back(10 * ratio), one.standard_ms.push_back(10);
    return one;
}

const std::vector<double> kFasterRoundRatios{.9, .91, .92, .93, .94, .95},
    kSlowerRoundRatios{1.1, 1.2, 1.3, 1.1, 1.2, 1.3}, kMixedRoundRatios{.5, .6, .7, .8, .9, 1.01};

TEST(Profile, ProfileStoresChoicesThatAreFasterWithConfidence) {
    const std::string text = session::profile_text(
        make_device_info(), {make_shader_variant_trial(0, kFasterRoundRatios),
                             make_shader_variant_trial(1, kSlowerRoundRatios),
                             make_shader_variant_trial(2, kMixedRoundRatios)});
    EXPECT_EQ(session::parse_profile(text, "p.json", make_device_info()),
              (gpu::VariantChoices{1, 0, 0}));
    const json document = json::parse(text);
    EXPECT_EQ(document["variants"],
              (json{{"groups", "in order"}, {"hierarchy", "texel"}, {"pixels", "blocks"}}));
    EXPECT_EQ(document["measured"][0]["taken"], true);
    EXPECT_DOUBLE_EQ(document["measured"][0]["ratio"], .925);
    EXPECT_DOUBLE_EQ(document["measured"][0]["ci95"][1], .95);
    EXPECT_EQ(document["measured"][2]["taken"], false) << "its interval holds 1";
    EXPECT_FALSE(make_shader_variant_trial(0, {.5, .5, .5, .5, .5}).is_faster())
        << "too few rounds";
    EXPECT_FALSE(make_shader_variant_trial(0, {1, 1, 1, 1, 1, 1}).is_faster());
}

TEST(Profile, ProfileOfAnotherDeviceOrDriverIsRefused) {
    const std::string text = session::profile_text(
        make_device_info(), {make_shader_variant_trial(0, kFasterRoundRatios)});
    const auto refuses = [&](const session::DeviceInfo& device, const std::string& member,
                             const std::string& wanted, const std::string& found) {
        test::expect_error([&] { session::parse_profile(text, "p.json", device); },
                           Failure::bad_data,
                           {"p.json: is another device's or driver's profile: device." + member +
                            ": wanted '" + wanted + "', found '" + found + "'"});
    };
    refuses(make_device_info("driver 1.3"), "driver", "driver 1.3", "driver 1.2 (build 3)");
    session::DeviceInfo other = make_device_info();
    other.name = "B";
    refuses(other, "name", "B", "A device");
    other = make_device_info(), other.id = "10de-2331";
    refuses(other, "id", "10de-2331", "10de-2330");
}

TEST(Profile, InvalidProfilesAreRefusedWithTheReason) {
    json good = json::parse(session::profile_text(
        make_device_info(), {make_shader_variant_trial(0, kFasterRoundRatios)}));
    const auto refuses = [&](const std::string& text, const std::string& part) {
        test::expect_error([&] { session::parse_profile(text, "p.json", make_device_info()); },
                           Failure::bad_data, {"p.json: ", part});
    };
    refuses("{", "JSON: line 1, column 2: wanted a key in quotation marks, found the end");
    refuses("[]", "wanted a device profile, schema 'catoptric/device-profile/1', found nothing");
    json bad = good;
    bad["schema"] = "catoptric/device-profile/2";
    refuses(bad.dump(), "found 'catoptric/device-profile/2'");
    bad = good, bad["variants"] = 3;
    refuses(bad.dump(), "variants: wanted an object, found '3'");
    bad = good, bad["variants"] = {{"colour", "red"}};
    refuses(bad.dump(), "variants: wanted one of groups, hierarchy, pixels, found 'colour'");
    bad = good, bad["variants"]["pixels"] = "storage";
    refuses(bad.dump(), "variants.pixels: wanted 'blocks' or 'rows', found 'storage'");
    good["variants"] = json::object(); // variants that are left out have their defaults
    EXPECT_EQ(session::parse_profile(good.dump(), "p.json", make_device_info()),
              gpu::VariantChoices{});
}

TEST(Profile, ProfileFileNameHasOnlyPortableCharacters) {
    EXPECT_EQ(session::profile_file_name(make_device_info("../a b:c\\d\n")),
              "10de-2330-.._a_b_c_d_.json");
}

class ProfileFileTest : public test::InFolder {
protected:
    void write_profile_file(const std::string& name, const std::string& text) const {
        std::ofstream(folder / name) << text;
    }
    std::string make_valid_profile_text() const {
        return session::profile_text(make_device_info(),
                                     {make_shader_variant_trial(0, kFasterRoundRatios)});
    }
};

TEST_F(ProfileFileTest, ProfileInTheUsersFolderIsUsedOrGivesAWarning) {
    session::EngineOptions options;
    options.profiles = folder;
    session::DeviceInfo device = make_device_info();
    EXPECT_EQ(session::choose_variants(options, device), gpu::VariantChoices{}) << "there is none";
    EXPECT_EQ(device.profile + device.warning, "");
    EXPECT_THAT(device.variants,
                testing::ElementsAre(Pair("groups", "scattered"), Pair("hierarchy", "texel"),
                                     Pair("pixels", "blocks")));
    const std::string name = session::profile_file_name(device);
    write_profile_file(name, make_valid_profile_text());
    EXPECT_EQ(session::choose_variants(options, device), (gpu::VariantChoices{1, 0, 0}));
    EXPECT_EQ(device.profile, name);
    EXPECT_EQ(device.variants[0].second, "in order");
    for (const std::string& text :
         {std::string("{"),
          session::profile_text(make_device_info("another"),
                                {make_shader_variant_trial(0, kFasterRoundRatios)})}) {
        write_profile_file(name, text);
        device = make_device_info();
        EXPECT_EQ(session::choose_variants(options, device), gpu::VariantChoices{});
        EXPECT_EQ(device.profile, "");
        EXPECT_THAT(device.warning, testing::StartsWith((folder / name).string() + ": "));
        EXPECT_THAT(device.warning, testing::HasSubstr("; shaders are as by default"));
    }
}

TEST_F(ProfileFileTest, ProfileNamedByAnOptionMustBeUsable) {
    session::DeviceInfo device = make_device_info();
    const auto choose = [&](const std::string& name) {
        return session::choose_variants({.profile = folder / name, .profiles = folder}, device);
    };
    write_profile_file("good.json", make_valid_profile_text()), write_profile_file("bad.json", "3");
    write_profile_file("other.json",
                       session::profile_text(make_device_info("another"),
                                             {make_shader_variant_trial(0, kFasterRoundRatios)}));
    EXPECT_EQ(choose("good.json"), (gpu::VariantChoices{1, 0, 0}));
    EXPECT_EQ(device.profile, "good.json");
    test::expect_error([&] { choose("bad.json"); }, Failure::bad_data, {"bad.json: wanted "});
    test::expect_error([&] { choose("other.json"); }, Failure::bad_data, {"device.driver: "});
    test::expect_error([&] { choose("none.json"); }, Failure::missing_input, {"none.json: "});
    test::expect_error([&] { choose("."); }, Failure::bad_data, {": wanted a file with a device"});
    test::expect_error(
        [&] {
            session::choose_variants({.variants = {{"pixels", "round"}}}, device);
        },
        Failure::usage, {"variants.pixels: wanted 'blocks' or 'rows'"});
}

/// Work groups are scattered only on a software driver, because each of its threads gets one
/// contiguous run of work groups.
TEST(Variants, WorkGroupsAreInOrderExceptOnAProcessor) {
    for (const auto& [type, groups] :
         {std::pair("cpu", "scattered"), std::pair("discrete", "in order"),
          std::pair("integrated", "in order"), std::pair("virtual", "in order")}) {
        session::DeviceInfo device = make_device_info();
        device.type = type;
        const gpu::VariantChoices choices = session::choose_variants({}, device);
        EXPECT_THAT(device.variants, testing::Contains(Pair("groups", groups))) << type;
        EXPECT_THAT(device.variants, testing::Contains(Pair("hierarchy", "texel"))) << type;
        EXPECT_EQ(choices, session::default_variants(device));
        session::choose_variants({.variants = {{"pixels", "rows"}}}, device);
        EXPECT_THAT(device.variants, testing::Contains(Pair("groups", groups))) << type;
    }
}

TEST(Variants, ChoicesOtherThanDefaultsBecomeShaderConstants) {
    EXPECT_TRUE(render::make_tracer_constants({}, 16, 128).empty());
    const gpu::ShaderConstants all = render::make_tracer_constants({1, 1, 1}, 128, 128);
    EXPECT_THAT(
        all, testing::ElementsAre(Pair("groups_in_order", testing::VariantWith<std::uint32_t>(1U)),
                                  Pair("bvh_in_storage", testing::VariantWith<std::uint32_t>(1U)),
                                  Pair("pixels_in_rows", testing::VariantWith<std::uint32_t>(1U))));
    const gpu::ShaderConstants large = render::make_tracer_constants({0, 1, 0}, 129, 128);
    EXPECT_TRUE(large.empty()) << "more bytes than a storage buffer may have";
}

} // namespace
