// Tests of the data of the comparer in report.html: the linear values that the page reads, and the
// list of pictures. tests/page/run.py tests the page in a browser.
#include "measure/causes.hpp"
#include "measure/picture.hpp"
#include "report/html.hpp"
#include "report/writer.hpp"
#include "report_sample.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <memory>

namespace {

using namespace catoptric::measure;
using catoptric::report::html_comparer;
using nlohmann::json;
using testing::HasSubstr;
using testing::StartsWith;

/// Decodes base64 digit by digit into little-endian 16-bit words.
std::vector<unsigned> decode_words(const std::string& script) {
    const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const std::size_t begin = script.find(", \"") + 3, end = script.rfind("\");");
    std::vector<unsigned> words;
    unsigned bits = 0;
    int count = 0;
    std::vector<unsigned> bytes;
    for (std::size_t i = begin; i < end && script[i] != '='; ++i) {
        bits = bits << 6 | static_cast<unsigned>(digits.find(script[i]));
        if ((count += 6) < 8) continue;
        count -= 8;
        bytes.push_back(bits >> count & 255);
    }
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2)
        words.push_back(bytes[i] | bytes[i + 1] << 8);
    return words;
}

/// Returns the value of a half float by its definition (IEEE 754, binary16).
double decode_half_float(unsigned half) {
    const double sign = (half & 0x8000U) != 0 ? -1 : 1;
    const int exponent = static_cast<int>(half >> 10 & 31),
              fraction = static_cast<int>(half & 1023);
    if (exponent == 31) return fraction != 0 ? NAN : sign * INFINITY;
    return sign *
           (exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25));
}

json read_comparer_data(const Comparison& comparison) {
    const std::string html = html_comparer(comparison), open = "json\">";
    const std::size_t begin = html.find(open) + open.size();
    return json::parse(html.substr(begin, html.find("</script>") - begin));
}

TEST(Comparer, ValuesAreThoseOfThePictureAsHalves) {
    Picture picture(5, 3);
    for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
        const float x = static_cast<float>(i);
        picture.pixels[i] = {std::exp2(x - 12), 1.0F / (x + 3), -x};
    }
    const std::string script = catoptric::report::picture_script(picture, "images/a.js");
    EXPECT_THAT(script, StartsWith("catoptric_values(\"images/a.js\", \""));
    const std::vector<unsigned> words = decode_words(script);
    ASSERT_EQ(words.size(), 3 * picture.pixels.size());
    for (std::size_t i = 0; i < words.size(); ++i) {
        const double wanted = picture.pixels[i / 3][static_cast<int>(i % 3)];
        EXPECT_NEAR(decode_half_float(words[i]), wanted, std::abs(wanted) * 0x1p-11) << i;
    }
}

TEST(Comparer, ExtremeValuesStayWhatTheyAre) {
    Picture picture(2, 1);
    picture.pixels[0] = {NAN, INFINITY, -INFINITY};
    picture.pixels[1] = {0x1p-24F, 65504, 1e9F};
    const std::vector<unsigned> words = decode_words(
        catoptric::report::picture_script(picture, "a.js"));
    ASSERT_EQ(words.size(), 6U);
    EXPECT_TRUE(std::isnan(decode_half_float(words[0])));
    EXPECT_EQ(decode_half_float(words[1]), INFINITY);
    EXPECT_EQ(decode_half_float(words[2]), -INFINITY);
    EXPECT_EQ(decode_half_float(words[3]), 0x1p-24);
    EXPECT_EQ(decode_half_float(words[4]), 65504);
    EXPECT_EQ(decode_half_float(words[5]), INFINITY)
        << "a half float holds nothing larger than 65504";
}

TEST(Comparer, MirrorOfEachPixelIsThatOfTheFirstHit) {
    Comparison made = catoptric::report::sample::make_usual_comparison();
    made.mirror_hits = {0, 3, 2U << 16 | 1, 7U << 16};
    EXPECT_EQ(decode_words(catoptric::report::mirror_script(made.mirror_hits, "mirrors.js")),
              (std::vector<unsigned>{0, 3, 1, 0}));
}

