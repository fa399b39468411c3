// Tests of files, objects and materials whose names hold control characters of a terminal, formulas
// of a spreadsheet or HTML.
#include "cli/program.hpp"

namespace {

using testing::HasSubstr;
using testing::Not;

constexpr const char* kName = "=1+1\x1b[2J|\"`<script>x\xff";

class Hostile : public Cli {
protected:
    const std::string scene = std::string(kName) + "\ncatoptric: forged";

    void SetUp() override {
        Cli::SetUp();
        const std::string name = kName;
        write(scene + ".obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no " + name + "\nusemtl " +
                                  name + "\nf 1 2 3\n" + name + " 1\n");
        write("m.mtl", "newmtl " + name + "\nillum 3\nKs 1 1 1\n" + name + "\n");
    }

    /// Expects text without control characters and invalid bytes. No line of the text may start
    /// with text that a line break in a name moved there.
    static void expect_plain(const std::string& text, const std::string& where) {
        for (const char c : text)
            ASSERT_TRUE(c == '\n' || static_cast<unsigned char>(c) >= 0x20) << where << text;
        EXPECT_THAT(text, Not(HasSubstr("\xff"))) << where;
        EXPECT_THAT("\n" + text, Not(HasSubstr("\ncatoptric: forged"))) << where;
    }
    test::ProcessResult plain(const Words& words, int exit_code = 0) const {
        test::ProcessResult ended = cli(words);
        EXPECT_EQ(ended.exit_code, exit_code) << words[0] << ended.err;
        expect_plain(ended.out, words[0] + " stdout: ");
        expect_plain(ended.err, words[0] + " stderr: ");
        return ended;
    }
};

TEST_F(Hostile, VerbsPrintNoTerminalControlCharacters) {
    const std::string file = scene + ".obj";
    EXPECT_THAT(plain({"info", file}).out, HasSubstr("=1+1\\x1b[2J"));
    plain({"graph", file, "--technique", "auto", "--why"});
    plain({"graph", file, "--technique", "reuse"});
    plain({"graph", file, "--technique", "reuse", "--format", "dot"});
    plain(quick({"render", file, "--technique", "reuse", "-o", "x.png", "--progress", "always"}));
    plain(quick({"compare", file, "-o", "one", "--techniques", "reuse"}));
    plain(quick({"compare", file, "cornell-mirrors", "-o", "two", "--techniques", "reuse"}));
    plain(quick({"bench", file}));
    plain({"diff", file, file}, 65);
    plain({"diff", scene, scene}, 66);
    plain({"info", scene + ".glb"}, 66);
    plain({file}, 2);
    plain({"render", file, "--technique", file, "-o", "x.png"}, 2);
    plain({"render", file, "--technique", "reuse", "-o", scene + "/x.png"}, 73);
    plain({"list", scene}, 2);
    plain({"stress", "--only", scene}, 2);
}

TEST_F(Hostile, JsonWithHostileNamesIsValid) {
    const std::string file = scene + ".obj";
    for (const Words& words :
         {Words{"info", file, "--json"},
          Words{"graph", file, "--technique", "auto", "--why", "--format", "json"},
          Words{"graph", file, "--technique", "reuse", "--format", "json"},
          quick({"render", file, "--technique", "reuse", "-o", "x.png", "--json"})}) {
        const test::ProcessResult ended = plain(words);
        EXPECT_TRUE(nlohmann::json::accept(ended.out)) << words[0] << ended.out;
    }
}

TEST_F(Hostile, ReportsEscapeHostileNames) {
    plain(quick({"compare", scene + ".obj", "-o", "out", "--techniques", "reuse"}));
    for (const char* name : {"report.json", "report.md", "report.html"})
        expect_plain(read(std::string("out/") + name), name);
    // A quoted CSV cell may hold a line break (RFC 4180). All other control characters of the name
    // must be escaped.
    const std::string csv = read("out/rows.csv");
    EXPECT_THAT(csv, HasSubstr(",\"'=1+1\\x1b[2J|\"\"`<script>x\\xff\ncatoptric: forged\","));
    for (const char c : csv)
        ASSERT_TRUE(c == '\n' || c == '\r' || static_cast<unsigned char>(c) >= 0x20) << csv;
    EXPECT_THAT(csv, HasSubstr("'=1+1"));
    for (const char* beginning : {",=", "\n=", "\"="})
        EXPECT_THAT(csv, Not(HasSubstr(beginning))) << "a spreadsheet computes this cell";
    EXPECT_THAT(read("out/report.html"), Not(HasSubstr("<script>x")));
    const std::string markdown = read("out/report.md");
    for (const std::string mark : {"<script", "|\"", "`<"})
        for (std::size_t at = markdown.find(mark); at != markdown.npos;
             at = markdown.find(mark, at + 1))
            EXPECT_EQ(markdown[at - 1], '\\') << mark << " is not escaped";
}

} // namespace
