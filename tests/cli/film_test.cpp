// Tests of films: cameras from the views that `catoptric views` writes, ranges of frames, and the
// program ffmpeg, for which a script stands in in all tests but one.
#include "catoptric/file_sequence.hpp"
#include "catoptric/film.hpp"
#include "cli/program.hpp"
#include "measure/picture_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace {

using nlohmann::json;
using testing::HasSubstr;

namespace fs = std::filesystem;

class FilmTest : public CommandLineTest {
protected:
    static Words add_film_options(Words words) {
        words.insert(words.end(), {"--size", "32x24", "--exposure", "0"});
        return words;
    }
    test::ProcessResult render(const Words& more, const std::string& path = {}) const {
        Words words{"render"};
        words.insert(words.end(), more.begin(), more.end());
        test::ProcessStartOptions start = make_process_start(add_film_options(words));
        if (!path.empty()) start.environment["PATH"] = path;
        return test::run_process(start);
    }
    std::set<std::string> list_files() const {
        std::set<std::string> files;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder))
            if (!entry.is_directory()) files.insert(entry.path().filename().string());
        return files;
    }
    /// Writes a script in place of ffmpeg, which keeps its words and its input, and returns the
    /// PATH in which the program finds it.
    std::string write_stand_in_for_ffmpeg(const std::string& then) const {
        fs::create_directory(folder / "bin");
        const fs::path script = folder / "bin/ffmpeg";
        std::ofstream(script) << "#!/bin/sh\nfor word; do last=$word; done\n"
                                 "printf '%s\\n' \"$@\" > words.txt\n"
                              << then << "\n";
        fs::permissions(script, fs::perms::owner_all);
        return (folder / "bin").string() + ":/usr/bin:/bin";
    }
    /// Writes views.json for drawn cameras and returns its document.
    json write_views(const std::string& scene, int count) const {
        const test::ProcessResult ended = run_cli(
            {"views", scene, "--count", std::to_string(count), "-o", "views"});
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
        return json::parse(read_output_file("views/views.json"));
    }
};

std::string format_view_camera(const json& camera) {
    const auto join = [](const json& point) {
        return fmt::format("{},{},{}", point[0].get<double>(), point[1].get<double>(),
                           point[2].get<double>());
    };
    return fmt::format("{}:{}:{}", join(camera["eye"]), join(camera["target"]),
                       camera["vertical_fov_degrees"].get<double>());
}

TEST_F(FilmTest, EachFrameShowsOneViewAtItsInstant) {
    const json views = write_views("cornell-mirrors", 6);
    ASSERT_EQ(views["views"].size(), 7u) << "the scene's own camera comes first";
    const test::ProcessResult ended = render({"--technique", "raytrace:depth=2", "--camera-path",
                                              "views/views.json", "-o", "v_%02d.png", "--json"});
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_EQ(json::parse(ended.out)["frames"], 7);
    std::set<std::string> wanted;
    for (int n = 1; n <= 7; ++n) wanted.insert(fmt::format("v_{:02}.png", n));
    EXPECT_EQ(list_files(), wanted);
    std::set<std::string> pictures;
    for (const int n : {1, 3, 7}) {
        const json& view = views["views"][n - 1];
        ASSERT_EQ(render({"--technique", "raytrace:depth=2", "--camera",
                          format_view_camera(view["camera"]), "--time",
                          fmt::format("{}", view["time"].get<double>()), "-o", "still.png"})
                      .exit_code,
                  0);
        const std::string still = read_output_file("still.png");
        EXPECT_EQ(read_output_file(fmt::format("v_{:02}.png", n)), still) << n;
        pictures.insert(still);
    }
    EXPECT_EQ(pictures.size(), 3u);
}

