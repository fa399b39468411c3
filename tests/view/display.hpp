#pragma once

#include "measure/picture.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace test {

/// Runs an X server without a screen (Xvfb) until the destructor. Sets DISPLAY to the server's
/// name.
class VirtualDisplay {
public:
    VirtualDisplay()
        : display_folder_(std::filesystem::temp_directory_path() /
                          ("catoptric-display-" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(display_folder_);
        int ends[2];
        if (::pipe(ends) != 0) return;
        server_ = ::fork();
        if (server_ == 0) {
            const std::string number = std::to_string(ends[1]);
            const int quiet = ::open("/dev/null", O_WRONLY);
            ::dup2(quiet, 1);
            ::dup2(quiet, 2);
            ::prctl(PR_SET_PDEATHSIG, SIGTERM); // ends the server even if the test crashes
            // Without -noreset the server restarts when the last window closes, and refuses windows
            // meanwhile.
            ::execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-noreset", "-screen", "0",
                     "1280x1024x24", "-fbdir", display_folder_.c_str(),
                     static_cast<char*>(nullptr));
            ::_exit(127);
        }
        ::close(ends[1]);
        std::string name;
        for (char c = 0; ::read(ends[0], &c, 1) == 1 && c != '\n';) name += c;
        ::close(ends[0]);
        is_there_ = !name.empty();
        if (is_there_) ::setenv("DISPLAY", (":" + name).c_str(), 1);
    }
    ~VirtualDisplay() {
        if (server_ <= 0) return;
        ::kill(server_, SIGTERM);
        ::waitpid(server_, nullptr, 0);
        std::error_code ignored;
        std::filesystem::remove_all(display_folder_, ignored);
    }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;
    bool is_display_running() const { return is_there_; }

    /// Returns the pixels in the upper left corner of the server's screen, where windows are
    /// placed. Channels are 0 to 1.
    catoptric::measure::Picture read_screen_pixels(int width, int height) const {
        std::ifstream file(display_folder_ / "Xvfb_screen0", std::ios::binary);
        const std::string bytes{std::istreambuf_iterator<char>(file), {}};
        const auto word = [&](std::size_t at) { // a big-endian word of the XWD header
            std::uint32_t value = 0;
            for (std::size_t i = 0; i < 4; ++i)
                value = value << 8 | static_cast<unsigned char>(bytes.at(4 * at + i));
            return value;
        };
        const std::size_t begin = word(0) + std::size_t{12} * word(19), row = word(12);
        catoptric::measure::Picture picture(width, height);
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 3; ++c)
                    picture.at(x, y)[c] = static_cast<float>(static_cast<unsigned char>(
                                              bytes.at(begin + static_cast<std::size_t>(y) * row +
                                                       4 * static_cast<std::size_t>(x) +
                                                       static_cast<std::size_t>(2 - c)))) /
                                          255;
        return picture;
    }

private:
    std::filesystem::path display_folder_;
    pid_t server_ = -1;
    bool is_there_ = false;
};

} // namespace test
