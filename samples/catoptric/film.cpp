#include "film.hpp"

#include "core/error.hpp"
#include "external_program.hpp"
#include "measure/picture_file.hpp"

#include <array>
#include <cerrno>
#include <cmath>
#include <csignal>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace catoptric::cli {

namespace {

constexpr int kFilmStopCheckMs = 100; // milliseconds between two checks for a stop

std::string describe_film_errno(int error) { return std::generic_category().message(error); }

} // namespace

bool is_film_name(const std::string& name) { return name.ends_with(".mp4"); }

void check_film(const std::string& file, uvec2 size) {
    check(
        !find_program("ffmpeg").empty(), Failure::missing_input, "-o ", file,
        ": wanted the program ffmpeg in PATH, which encodes films, found none; install the package "
        "ffmpeg (apt install ffmpeg), or write pictures (-o 'frame-{n:4}.png')");
    check(size.x % 2 == 0 && size.y % 2 == 0, Failure::usage, "-o ", file,
          ": wanted a film of an even width and height (--size), found ", size.x, "x", size.y);
}

std::vector<std::string> ffmpeg_words(uvec2 size, double frames_per_second,
                                      const std::string& output) {
    const std::string pixels = std::to_string(size.x) + "x" + std::to_string(size.y),
                      rate = std::to_string(std::lround(frames_per_second));
    std::vector<std::string> words{find_program("ffmpeg"), "-hide_banner", "-loglevel", "error",
                                   "-y"};
    for (const char* word : {"-f", "rawvideo", "-pix_fmt", "rgb24", "-video_size", pixels.c_str(),
                             "-framerate", rate.c_str(), "-i", "pipe:0"})
        words.emplace_back(word);
    // Colours are those of BT.709, which players assume if a file does not say otherwise.
    for (const char* word :
         {"-vf", "scale=out_color_matrix=bt709", "-c:v", "libx264", "-crf", "16", "-pix_fmt",
          "yuv420p", "-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709",
          "-movflags", "+faststart", "-f", "mp4"})
        words.emplace_back(word);
    words.push_back("file:" + output); // a name with a colon would be an address
    return words;
}

FilmWriter::FilmWriter(const std::string& file, uvec2 size, double frames_per_second,
                       const session::Watcher& watcher)
    : name_(file), partial_(file), watcher_(watcher) {
    check_film(file, size);
    start_ffmpeg(ffmpeg_words(size, frames_per_second,
                              std::filesystem::absolute(partial_.temporary()).string()));
}

FilmWriter::~FilmWriter() {
    if (input_ >= 0) ::close(input_);
    if (process_ == 0) return;
    ::kill(process_, SIGKILL); // after SIGTERM, ffmpeg would write the rest of its file
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) {
    }
}

void FilmWriter::start_ffmpeg(const std::vector<std::string>& words) {
    std::array<int, 2> ends{};
    check(::pipe2(ends.data(), O_CLOEXEC) == 0, Failure::io, name_,
          ": wanted a pipe to ffmpeg, found: ", describe_film_errno(errno));
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[0], STDIN_FILENO);
    // Our stdout may carry JSON.
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    const int error = ::posix_spawn(&process_, words.front().c_str(), &actions, nullptr,
                                    arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[0]);
    input_ = ends[1];
    if (error != 0) {
        ::close(input_);
        process_ = 0;
        fail(Failure::missing_input, words.front(),
             ": cannot be run: ", describe_film_errno(error));
    }
    ::fcntl(input_, F_SETFL, O_NONBLOCK);
}

int FilmWriter::wait_for_ffmpeg() {
    for (int status = 0;;) {
        const pid_t ended = ::waitpid(process_, &status, WNOHANG);
        if (ended < 0 && errno == EINTR) continue;
        if (ended == 0) {
            session::throw_if_stopped(watcher_);
            ::poll(nullptr, 0, kFilmStopCheckMs / 10);
            continue;
        }
        process_ = 0;
        check(ended > 0, Failure::io, name_,
              ": wanted the exit code of ffmpeg, found: ", describe_film_errno(errno));
        return status;
    }
}

void FilmWriter::fail_ended(int status) const {
    session::throw_if_stopped(watcher_); // a signal from the terminal ends ffmpeg, too
    check(!WIFEXITED(status) || WEXITSTATUS(status) != 0, Failure::io, name_,
          ": wanted ffmpeg to read all frames, found that it ended before");
    fail(Failure::io, name_, ": cannot be written: ffmpeg, wanted exit code 0, found ",
         WIFSIGNALED(status) ? "signal " : "",
         WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
}

void FilmWriter::write_bytes(const std::vector<std::uint8_t>& bytes) {
    for (std::size_t written = 0; written < bytes.size();) {
        session::throw_if_stopped(watcher_);
        pollfd ready{input_, POLLOUT, 0};
        if (::poll(&ready, 1, kFilmStopCheckMs) <= 0) continue;
        const ssize_t count = ::write(input_, bytes.data() + written, bytes.size() - written);
        if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (count < 0 && errno == EPIPE) fail_ended(wait_for_ffmpeg());
        check(count > 0, Failure::io, name_, ": writing to ffmpeg: ", describe_film_errno(errno));
        written += static_cast<std::size_t>(count);
    }
}

void FilmWriter::add_frame(const measure::Picture& display) {
    write_bytes(measure::to_bytes(display));
}

void FilmWriter::finish() {
    ::close(input_);
    input_ = -1;
    const int status = wait_for_ffmpeg(); // it encodes the last frames after its input has ended
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) fail_ended(status);
    partial_.copy_mode();
    partial_.commit();
}

} // namespace catoptric::cli
