// Tests of words that no option knows. Each option of the help that takes a value gets drawn words:
// no word may end the program by an internal error or a signal, and each refusal names the option
// or the word.
#include "cli/program.hpp"
#include "core/image_codec.hpp"
#include "core/text.hpp"

#include <map>
#include <random>
#include <regex>
#include <set>

namespace {

using testing::HasSubstr;

/// Arguments with which a verb comes as far as to read all of its options.
const std::map<std::string, std::vector<std::string>> kNeededArguments{
    {"compare", {"-o", "out", "--techniques", "raytrace:depth=0"}},
    {"choose", {"-o", "plan.json", "--max-ms", "1", "--techniques", "none"}},
    {"render", {"-o", "x.png", "--technique", "raytrace:depth=0"}},
    {"stress", {"--only", "none"}},
    {"bench", {"--techniques", "none"}},
    {"diff", {"a.png", "b.png"}},
    {"graph", {"--technique", "reuse"}},
    {"list", {"scenes"}},
    {"info", {"cornell-mirrors"}},
    {"views", {"-o", "views"}},
    {"sweep", {"plan", "sweep.json", "-o", "sweep"}},
    {"results", {"add", "report.json", "site"}},
    {"completion", {"bash"}}};

class NameTest : public CommandLineTest {
protected:
    void SetUp() override {
        CommandLineTest::SetUp();
        const std::string picture = catoptric::encode_png({{1, 1}, 1, {}},
                                                          std::vector<std::uint8_t>{0});
        write_input_file("a.png", picture), write_input_file("b.png", picture);
    }
    struct OptionWithValue {
        std::string name, verb;
    };
    /// Returns each option that takes a value once, with a verb that has it.
    std::vector<OptionWithValue> list_options_with_values() const {
        const std::string fish = run_cli({"completion", "fish"}).out;
        const std::regex line("subcommand_from (\\w+)' -(l|s) (\\S+) -r");
        std::vector<OptionWithValue> options;
        std::set<std::string> known;
        for (std::sregex_iterator at(fish.begin(), fish.end(), line), end; at != end; ++at)
            if (known.insert((*at)[3]).second) options.push_back({"--" + (*at)[3].str(), (*at)[1]});
        return options;
    }
    static std::string draw_word(std::mt19937& random) {
        constexpr std::string_view kCharacters = "abcxyz*=:,. -_%{}\"'\\/?[~#\xc3\xa9";
        std::string word(1 + random() % 5, ' ');
        for (char& c : word) c = kCharacters[random() % kCharacters.size()];
        return word;
    }
    /// Returns the arguments of the verb without the option.
    static Words needed_arguments_without(const std::string& option, const std::string& verb) {
        Words words;
        const Words& needed = kNeededArguments.at(verb);
        for (std::size_t i = 0; i < needed.size(); ++i) {
            const bool is_same = needed[i] == option || (needed[i] == "-o" && option == "--output");
            if (is_same)
                ++i;
            else
                words.push_back(needed[i]);
        }
        return words;
    }
};

TEST_F(NameTest, DrawnWordsOfEachOptionAreRefusedWithItsName) {
    std::mt19937 random(1);
    const std::vector<OptionWithValue> options = list_options_with_values();
    EXPECT_GT(options.size(), 60U);
    for (const auto& [option, verb] : options)
        for (int i = 0; i < 2; ++i) {
            const std::string word = draw_word(random);
            Words words{verb};
            const Words needed = needed_arguments_without(option, verb);
            words.insert(words.end(), needed.begin(), needed.end());
            words.push_back(option + "=" + word);
            for (const auto& [small, value] :
                 {std::pair{"--size", "8x8"}, {"--frames", "1"}, {"--warmup", "0"}})
                if ((verb == "compare" || verb == "render") && option != small)
                    words.push_back(std::string(small) + "=" + value);
            const test::ProcessResult ended = run_cli(words);
            EXPECT_TRUE(ended.exit_code < 70 || ended.exit_code == 73)
                << verb << " " << option << "='" << word << "': " << ended.exit_code << " "
                << ended.err;
            if (ended.exit_code == 0) continue; // the word is a value, such as a name of a file
            EXPECT_TRUE(ended.err.find(option) != std::string::npos ||
                        (option == "--output" && ended.err.find("-o") != std::string::npos) ||
                        ended.err.find(word) != std::string::npos ||
                        ended.err.find(catoptric::escape(word)) != std::string::npos)
                << verb << " " << option << "='" << word << "': " << ended.err;
        }
}

TEST_F(NameTest, TechniqueOfFewCharactersIsRefusedWithAllNames) {
    for (const std::string word : {"x", ",", "*=x", "aut", "*"})
        expect_usage_refused({"render", "--technique", word, "-o", "x.png"}, 2,
                             {"--technique: ", word == "*=x" ? "'x'" : "'" + word + "'",
                              "there are naive, reuse, parallax"});
    expect_usage_refused({"render", "--technique", "auto:x", "-o", "x.png"}, 2,
                         {"wanted auto alone", "found ':x' after it"});
    expect_usage_refused({"render", "--technique", "", "-o", "x.png"}, 2,
                         {"--technique: wanted a name, found ''"});
    expect_usage_refused({"compare", "-o", "out", "--techniques", "x"}, 2, {"--techniques: "});
    expect_usage_refused({"compare", "-o", "out", "--reference", "x"}, 2, {"--reference: "});
    expect_usage_refused({"compare", "-o", "out", "--axis", "zzzzzz=1,2", "--techniques", "reuse"},
                         2, {"--axis zzzzzz: ", "there are "});
    expect_usage_refused({"render", "--qqqqqqqq"}, 2, {"'--qqqqqqqq'", "render --help"});
    expect_usage_refused({"stress", "--only", "Q"}, 2, {"--only: ", "'Q'"});
}

TEST_F(NameTest, UnknownEnvironmentListsWhatThereIs) {
    expect_usage_refused({"info", "cornell-mirrors", "--environment", "stdio"}, 66,
                         {"--environment: 'stdio'", "studio or none", "did you mean 'studio'"});
}

/// A refusal says what to do next.
TEST_F(NameTest, UnreadSceneFormatSaysHowToConvertIt) {
    expect_usage_refused({"info", "scene.fbx"}, 2,
                         {"'scene.fbx'", ".glb, .gltf or .obj", "'.fbx'", "export", "Blender"});
}

TEST_F(NameTest, UnknownDeviceListsDevicesAndWhatADeviceNeeds) {
    const test::ProcessResult ended = run_cli({"info", "--device", "geforce 9999"});
    expect_exit_code(ended, 2, {"no device 'geforce 9999'", "counted from 0: 0 '", "driver"});
    const std::string name = ended.err.substr(ended.err.find("0 '") + 3);
    std::string capitals = name.substr(0, name.find('\''));
    std::ranges::transform(capitals, capitals.begin(),
                           [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    EXPECT_EQ(run_cli({"info", "--device", capitals}).exit_code, 0) << capitals;
}

TEST_F(NameTest, MissingFileIsNamedBeforeAMissingOption) {
    for (const Words& words : {Words{"compare", "gone.glb"},
                               {"render", "gone.glb"},
                               {"choose", "gone.glb"},
                               {"views", "gone.glb"},
                               {"graph", "gone.glb"}})
        expect_usage_refused(words, 66, {"gone.glb: cannot be opened"});
    expect_usage_refused({"choose", "--certify", "gone.json"}, 66, {"gone.json: "});
    expect_usage_refused({"choose", "--costs", "gone.json"}, 66, {"gone.json: "});
    expect_usage_refused({"sweep", "plan", "gone.json"}, 66, {"gone.json: cannot be opened"});
    expect_usage_refused({"sweep", "merge", "gone"}, 66, {"gone"});
}

TEST_F(NameTest, KnownCostsAreListed) {
    const test::ProcessResult listed = run_cli({"list", "costs"});
    EXPECT_EQ(listed.exit_code, 0) << listed.err;
    EXPECT_THAT(listed.out, HasSubstr("\ngtx-680 "));
    EXPECT_THAT(listed.out, HasSubstr("GeForce GTX 1080 Ti (literature)\n"));
    const auto listed_json = nlohmann::json::parse(run_cli({"list", "costs", "--json"}).out);
    EXPECT_EQ(listed_json["costs"][0]["name"], "gtx-1080-ti");
    const Words compare{"compare", "-o", "out", "--costs"};
    Words words = compare;
    words.emplace_back("gtx-108");
    expect_usage_refused(words, 66, {"gtx-108: ", "gtx-1080-ti", "did you mean "});
}

/// Without --technique and --plan, `render` draws by the plan `auto`.
TEST_F(NameTest, RenderWithoutATechniqueDrawsAuto) {
    const test::ProcessResult ended = run_cli(
        add_small_frame_options({"render", "-o", "x.png", "--json"}));
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.out, HasSubstr("\"auto\""));
    const test::ProcessResult named = run_cli(
        add_small_frame_options({"render", "-o", "y.png", "--technique", "auto"}));
    EXPECT_EQ(named.exit_code, 0) << named.err;
    EXPECT_EQ(read_output_file("x.png"), read_output_file("y.png"));
}

} // namespace
