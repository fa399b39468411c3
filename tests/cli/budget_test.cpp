// Test of scene budgets: the error for a scene over its budget names the option that raises the
// limit.
#include "cli/program.hpp"

namespace {

TEST_F(CommandLineTest, SceneBudgetErrorNamesTheOptionThatRaisesIt) {
    write_input_file("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n");
    expect_usage_refused({"info", "two.obj", "--max-triangles", "1"}, 65,
                         {"two.obj",
                          "wanted at most 1 triangles in meshes, the budget of a scene, found 2",
                          "; --max-triangles allows more"});
    expect_usage_refused({"info", "two.obj", "--max-bytes", "10"}, 65,
                         {"wanted at most 10 bytes in its files, the budget of a scene, found ",
                          "; --max-bytes allows more"});
    EXPECT_EQ(run_cli({"info", "two.obj", "--max-triangles", "2", "--max-bytes", "100"}).exit_code,
              0);
    expect_usage_refused({"info", "two.obj", "--max-triangles", "0"}, 2, {"--max-triangles"});
}

} // namespace
