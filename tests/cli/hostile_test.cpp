// Tests of files, objects and materials whose names hold control characters of a terminal, formulas
// of a spreadsheet or HTML.
#include "cli/program.hpp"

namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kName = "=1+1\x1b[2J|\"`<script>x\xff";

class HostileFileNamesCliTest : public CommandLineTest {
protected:
    const std::string scene = std::string(kName) + "\ncatoptric: forged";

    void SetUp() override {
        CommandLineTest::SetUp();
        const std::string name = kName;
        write_input_file(scene + ".obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no " + name +
                                             "\nusemtl " + name + "\nf 1 2 3\n" + name + " 1\n");
        write_input_file("m.mtl", "newmtl " + name + "\nillum 3\nKs 1 1 1\n" + name + "\n");
    }

    /// Expects text without control characters and invalid bytes. No line of the text may start
    /// with text that a line break in a name moved there.
    static void expect_printable_text(const std::string& text, const std::string& where) {
        for (const char c : text)
            ASSERT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << where << text;
        EXPECT_THAT(text, Not(HasSubstr("\xff"))) << where;
        EXPECT_THAT("\n" + text, Not(HasSubstr("\ncatoptric: forged"))) << where;
    }
    test::ProcessResult run_and_expect_printable(const Words& words, int exit_code = 0) const {
        test::ProcessResult ended = run_cli(words);
        EXPECT_EQ(ended.exit_code, exit_code) << words[0] << ended.err;
        expect_printable_text(ended.out, words[0] + " stdout: ");
        expect_printable_text(ended.err, words[0] + " stderr: ");
        return ended;
    }
};

TEST_F(HostileFileNamesCliTest, VerbsPrintNoTerminalControlCharacters) {
    const std::string file = scene + ".obj";
    EXPECT_THAT(run_and_expect_printable({"info", file}).out, HasSubstr("=1+1\\x1b[2J"));
    run_and_expect_printable({"graph", file, "--technique", "auto", "--why"});
    run_and_expect_printable({"graph", file, "--technique", "reuse"});
    run_and_expect_printable({"graph", file, "--technique", "reuse", "--format", "dot"});
    run_and_expect_printable(add_small_frame_options(
        {"render", file, "--technique", "reuse", "-o", "x.png", "--progress", "always"}));
    run_and_expect_printable(
        add_small_frame_options({"compare", file, "-o", "one", "--techniques", "reuse"}));
    run_and_expect_printable(add_small_frame_options(
        {"compare", file, "cornell-mirrors", "-o", "two", "--techniques", "reuse"}));
    run_and_expect_printable(add_small_frame_options({"bench", file}));
    run_and_expect_printable({"diff", file, file}, 65);
    run_and_expect_printable({"diff", scene, scene}, 66);
    run_and_expect_printable({"info", scene + ".glb"}, 66);
    run_and_expect_printable({file}, 2);
    run_and_expect_printable({"render", file, "--technique", file, "-o", "x.png"}, 2);
    run_and_expect_printable({"render", file, "--technique", "reuse", "-o", scene + "/x.png"}, 73);
    run_and_expect_printable({"list", scene}, 2);
    run_and_expect_printable({"stress", "--only", scene}, 2);
}

TEST_F(HostileFileNamesCliTest, JsonWithHostileNamesIsValid) {
    const std::string file = scene + ".obj";
    for (const Words& words :
         {Words{"info", file, "--json"},
          Words{"graph", file, "--technique", "auto", "--why", "--format", "json"},
          Words{"graph", file, "--technique", "reuse", "--format", "json"},
          add_small_frame_options(
              {"render", file, "--technique", "reuse", "-o", "x.png", "--json"})}) {
        const test::ProcessResult ended = run_and_expect_printable(words);
        EXPECT_TRUE(nlohmann::json::accept(ended.out)) << words[0] << ended.out;
    }
}

TEST_F(HostileFileNamesCliTest, ReportsEscapeHostileNames) {
    run_and_expect_printable(
        add_small_frame_options({"compare", scene + ".obj", "-o", "out", "--techniques", "reuse"}));
    for (const char* name : {"report.json", "report.md", "report.html"})
        expect_printable_text(read_output_file(std::string("out/") + name), name);
    // A quoted CSV cell may hold a line break (RFC 4180). All other control characters of the name
    // must be escaped.
    const std::string csv = read_output_file("out/rows.csv");
    EXPECT_THAT(csv, HasSubstr(",\"'=1+1\\x1b[2J|\"\"`<script>x\\xff\ncatoptric: forged\","));
    for (const char c : csv)
        ASSERT_TRUE(c == '\n' || c == '\r' || static_cast<unsigned char>(c) >= 0x20) << csv;
    EXPECT_THAT(csv, HasSubstr("'=1+1"));
    for (const char* beginning : {",=", "\n=", "\"="})
        EXPECT_THAT(csv, Not(HasSubstr(beginning))) << "a spreadsheet computes this cell";
    EXPECT_THAT(read_output_file("out/report.html"), Not(HasSubstr("<script>x")));
    const std::string markdown = read_output_file("out/report.md");
    for (const std::string mark : {"<script", "|\"", "`<"})
        for (std::size_t at = markdown.find(mark); at != markdown.npos;
             at = markdown.find(mark, at + 1))
            EXPECT_EQ(markdown[at - 1], '\\') << mark << " is not escaped";
}

} // namespace
