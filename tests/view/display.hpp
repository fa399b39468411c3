#pragma once

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <string>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace test {

/// An X server without a screen, for as long as this lives; DISPLAY names it.
class Display {
public:
    Display() {
        int ends[2];
        if (::pipe(ends) != 0) return;
        server_ = ::fork();
        if (server_ == 0) {
            const std::string number = std::to_string(ends[1]);
            const int quiet = ::open("/dev/null", O_WRONLY);
            ::dup2(quiet, 2);
            ::execlp("Xvfb", "Xvfb", "-displayfd", number.c_str(), "-screen", "0", "1280x1024x24",
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
    ~Display() {
        if (server_ <= 0) return;
        ::kill(server_, SIGTERM);
        ::waitpid(server_, nullptr, 0);
    }
    Display(const Display&) = delete;
    Display& operator=(const Display&) = delete;
    bool is_there() const { return is_there_; }

private:
    pid_t server_ = -1;
    bool is_there_ = false;
};

} // namespace test
