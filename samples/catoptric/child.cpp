#include "child.hpp"

#include "core/error.hpp"
#include "session/watcher.hpp"

#include <array>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace catoptric::cli {

namespace {

constexpr int kStopCheckMs = 100; // milliseconds between two checks of `stop`

std::string describe_errno(int error) { return std::generic_category().message(error); }

/// A started program. The destructor ends the program and waits for its end.
class ChildProcess {
public:
    explicit ChildProcess(const std::vector<std::string>& command) : name_(command.front()) {
        std::array<int, 2> ends{};
        check(::pipe2(ends.data(), O_CLOEXEC) == 0, Failure::io, "a pipe: ", describe_errno(errno));
        std::vector<char*> words;
        for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
        words.push_back(nullptr);
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        const int error = ::posix_spawn(&process_, words.front(), &actions, nullptr, words.data(),
                                        environ);
        ::posix_spawn_file_actions_destroy(&actions);
        ::close(ends[1]);
        out_ = ends[0];
        if (error != 0) ::close(out_);
        check(error == 0, Failure::missing_input, name_,
              ": cannot be run: ", describe_errno(error));
    }
    ~ChildProcess() {
        ::close(out_);
        if (process_ > 0) {
            ::kill(process_, SIGTERM);
            wait_for_exit();
        }
    }
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;

    /// Returns all output of the program until it closes its stdout.
    std::string read_output(const session::Watcher& watcher) const {
        std::string text;
        for (;;) {
            throw_if_stopped(watcher);
            pollfd ready{out_, POLLIN, 0};
            if (::poll(&ready, 1, kStopCheckMs) <= 0) continue;
            std::array<char, 1 << 16> block{};
            const ssize_t count = ::read(out_, block.data(), block.size());
            if (count < 0 && errno == EINTR) continue;
            check(count >= 0, Failure::io, name_,
                  ": reading what it writes: ", describe_errno(errno));
            if (count == 0) return text;
            text.append(block.data(), static_cast<std::size_t>(count));
        }
    }
    void check_exit() {
        const int status = wait_for_exit();
        if (WIFSIGNALED(status))
            fail(Failure::bad_data, name_, ": wanted exit code 0, found signal ", WTERMSIG(status));
        check(WEXITSTATUS(status) == 0, Failure::bad_data, name_, ": wanted exit code 0, found ",
              WEXITSTATUS(status));
    }

private:
    int wait_for_exit() {
        int status = 0;
        while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
        }
        process_ = 0;
        return status;
    }

    std::string name_;
    pid_t process_ = 0;
    int out_ = -1;
};

} // namespace

std::string output_of(const std::vector<std::string>& command, const std::atomic<int>& stop) {
    ChildProcess child(command);
    session::Watcher watcher;
    watcher.stop = &stop;
    std::string text = child.read_output(watcher);
    child.check_exit();
    return text;
}

} // namespace catoptric::cli
