// Tests of the capture cache with hand-made models of what a picture requires: which faces a frame
// draws, and what the other faces hold.
#include "require/model.hpp"
#include "require/pieces.hpp"
#include "support/refusal.hpp"
#include "support/rendering.hpp"
#include "support/techniques.hpp"

namespace {

using namespace catoptric;
using Names = std::vector<std::string>;

/// Renders frames of `parallax` in a test room with three mirror balls. Tests edit `model_`, which
/// says what the next frame requires.
class CaptureCacheFramesTest : public testing::Test {
protected:
    CaptureCacheFramesTest() {
        scene_.update(room_, room_.cameras.front(), kCachedPictureSize, .05);
        model_ = require::make_required_model({room_, room_.cameras.front(), kCachedPictureSize});
    }

    /// Renders a frame and returns the names of its passes, except `view` and `compose`.
    Names render_and_list_passes(const std::string& technique = "parallax:face=8") {
        graph::Graph graph(runner_.make_history());
        const reflect::Assignment assignment = reflect::assign_techniques(
            reflect::parse_plan(technique), std::vector<std::string>(3, "ball"));
        render::FrameRequests requests(shown_->next_view());
        outputs_ = reflect::add_frame_passes(graph, {*shown_, requests, kCachedPictureSize, ""},
                                             assignment, {model_, kept_, &comparisons_, most_});
        shown_->fulfil(requests, [] {});
        graph.output(outputs_.hdr);
        runner_.run_and_wait(graph, graph::PassTiming::isolated);
        kept_ = outputs_.kept;
        if (learns_) render::read_comparisons(kept_, [](std::uint64_t) { return true; });
        Names names;
        for (const graph::PlannedPass& planned : runner_.plan(graph).passes)
            if (graph.passes()[planned.pass].name != "view")
                names.push_back(graph.passes()[planned.pass].name);
        return names;
    }
    void render_until_captures_are_kept(const std::string& technique = "parallax:face=8") {
        for (int k = 0; k < 40; ++k)
            if (render_and_list_passes(technique).empty()) return;
        ADD_FAILURE() << "captures are still drawn";
    }
    /// Returns the colours of `count` faces of a mirror's capture, as bytes. Mirrors and faces are
    /// numbered from 0.
    std::vector<std::byte> read_capture_colours(std::uint32_t mirror, std::uint32_t face = 0,
                                                std::uint32_t count = 6) {
        const auto& [array, cube] = outputs_.captures->places[mirror];
        return runner_.read_back(
            outputs_.captures->arrays[array].colour.layers(6 * cube + face, count));
    }

