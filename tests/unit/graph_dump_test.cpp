// Tests of the text, DOT and JSON descriptions of a planned render graph.
#include "graph/dump.hpp"
#include "support/frames.hpp"
#include "support/graphs.hpp"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace catoptric::graph {
namespace {

using test::kBlackClearColour;

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

/// A render graph with two images that share memory, an image kept for the next frame, a culled
/// pass and a buffer.
struct GraphDumpTest : ::testing::Test {
    Graph g;
    ImageHandle first = add_graph_image("first"), second = add_graph_image("second"),
                third = add_graph_image("third");
    ImageHandle kept = add_graph_image("kept"), out = add_graph_image("out"),
                unused = add_graph_image("say \"no\"");
    BufferHandle args = g.add_buffer({.name = "args", .bytes = 64});
    GraphPlan plan;

    GraphDumpTest() {
        const auto body = [](PassCommands&) {};
        g.add_pass("one", PassPurpose::scene)
            .writes(first, ResourceUse::colour, kBlackClearColour)
            .writes(args, ResourceUse::storage_write)
            .layers(2)
            .record(body);
        g.add_pass("two")
            .reads(first, ResourceUse::sampled)
            .reads(args, ResourceUse::indirect)
            .writes(second, ResourceUse::storage_write)
            .record(body);
        g.add_pass("three")
            .reads(second, ResourceUse::sampled)
            .writes(third, ResourceUse::storage_write)
            .record(body);
        g.add_pass("vain")
            .reads(third, ResourceUse::sampled)
            .writes(unused, ResourceUse::storage_write)
            .record(body);
        g.add_pass("four")
            .reads(third, ResourceUse::sampled)
            .reads(g.previous(kept), ResourceUse::sampled)
            .writes(out, ResourceUse::storage_write)
            .record(body);
        g.add_pass("five")
            .writes(kept, ResourceUse::colour, kBlackClearColour)
            .layers(2)
            .record(body);
        g.add_pass("six").writes(kept.layers(0, 1), ResourceUse::colour).record(body);
        g.output(out);
        plan = graph::plan_graph(g, {}, default_sizer());
    }