/// Captures advance from frame to frame. After enough warm-up frames they no longer change, so a
/// frame equals the settled picture of its camera.
TEST_F(FilmTest, FrameOfAStillPathIsTheSettledPictureOfItsCamera) {
    const std::string camera = "300,290,-700:278,250,200:44";
    write_input_file("path.json", R"({"keys": [{"time": 0, "camera": ")" + camera +
                                      R"("}, {"time": 0.02, "camera": ")" + camera + R"("}]})");
    for (const char* technique : {"raytrace:depth=2", "parallax:face=16"}) {
        ASSERT_EQ(render({"--technique", technique, "--warmup", "27", "--camera-path", "path.json",
                          "-o", "f{n}.exr"})
                      .exit_code,
                  0);
        ASSERT_EQ(
            render({"--technique", technique, "--camera", camera, "-o", "still.exr"}).exit_code, 0);
        const auto still = catoptric::measure::read_picture(folder / "still.exr").pixels;
        for (const char* file : {"f1.exr", "f3.exr"})
            EXPECT_EQ(catoptric::measure::read_picture(folder / file).pixels, still)
                << technique << " " << file;
    }
}

TEST_F(FilmTest, RangeOfFramesIsAPartOfTheWholeSequence) {
    write_input_file("path.json", R"({"keys": [{"time": 0, "camera": "278,273,-800:278,273,0:40"},)"
                                  R"({"time": 1, "camera": "300,290,-700:278,250,200:48"}]})");
    const Words moving{"--technique", "reuse:face=16", "--warmup", "3",
                       "--animate",   "--camera-path", "path.json"};
    const auto render_frames = [&](const std::string& frames, const std::string& file) {
        Words words = moving;
        words.insert(words.end(), {"--frames", frames, "-o", file});
        const test::ProcessResult ended = render(words);
        EXPECT_EQ(ended.exit_code, 0) << ended.err;
    };
    render_frames("1..9", "whole_{n:2}.png");
    render_frames("7..9", "part_{n:2}.png");
    EXPECT_EQ(list_files().count("part_06.png") + list_files().count("part_10.png"), 0u);
    render_frames("9", "nine_{n:2}.png");
    for (int n = 1; n <= 9; ++n)
        EXPECT_EQ(read_output_file(fmt::format("nine_{:02}.png", n)),
                  read_output_file(fmt::format("whole_{:02}.png", n)));
    // The frames before frame 7 are its warm-up frames. At frame 9 five of them have filled the
    // captures, and 8-bit colours show no difference.
    EXPECT_EQ(read_output_file("part_09.png"), read_output_file("whole_09.png"));
    EXPECT_NE(read_output_file("part_09.png"), read_output_file("part_08.png"));
    // A technique without captures has exactly the same frames.
    for (const auto& [frames, file] : {std::pair{"1..5", "a{n}.exr"}, {"4..5", "b{n}.exr"}})
        ASSERT_EQ(render({"--technique", "raytrace:depth=2", "--animate", "--frames", frames,
                          "--camera-path", "path.json", "-o", file})
                      .exit_code,
                  0);
    EXPECT_EQ(read_output_file("a4.exr"), read_output_file("b4.exr"));
    EXPECT_EQ(read_output_file("a5.exr"), read_output_file("b5.exr"));
    EXPECT_FALSE(fs::exists(folder / "b3.exr"));
}

TEST_F(FilmTest, InvalidRangeIsRefused) {
    for (const auto& [range, part] : {std::pair{"0..3", "found '0'"},
                                      {"4..3", "found '3'"},
                                      {"..3", "found ''"},
                                      {"2..", "found ''"},
                                      {"1...3", "found '.3'"}})
        expect_usage_refused(
            {"render", "--technique", "reuse", "--frames", range, "-o", "f{n}.png"}, 2,
            {"--frames", part});
    expect_usage_refused({"compare", "-o", "out", "--frames", "1..3"}, 2, {"--frames", "1..3"});
}