    static constexpr uvec2 kCachedPictureSize{32, 24};
    test::TestDevice& bench_ = test::get_test_device();
    scene::Scene room_ = test::make_lit_room(3, 2);
    render::GpuScene scene_{bench_.device, room_};
    render::GpuScene* shown_ = &scene_; ///< the scene that the frames show
    render::ComparisonBuffers comparisons_{
        bench_.device, [this](std::uint64_t frame) { return runner_.has_ended({frame}); }};
    graph::GraphRunner runner_{bench_.device, bench_.pipelines};
    require::WorkModel model_;
    std::shared_ptr<render::CaptureCache> kept_;
    std::uint32_t most_ = 0; ///< mirrors whose captures a frame draws again at most; 0: all
    bool learns_ = true;
    reflect::TechniqueOutputs outputs_;
};

TEST_F(CaptureCacheFramesTest, FacesWithAChangedContentHashAreDrawn) {
    // Without this loop, mirrors that see mirror 1 would be drawn as well.
    for (require::MirrorRequirements& mirror : model_.mirrors) mirror.sees.clear();
    render_until_captures_are_kept();
    EXPECT_EQ(render_and_list_passes(), Names());
    const std::vector<std::byte> before = read_capture_colours(0, 0, 2);
    for (const std::size_t face : {2, 3, 5}) model_.mirrors[0].content_hashes[face] += 1;
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/1.3-4", "capture/1.6-6"}));
    EXPECT_EQ(read_capture_colours(0, 0, 2), before);
    model_.mirrors[0].content_hashes[5] += 1;
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/1.6-6"}))
        << "3 and 4 lie in one set yet";
    model_.mirrors[0].content_hashes[5] += 1;
    EXPECT_EQ(render_and_list_passes(), Names{"capture/1.6-6"});
    EXPECT_EQ(render_and_list_passes(), Names());
}

// Tests that a frame draws only the part of a face in which something moved. The ambient light
// changes too, but the model does not say so. Each texel therefore tells by its brightness whether
// the frame has drawn the texel.
TEST_F(CaptureCacheFramesTest, OnlyThePartOfAFaceInWhichSomethingMovedIsDrawn) {
    const std::string technique = "parallax:face=32";
    for (require::MirrorRequirements& mirror : model_.mirrors) mirror.sees.clear();
    const auto tell = [&](std::uint64_t content_hash, const require::FacePart& part) {
        const auto pieces = std::make_shared<require::MovingParts>();
        pieces->faces[5] = {{content_hash, part}};
        model_.mirrors[0].pieces = pieces;
        model_.mirrors[0].content_hashes[5] += 1;
    };
    const auto drawn = [&](const Names& names, const uvec2& first, const uvec2& end) {
        const std::vector<std::byte> before = read_capture_colours(0, 5, 1);
        EXPECT_EQ(render_and_list_passes(technique), names);
        const std::vector<std::byte> after = read_capture_colours(0, 5, 1);
        constexpr std::size_t kTexelBytes = 8; // size of a texel in bytes: four half floats
        for (std::uint32_t i = 0; i < 32 * 32; ++i) {
            const uvec2 at(i % 32, i / 32);
            const bool is_inside = all(lessThanEqual(first, at)) && all(lessThan(at, end));
            EXPECT_EQ(std::memcmp(&before[kTexelBytes * i], &after[kTexelBytes * i], kTexelBytes) !=
                          0,
                      is_inside)
                << at.x << ", " << at.y;
        }
    };
    tell(1, {dvec2(-.5, -.25), dvec2(0)});
    render_until_captures_are_kept(technique);
    scene_.update(room_, room_.cameras.front(), kCachedPictureSize, .5);
    // The frame draws the area from the mover's old place to its new place, and one texel around.
    tell(2, {dvec2(.5, 0), dvec2(.75, .25)});
    drawn({"capture.keep", "capture/1.6-6"}, {7, 11}, {29, 21});
    scene_.update(room_, room_.cameras.front(), kCachedPictureSize, 1);
    tell(3, {dvec2(.5, 0), dvec2(.9, .25)});
    drawn({"capture.keep", "capture/1.6-6"}, {23, 15}, {32, 21});
    // A capture that was put off has missed a movement. The cache does not know the area of that
    // movement, so the next frame draws the whole face.
    most_ = 1;
    scene_.update(room_, room_.cameras.front(), kCachedPictureSize, 2);
    model_.mirrors[1].content_hashes.fill(9), model_.mirrors[1].pieces = nullptr;
    tell(4, {dvec2(.6, 0), dvec2(.7, .25)});
    render_and_list_passes(
        technique); // this frame draws the first mirror, and only a small area of its face
    EXPECT_EQ(kept_->waited, (std::vector<std::uint32_t>{0, 1, 0}));
    tell(5, {dvec2(.6, 0), dvec2(.8, .25)});
    render_and_list_passes(technique);
    EXPECT_EQ(kept_->waited, (std::vector<std::uint32_t>{1, 0, 0}));
    scene_.update(room_, room_.cameras.front(), kCachedPictureSize, 3);
    drawn({"capture.keep", "capture/1.6-6"}, {0, 0}, {32, 32});
}

// Tests the pyramid, a tree of bounds of the captured distances. If a frame draws one face of a
// capture, the pyramid of all six faces must be computed again.
TEST_F(CaptureCacheFramesTest, PyramidIsMadeAgainWhenAFaceIsDrawn) {
    for (require::MirrorRequirements& mirror : model_.mirrors) mirror.sees.clear();
    const std::string pyramid = "pyramid:face=8";
    EXPECT_EQ(render_and_list_passes(pyramid).back(), "pyramid");
    render_until_captures_are_kept(pyramid);
    EXPECT_EQ(render_and_list_passes(pyramid), Names());
    for (const std::size_t mirror : {0, 1, 2}) {
        model_.mirrors[mirror].content_hashes[5] += 1;
        const std::string drawn = "capture/" + std::to_string(mirror + 1) + ".6-6";
        EXPECT_EQ(render_and_list_passes(pyramid), (Names{"capture.keep", drawn, "pyramid"}));
        model_.mirrors[mirror].content_hashes[5] += 1;
        EXPECT_EQ(render_and_list_passes(pyramid), (Names{drawn, "pyramid"}))
            << "the other set has the rest";
        EXPECT_EQ(render_and_list_passes(pyramid), Names());
    }
}

// Tests the filtered levels of captures. A frame filters only the captures that it draws again. At
// rest no capture is filtered.
TEST_F(CaptureCacheFramesTest, LevelsAreFilteredAgainWhenAFaceIsDrawn) {
    test::make_mirrors_rough(room_, .3f);
    render::GpuScene rough(bench_.device, room_);
    rough.update(room_, room_.cameras.front(), kCachedPictureSize, .05);
    shown_ = &rough;
    for (require::MirrorRequirements& mirror : model_.mirrors) mirror.sees.clear();
    const std::string levels = "parallax:face=8,taps=16";
    const Names first = render_and_list_passes(levels);
    ASSERT_GE(first.size(), 2u);
    EXPECT_EQ(first[first.size() - 2], "rough/prefilter16/boxes");
    EXPECT_EQ(first.back(), "rough/prefilter16");
    render_until_captures_are_kept(levels);
    EXPECT_EQ(render_and_list_passes(levels), Names());
    model_.mirrors[1].content_hashes[5] += 1;
    EXPECT_EQ(
        render_and_list_passes(levels),
        (Names{"capture.keep", "capture/2.6-6", "rough/prefilter16/boxes", "rough/prefilter16"}));
    render_until_captures_are_kept(levels);
    EXPECT_EQ(render_and_list_passes(levels), Names());
    EXPECT_EQ(render_and_list_passes("parallax:face=8,rough=mips").back(), "rough/mips/boxes");
}

TEST_F(CaptureCacheFramesTest, FacesThatNobodyReadsAreCleared) {
    model_.mirrors[1].faces = 0b000110;
    const Names first = render_and_list_passes();
    EXPECT_EQ(first, (Names{"shadow/1", "shadow/2", "capture/1", "capture/2.2-3",
                            "capture/2.1-1.clear", "capture/2.4-6.clear", "capture/3"}));
    const std::vector<std::byte> empty = read_capture_colours(1, 0, 1);
    EXPECT_TRUE(std::ranges::all_of(empty, [](std::byte byte) {
        return byte == std::byte{0} || byte == std::byte{0x3c}; // half floats of black with alpha 1
    }));
    render_until_captures_are_kept();
    model_.mirrors[1].faces = require::kAllFaces;
    const Names names = render_and_list_passes();
    EXPECT_TRUE(std::ranges::find(names, "capture/2.4-6") != names.end()) << "now they are";
    render_until_captures_are_kept();
    const std::vector<std::byte> late = read_capture_colours(1);
    kept_ = nullptr, runner_.discard_contents();
    render_until_captures_are_kept();
    EXPECT_EQ(late, read_capture_colours(1));
}

TEST_F(CaptureCacheFramesTest, MirrorsThatAreCapturedLaterAreAdded) {
    model_.mirrors[1].is_captured = false;
    const Names first = render_and_list_passes();
    EXPECT_EQ(first, (Names{"shadow/1", "shadow/2", "capture.a.table", "capture/1", "capture/3"}));
    EXPECT_FALSE(outputs_.captures->places[1].has_capture());
    for (int k = 0; k < 40; ++k)
        if (render_and_list_passes().size() == 1) break;
    model_.mirrors[1].is_captured = true;
    const Names second = render_and_list_passes();
    EXPECT_TRUE(std::ranges::find(second, "capture.keep") != second.end()) << "into more layers";
    EXPECT_TRUE(std::ranges::find(second, "capture/2") != second.end());
    render_until_captures_are_kept();
    std::vector<std::vector<std::byte>> late;
    for (std::uint32_t mirror = 0; mirror < 3; ++mirror)
        late.push_back(read_capture_colours(mirror));
    // If a mirror goes out of sight again, its capture is not drawn any more, and the arrays of
    // captures keep their size.
    model_.mirrors[1].is_captured = false;
    render_until_captures_are_kept();
    model_.mirrors[1].is_captured = true;
    render_until_captures_are_kept();
    kept_ = nullptr, runner_.discard_contents();
    render_until_captures_are_kept();
    for (std::uint32_t mirror = 0; mirror < 3; ++mirror)
        EXPECT_EQ(late[mirror], read_capture_colours(mirror)) << mirror;
}

TEST_F(CaptureCacheFramesTest, MirrorsTakeTurnsUnderACaptureBudget) {
    for (require::MirrorRequirements& mirror : model_.mirrors) mirror.sees.clear();
    const auto change = [&](std::initializer_list<std::size_t> mirrors) {
        for (const std::size_t mirror : mirrors) model_.mirrors[mirror].content_hashes[5] += 1;
    };
    render_until_captures_are_kept();
    render_and_list_passes(), most_ = 1;
    change({0, 1, 2});
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/1.6-6"}));
    EXPECT_EQ(kept_->waited, (std::vector<std::uint32_t>{0, 1, 1}));
    change({0});
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/2.6-6"}));
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/3.6-6"}));
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/1.6-6"}))
        << "it asked last";
    EXPECT_EQ(render_and_list_passes(), Names());
    most_ = 2;
    Names drawn;
    for (int k = 0; k < 4; ++k) { // all mirrors change in each frame
        change({0, 1, 2});
        for (const std::string& name : render_and_list_passes())
            if (name != "capture.keep") drawn.push_back(name.substr(0, 9));
    }
    EXPECT_EQ(drawn, (Names{"capture/1", "capture/2", "capture/1", "capture/3", "capture/1",
                            "capture/2", "capture/1", "capture/3"}));
}

// Mirror 1 changes while the redraw of mirror 2, which shows mirror 1, is put off. Mirror 2 must
// still be drawn, although mirror 1 no longer changes. A mirror that comes into view is drawn at
// once, beyond the budget.
TEST_F(CaptureCacheFramesTest, MirrorsThatWaitAreDrawnThoughTheirCauseHasEnded) {
    for (require::MirrorRequirements& mirror : model_.mirrors) mirror.sees.clear();
    model_.mirrors[1].sees = {0}, model_.mirrors[2].sees = {0};
    render_until_captures_are_kept();
    most_ = 1;
    model_.mirrors[0].content_hashes.fill(77);
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/1"}));
    // These frames come after the first mirror has changed, and without a further change.
    const auto compared = [](const Names& names) {
        return !names.empty() && names.back() == "capture.compare";
    };
    EXPECT_TRUE(compared(render_and_list_passes())) << "the second";
    EXPECT_EQ(kept_->waited, (std::vector<std::uint32_t>{0, 0, 1}));
    EXPECT_TRUE(compared(render_and_list_passes())) << "the third";
    EXPECT_EQ(render_and_list_passes(), Names());
    model_.mirrors[1].is_captured = false;
    model_.mirrors[1].content_hashes.fill(5);
    EXPECT_EQ(render_and_list_passes(), Names());
    model_.mirrors[1].is_captured = true;
    model_.mirrors[0].content_hashes.fill(78), model_.mirrors[2].content_hashes.fill(78);
    EXPECT_EQ(render_and_list_passes(), (Names{"capture.keep", "capture/1", "capture/2"}));
}

TEST_F(CaptureCacheFramesTest, BudgetIsRefusedBeforeChangesAreKnown) {
    render_and_list_passes();
    learns_ = false;
    render_and_list_passes(); // the result of this frame's comparison is never read
    most_ = 1;
    test::expect_error([&] { render_and_list_passes(); }, Failure::internal,
                       {"captures 'capture' depend on comparisons of faces"});
}

TEST_F(CaptureCacheFramesTest, OnlyShadowMapsThatAreNeededAreDrawn) {
    model_.lights[1].has_map = false;
    render_until_captures_are_kept();
    model_.lights[0].content_hash += 1;
    EXPECT_EQ(render_and_list_passes("naive:bounces=0"), Names{"shadow/1"});
    model_.lights[1].has_map = true;
    EXPECT_EQ(render_and_list_passes("naive:bounces=0"), Names{"shadow/2"});
}

} // namespace