    ImageHandle add_graph_image(const std::string& name) {
        return g.add_image({.name = name, .width = 8, .height = 8, .layers = 2});
    }
};

TEST_F(GraphDumpTest, TextListsPassesImagesAndBuffers) {
    EXPECT_EQ(plan_to_text(g, plan),
              R"(6 passes, scene_passes 1, 5376 bytes (6400 without sharing)

passes
  1 'one' (scene), 1 barrier
      writes 'first' [0,2) as colour, cleared
      writes buffer 'args' as storage_write
  2 'two', 3 barriers
      reads  'first' [0,2) as sampled
      writes 'second' [0,2) as storage_write
      reads  buffer 'args' as indirect
  3 'three', 2 barriers
      reads  'second' [0,2) as sampled
      writes 'third' [0,2) as storage_write
  4 'four', 2 barriers
      reads  'third' [0,2) as sampled
      reads  previous('kept') [0,2) as sampled
      writes 'out' [0,2) as storage_write
  5 'five', 1 barrier
      writes 'kept' [0,2) as colour, cleared
  6 'six', 1 barrier
      writes 'kept' [0,1) as colour, loaded

culled
  'vain': no output depends on what it writes: 'say "no"'

images
  'first' rgba16f 8x8, 2 layers, passes 1 to 2, heap 0 at 0, 1024 bytes, shares with 'third'
  'second' rgba16f 8x8, 2 layers, passes 2 to 3, heap 0 at 1024, 1024 bytes
  'third' rgba16f 8x8, 2 layers, passes 3 to 4, heap 0 at 0, 1024 bytes, shares with 'first'
  'kept' rgba16f 8x8, 2 layers, passes 4 to 6, heap 0 at 3328, 2048 bytes, alone
  'out' rgba16f 8x8, 2 layers, passes 4 to 4, heap 0 at 2304, 1024 bytes, alone
  'say "no"' rgba16f 8x8, 2 layers, not used

buffers
  'args', passes 1 to 2, heap 0 at 2048, 256 bytes
)");
}

TEST_F(GraphDumpTest, DotDrawsCulledPassesDashedAndPreviousFrameDotted) {
    const std::string dot = plan_to_dot(g, plan);
    EXPECT_THAT(dot, HasSubstr("p0 [shape=box, style=solid, label=\"one\\n(scene)\"]"));
    EXPECT_THAT(dot, HasSubstr("p3 [shape=box, style=dashed, label=\"vain\"]"));
    EXPECT_THAT(dot, HasSubstr("i5 [shape=ellipse, label=\"say \\\"no\\\"\"]"));
    EXPECT_THAT(dot, HasSubstr("p0 -> i0 [style=solid, label=\"colour\"]"));
    EXPECT_THAT(dot, HasSubstr("i0 -> p1 [style=solid, label=\"sampled\"]"));
    EXPECT_THAT(dot, HasSubstr("b0 -> p1 [style=solid, label=\"indirect\"]"));
    EXPECT_THAT(dot, HasSubstr("p3 -> i5 [style=dashed, label=\"storage_write\"]"));
    EXPECT_THAT(dot, HasSubstr("i3 -> p4 [style=dotted, label=\"previous, sampled\"]"));
    EXPECT_THAT(dot, HasSubstr("p6 -> i3 [style=solid, label=\"colour [0,1)\"]"));
}

TEST_F(GraphDumpTest, JsonListsPassesImagesAndBuffers) {
    const Json json = Json::parse(plan_to_json(g, plan));
    ASSERT_EQ(json["passes"].size(), 6u);
    EXPECT_EQ(json["passes"][0]["name"], "one");
    EXPECT_EQ(json["passes"][0]["tag"], "scene");
    EXPECT_EQ(json["passes"][1]["tag"], "none");
    EXPECT_EQ(json["passes"][1]["barriers"], 3);
    EXPECT_EQ(json["passes"][1]["reads"],
              Json::parse(R"([{"image": "first", "layers": [0, 2], "use": "sampled",
                               "previous": false},
                              {"buffer": "args", "use": "indirect"}])"));
    EXPECT_EQ(json["passes"][3]["reads"][1]["previous"], true);
    EXPECT_EQ(json["passes"][5]["writes"],
              Json::parse(R"([{"image": "kept", "layers": [0, 1], "use": "colour",
                               "clear": false}])"));
    EXPECT_EQ(json["culled"], Json::parse(R"([{"name": "vain", "reason":
                                "no output depends on what it writes: 'say \"no\"'"}])"));
    EXPECT_EQ(json["images"][3],
              Json::parse(R"({"name": "kept", "format": "rgba16f", "size": [8, 8], "layers": 2,
                              "cube": false, "used": true, "first": 3, "last": 5, "heap": 0,
                              "offset": 3328, "bytes": 2048, "alone": true})"));
    for (const auto& [member, value] :
         {std::pair("used", Json(false)), std::pair("first", Json(0)), std::pair("last", Json(0))})
        EXPECT_EQ(json["images"][5][member], value) << member;
    EXPECT_EQ(json["buffers"][0]["name"], "args");
    EXPECT_EQ(json["scene_passes"], 1);
    EXPECT_EQ(json["bytes"], 5376);
    EXPECT_EQ(json["bytes_unshared"], 6400);
}

TEST(EmptyDump, DumpOfAnEmptyGraphHasNoSections) {
    const Graph g;
    const GraphPlan plan = graph::plan_graph(g, {}, default_sizer());
    EXPECT_EQ(plan_to_text(g, plan),
              "0 passes, scene_passes 0, 0 bytes (0 without sharing)\n\npasses\n");
    EXPECT_THAT(plan_to_dot(g, plan), Not(HasSubstr("->")));
    EXPECT_EQ(Json::parse(plan_to_json(g, plan))["passes"], Json::array());
}

// In a frame of 100 mirrors, the depth images of all captures share the same memory.
TEST(LargeDump, DumpNamesTheFirstSharingImagesAndCountsTheOthers) {
    const Graph g = test::make_reuse_graph(100);
    const std::string text = plan_to_text(g, graph::plan_graph(g, {}, default_sizer()));
    EXPECT_THAT(text, HasSubstr("shares with 'view.depth', 'capture/1.depth', 'capture/2.depth'"));
    EXPECT_THAT(text, HasSubstr(", 'capture/31.depth' and 68 more\n"));
    EXPECT_THAT(text, HasSubstr(", 'capture/32.depth' and 68 more\n"));
}

} // namespace
} // namespace catoptric::graph