TEST_F(FilmTest, FfmpegGetsEachFrameAsItIsDisplayed) {
    // The stand-in writes its input as the film.
    const std::string path = write_stand_in_for_ffmpeg("cat > \"${last#file:}\"");
    write_input_file("path.json", R"({"keys": [{"time": 0, "camera": "278,273,-800:278,273,0:40"},)"
                                  R"({"time": 0.05, "camera": "300,290,-700:278,250,200:48"}]})");
    const Words moving{"--technique", "parallax:face=16", "--camera-path", "path.json", "-o"};
    Words film = moving, pictures = moving;
    film.emplace_back("film.mp4"), pictures.emplace_back("p{n}.png");
    const test::ProcessResult ended = render(film, path);
    ASSERT_EQ(ended.exit_code, 0) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("written: film.mp4"));
    ASSERT_EQ(render(pictures).exit_code, 0);
    const std::string bytes = read_output_file("film.mp4");
    constexpr std::size_t kFrameBytes = 3 * 32 * 24;
    ASSERT_EQ(bytes.size(), 4 * kFrameBytes) << "three steps of 1/60 s";
    for (std::size_t n = 0; n < 4; ++n) {
        const auto picture = catoptric::measure::to_display(
            catoptric::measure::read_picture(folder / fmt::format("p{}.png", n + 1)));
        std::string wanted;
        for (const auto& pixel : picture.pixels)
            for (int c = 0; c < 3; ++c) wanted += static_cast<char>(std::lround(pixel[c] * 255));
        EXPECT_EQ(bytes.substr(n * kFrameBytes, kFrameBytes), wanted) << n;
    }
    const std::string words = read_output_file("words.txt");
    for (const char* part : {"rawvideo\n", "rgb24\n", "32x24\n", "-framerate\n60\n", "libx264\n",
                             "yuv420p\n", "file:/"})
        EXPECT_THAT(words, HasSubstr(part));
    EXPECT_EQ(list_files(), (std::set<std::string>{"film.mp4", "p1.png", "p2.png", "p3.png",
                                                   "p4.png", "path.json", "words.txt"}));
}

/// Returns the mean absolute difference of the luma (BT.709) of two displayed pictures, 0..255.
double compare_displayed_luma(const fs::path& a, const fs::path& b) {
    const auto first = catoptric::measure::to_display(catoptric::measure::read_picture(a)),
               second = catoptric::measure::to_display(catoptric::measure::read_picture(b));
    EXPECT_EQ(first.pixels.size(), second.pixels.size());
    double sum = 0;
    for (std::size_t i = 0; i < std::min(first.pixels.size(), second.pixels.size()); ++i)
        sum += std::abs(
            glm::dot(first.pixels[i] - second.pixels[i], catoptric::vec3(.2126f, .7152f, .0722f)));
    return 255 * sum / static_cast<double>(first.pixels.size());
}

/// Encodes by the program ffmpeg itself. H.264 with -crf 16 changes the luma of this small film by
/// a mean of 1.3 to 1.5 of 255. Decoding by the matrix of BT.601 would change it by more than 2,
/// and the frames before and after differ by more than 2.1.
TEST_F(FilmTest, FilmByFfmpegHasTheRenderedFrames) {
    for (const char* program : {"ffmpeg", "ffprobe"})
        if (!fs::exists(fs::path("/usr/bin") / program))
            GTEST_SKIP() << "no /usr/bin/" << program << ": install the Debian package ffmpeg";
    write_input_file("path.json", R"({"keys": [{"time": 0, "camera": "278,273,-800:278,273,0:40"},)"
                                  R"({"time": 0.2, "camera": "380,290,-600:278,250,200:48"}]})");
    for (const char* file : {"film.mp4", "p{n}.png"}) {
        test::ProcessStartOptions start = make_process_start(
            {"render", "--technique", "parallax:face=16", "--size", "96x64", "--exposure", "0",
             "--warmup", "2", "--frames", "3..9", "--camera-path", "path.json", "-o", file});
        start.environment["PATH"] = "/usr/bin:/bin";
        const test::ProcessResult ended = test::run_process(start);
        ASSERT_EQ(ended.exit_code, 0) << ended.err;
    }
    const test::ProcessResult probed = test::run_process(
        {.command = {"/usr/bin/ffprobe", "-v", "error", "-count_frames", "-of", "json",
                     "-show_streams", "film.mp4"},
         .folder = folder});
    ASSERT_EQ(probed.exit_code, 0) << probed.err;
    const json streams = json::parse(probed.out)["streams"];
    ASSERT_EQ(streams.size(), 1u) << "a film without sound";
    const json& video = streams[0];
    EXPECT_EQ(video["codec_name"], "h264");
    EXPECT_EQ(video["pix_fmt"], "yuv420p");
    EXPECT_EQ(video["color_space"], "bt709");
    EXPECT_EQ(video["width"], 96);
    EXPECT_EQ(video["height"], 64);
    EXPECT_EQ(video["r_frame_rate"], "60/1");
    EXPECT_EQ(video["avg_frame_rate"], "60/1");
    EXPECT_EQ(video["nb_read_frames"], "7") << "frames 3 to 9";
    const test::ProcessResult decoded = test::run_process(
        {.command = {"/usr/bin/ffmpeg", "-v", "error", "-i", "film.mp4", "-vf",
                     "scale=in_color_matrix=bt709", "-pix_fmt", "rgb24", "d%d.png"},
         .folder = folder});
    ASSERT_EQ(decoded.exit_code, 0) << decoded.err;
    EXPECT_FALSE(fs::exists(folder / "d8.png"));
    for (int n = 1; n <= 7; ++n) {
        const auto compare_with_frame = [&](int frame) {
            return compare_displayed_luma(folder / fmt::format("d{}.png", n),
                                          folder / fmt::format("p{}.png", frame));
        };
        const double difference = compare_with_frame(n + 2);
        EXPECT_LT(difference, 1.8) << n;
        for (const int neighbour : {n + 1, n + 3}) {
            if (neighbour < 3 || neighbour > 9) continue;
            EXPECT_LT(difference, .8 * compare_with_frame(neighbour)) << n;
        }
    }
}