TEST(Comparer, ListsTheReferenceAndEveryRowAndBeginsWithTheClosestRowThatDiffers) {
    Comparison made = catoptric::report::sample::make_usual_comparison();
    made.images = "2-room/";
    const json data = read_comparer_data(made);
    ASSERT_EQ(data["pictures"].size(), made.rows.size() + 1);
    EXPECT_EQ(data["pictures"][0]["file"], "images/2-room/reference.js");
    EXPECT_THAT(data["pictures"][0]["label"], HasSubstr(made.reference_label));
    const Row* closest = nullptr;
    for (std::size_t i = 0; i < made.rows.size(); ++i) {
        const Row& row = made.rows[i];
        EXPECT_EQ(data["pictures"][i + 1]["label"], row.label);
        EXPECT_EQ(data["pictures"][i + 1]["file"], "images/2-room/" + row.image + ".js");
        if (row.error.flip > 0 && (closest == nullptr || row.error.flip < closest->error.flip))
            closest = &row;
    }
    ASSERT_NE(closest, nullptr);
    for (const json& picture : data["pictures"])
        EXPECT_EQ(picture["first"], picture["label"] == closest->label) << picture;
    EXPECT_EQ(data["mirrors"].size(), made.scene.mirrors);
    EXPECT_EQ(data["width"], 4);
    // Every picture that the comparer's data names must be in the page.
    const std::string page = catoptric::report::to_html(made);
    for (const json& picture : data["pictures"])
        EXPECT_THAT(page, HasSubstr("id=\"" + picture["picture_id"].get<std::string>() + "\""));
}

TEST(Comparer, NamesTheMapsOfEachRowAndTheColoursOfTheirCauses) {
    Comparison made = catoptric::report::sample::make_usual_comparison();
    EXPECT_EQ(read_comparer_data(made)["causes"], json::array());
    auto causes = std::make_shared<catoptric::measure::Causes>();
    causes->list = {{.name = "texels"}, {.name = "rest"}};
    Row& row = made.rows[0];
    causes->largest.assign(row.display.pixels.size(), 1);
    row.causes = causes;
    const json data = read_comparer_data(made);
    EXPECT_EQ(data["causes"], json::parse(R"([{"name": "texels", "colour": [240, 228, 66]},
                                              {"name": "rest", "colour": [190, 190, 190]}])"));
    EXPECT_EQ(data["pictures"][0]["causes"]["id"], "") << "of the reference";
    const json& picture = data["pictures"][1];
    EXPECT_EQ(picture["error"]["file"], "images/" + row.image + "-error.js");
    EXPECT_EQ(picture["causes"]["file"], "images/causes-" + row.image + ".js");
    catoptric::report::EncodedPictures encoded;
    catoptric::report::encode_pictures(encoded, made, {});
    const std::string page = catoptric::report::to_html(made, encoded);
    for (const char* map : {"error", "causes"})
        EXPECT_THAT(page, HasSubstr("id=\"" + picture[map]["id"].get<std::string>() + "\"")) << map;
}

TEST(Comparer, LabelsCannotEndTheScript) {
    Comparison made = catoptric::report::sample::make_usual_comparison();
    made.rows[0].label = "</script><script>alert(1)</script>";
    EXPECT_THAT(html_comparer(made), testing::Not(HasSubstr("<script>alert")));
    EXPECT_EQ(read_comparer_data(made)["pictures"][1]["label"], made.rows[0].label);
}

TEST(Comparer, LabelsMayHoldAnyBytes) {
    Comparison made = catoptric::report::sample::make_usual_comparison();
    made.rows[0].label = "plan:\xff.json";
    EXPECT_EQ(read_comparer_data(made)["pictures"][1]["label"], "plan:\xef\xbf\xbd.json");
}

TEST(Comparer, IsLeftOutWithoutReferenceOrRows) {
    Comparison made = catoptric::report::sample::make_usual_comparison();
    Comparison without = made;
    without.reference_display = {};
    EXPECT_EQ(html_comparer(without), "");
    made.rows.clear();
    EXPECT_EQ(html_comparer(made), "");
}

} // namespace