TEST_F(FilmTest, FailedFfmpegLeavesTheOldFilmInPlace) {
    write_input_file("film.mp4", "old");
    for (const auto& [script, parts] :
         {std::pair{
              "head -c 100 > \"${last#file:}\"; echo no disk >&2; exit 3",
              Words{"film.mp4: cannot be written: ffmpeg, wanted exit code 0, found 3", "no disk"}},
          {"cat > \"${last#file:}\"; exit 1", {"wanted exit code 0, found 1"}},
          {"cat > /dev/null", {"film.mp4: cannot be"}},
          {"head -c 100 > \"${last#file:}\"; exit 0",
           {"film.mp4: wanted ffmpeg to read all frames, found that it ended before"}},
          {"kill -9 $$", {"wanted exit code 0, found signal 9"}}}) {
        const std::string path = write_stand_in_for_ffmpeg(script);
        const test::ProcessResult ended = render(
            {"--technique", "raytrace:depth=0", "--frames", "40", "-o", "film.mp4"}, path);
        EXPECT_EQ(ended.exit_code, 74) << script << ended.err;
        for (const std::string& part : parts) EXPECT_THAT(ended.err, HasSubstr(part)) << script;
        EXPECT_EQ(read_output_file("film.mp4"), "old");
        EXPECT_EQ(list_files(), (std::set<std::string>{"film.mp4", "words.txt"})) << script;
    }
}

/// A parent process that ignores the end of its children hands this on to the program.
TEST_F(FilmTest, FailureIsSeenIfTheParentIgnoresItsChildren) {
    write_input_file("film.mp4", "old");
    test::ProcessStartOptions start = make_process_start(add_film_options(
        {"render", "--technique", "raytrace:depth=0", "--frames", "2", "-o", "film.mp4"}));
    start.environment["PATH"] = write_stand_in_for_ffmpeg("cat > \"${last#file:}\"; exit 1");
    start.command.insert(start.command.begin(),
                         {"/bin/sh", "-c", "trap '' CHLD; exec \"$0\" \"$@\""});
    const test::ProcessResult ended = test::run_process(start);
    EXPECT_EQ(ended.exit_code, 74) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr("wanted exit code 0, found 1"));
    EXPECT_EQ(read_output_file("film.mp4"), "old");
}

TEST_F(FilmTest, SignalEndsTheFilmWithoutAFile) {
    test::ProcessStartOptions start = make_process_start(
        add_film_options({"render", "--technique", "raytrace:depth=0", "--progress", "always",
                          "--frames", "1000000", "-o", "film.mp4"}));
    start.environment["PATH"] = write_stand_in_for_ffmpeg("cat > \"${last#file:}\"");
    start.signal = SIGTERM, start.signal_at = "[1/1]";
    start.signal_after = std::chrono::milliseconds(1500);
    const test::ProcessResult ended = test::run_process(start);
    EXPECT_EQ(ended.exit_code, 143) << ended.err;
    EXPECT_EQ(list_files().count("film.mp4"), 0u);
    for (const std::string& file : list_files())
        EXPECT_EQ(file.find(".partial-"), std::string::npos) << file;
}

TEST_F(FilmTest, MissingFfmpegAndUnfitFilmsAreRefusedBeforeRendering) {
    fs::create_directory(folder / "empty");
    const std::string empty = (folder / "empty").string();
    expect_exit_code(render({"--technique", "raytrace", "--frames", "2", "-o", "film.mp4"}, empty),
                     66,
                     {"-o film.mp4: wanted the program ffmpeg in PATH", "found none",
                      "install the package ffmpeg (apt install ffmpeg)"});
    const std::string path = write_stand_in_for_ffmpeg("cat > /dev/null");
    const auto refuse = [&](const Words& words, const Words& parts) {
        expect_exit_code(render(words, path), 2, parts);
    };
    refuse({"--technique", "raytrace", "-o", "film.mp4"},
           {"-o film.mp4: wanted --frames, --animate or --camera-path with a film, found none"});
    refuse({"--technique", "raytrace", "--frames", "2", "-o", "film.mp4", "--aov", "all"},
           {"--aov: wanted -o with a name ending in .exr", "film.mp4"});
    refuse({"--technique", "raytrace", "--frames", "2", "-o", "film.avi"},
           {"-o: wanted a name ending in .exr, .png or .mp4, or -, found 'film.avi'"});
    test::ProcessStartOptions odd = make_process_start({"render", "--technique", "raytrace",
                                                        "--frames", "2", "--size", "33x24", "-o",
                                                        "film.mp4"});
    odd.environment["PATH"] = path;
    expect_exit_code(test::run_process(odd), 2,
                     {"-o film.mp4: wanted a film of an even width and height (--size), found "
                      "33x24"});
    test::ProcessStartOptions numbered = make_process_start(
        {"render", "--technique", "raytrace", "--frames", "2", "-o", "film-{n:3}.mp4"});
    numbered.environment["PATH"] = path;
    expect_exit_code(test::run_process(numbered), 2,
                     {"-o film-{n:3}.mp4: wanted a film's name without a place for the frame's "
                      "number, found one"});
    EXPECT_EQ(list_files(), std::set<std::string>());
}

TEST_F(FilmTest, FilesOfViewsAreChecked) {
    json views = write_views("cornell-mirrors", 1);
    views["views"].push_back(views["views"][0]);
    const auto refuse = [&](const json& document, int exit_code, const Words& more,
                            const Words& parts) {
        write_input_file("v.json", document.dump());
        Words words{"--technique", "raytrace:depth=0", "--camera-path", "v.json", "-o", "f{n}.png"};
        words.insert(words.end(), more.begin(), more.end());
        expect_exit_code(render(words), exit_code, parts);
    };
    refuse(views, 65, {"--frames", "3"},
           {"v.json: wanted 3 views, one for each frame of --frames, found 2"});
    refuse(views, 65, {"--frames", "2..4"}, {"v.json: wanted 4 views", "found 2"});
    refuse(views, 2, {"--animate"}, {"--animate: wanted it without views in --camera-path"});
    json other = views;
    other["schema"] = "catoptric/views/2";
    refuse(other, 65, {}, {"v.json: wanted the schema catoptric/views/1", "catoptric/views/2"});
    other = views, other["views"] = json::array();
    refuse(other, 65, {}, {"v.json: wanted at least one view in 'views', found none"});
    other = views, other["views"] = 3;
    refuse(other, 65, {}, {"v.json: wanted at least one view in 'views', found '3'"});
    other = views, other["views"][1]["camera"]["eye"] = {1, 2};
    refuse(other, 65, {}, {"v.json: views[1].camera.eye: wanted a list of three numbers"});
    other = views, other["views"][1]["camera"]["vertical_fov_degrees"] = 180;
    refuse(other, 65, {}, {"views[1].camera.vertical_fov_degrees: wanted a number above 0", "180"});
    other = views, other["views"][0]["time"] = "now";
    refuse(other, 65, {}, {"views[0].time: wanted seconds from -1e6 to 1e6, found"});
    other = views, other["views"][0]["camera"]["target"] = other["views"][0]["camera"]["eye"];
    refuse(other, 65, {},
           {"views[0].camera: wanted a camera that looks to a target", "up axis 0,"});
    other = views, other["views"][0] = 7;
    refuse(other, 65, {}, {"views[0]: wanted an object, found '7'"});
    EXPECT_FALSE(fs::exists(folder / "f1.png"));
}

} // namespace
