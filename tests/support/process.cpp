#include "support/process.hpp"

#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace test {

namespace {

using Clock = std::chrono::steady_clock;

double seconds_since_time(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Reads all text from a file descriptor and closes it. Calls `seen` once, as soon as the text
/// contains `marker`.
std::string read_file_descriptor_text(int fd, const std::string& marker = {},
                                      std::function<void()> seen = {}) {
    std::string text;
    char block[1 << 16];
    for (ssize_t count; (count = ::read(fd, block, sizeof block)) > 0;) {
        text.append(block, static_cast<std::size_t>(count));
        if (seen && text.find(marker) != std::string::npos) std::exchange(seen, {})();
    }
    ::close(fd);
    return text;
}

/// Prepares the child process after fork as `start` says, and then executes the program.
[[noreturn]] void execute_program(const ProcessStartOptions& start, int out, int err) {
    for (const int signal : {SIGHUP, SIGINT, SIGTERM, SIGPIPE, SIGXFSZ}) ::signal(signal, SIG_DFL);
    for (const auto& [resource, most] :
         {std::pair{RLIMIT_FSIZE, start.file_limit}, std::pair{RLIMIT_AS, start.memory_limit},
          std::pair{RLIMIT_CPU, start.seconds_limit}}) {
        const rlimit limit{most, most};
        if (most > 0) ::setrlimit(resource, &limit);
    }
    if (!start.out_path.empty())
        out = ::open(start.out_path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    ::dup2(::open("/dev/null", O_RDONLY), 0);
    ::dup2(out, 1);
    ::dup2(err, 2);
    if (!start.folder.empty() && ::chdir(start.folder.c_str()) != 0) ::_exit(126);
    for (const auto& [name, value] : start.environment) ::setenv(name.c_str(), value.c_str(), 1);
    std::vector<char*> arguments;
    for (const std::string& word : start.command)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
}

} // namespace

ProcessResult run_process(const ProcessStartOptions& start) {
    int out[2], err[2];
    if (::pipe2(out, O_CLOEXEC) != 0 || ::pipe2(err, O_CLOEXEC) != 0) return {};
    if (start.no_reader) ::close(out[0]);
    const Clock::time_point begin = Clock::now();
    Clock::time_point signalled = begin;
    const pid_t child = ::fork();
    if (child == 0) execute_program(start, out[1], err[1]);
    ::close(out[1]);
    ::close(err[1]);
    ProcessResult ended;
    std::thread reader([&] {
        if (!start.no_reader) ended.out = read_file_descriptor_text(out[0]);
    });
    std::function<void()> send;
    if (start.signal != 0)
        send = [&] {
            std::this_thread::sleep_for(start.signal_after);
            signalled = Clock::now();
            ::kill(child, start.signal);
            if (start.again_after.count() == 0) return;
            std::this_thread::sleep_for(start.again_after);
            ::kill(child, start.signal);
        };
    ended.err = read_file_descriptor_text(err[0], start.signal_at, send);
    reader.join();
    int status = 0;
    rusage usage{};
    ::wait4(child, &status, 0, &usage);
    ended.peak_bytes = static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
    ended.seconds = seconds_since_time(begin);
    for (const timeval& used : {usage.ru_utime, usage.ru_stime})
        ended.processor_seconds += double(used.tv_sec) + 1e-6 * double(used.tv_usec);
    if (signalled != begin) ended.seconds_after_signal = seconds_since_time(signalled);
    ended.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    return ended;
}

std::string run_in_forked_process(const std::function<std::string()>& work) {
    int out[2];
    if (::pipe2(out, O_CLOEXEC) != 0) return "no pipe";
    const pid_t child = ::fork();
    if (child == 0) {
        std::string said;
        try {
            said = work();
        } catch (const std::exception& error) {
            said = std::string("ended by an exception: ") + error.what();
        }
        for (std::size_t at = 0; at < said.size();) {
            const ssize_t written = ::write(out[1], said.data() + at, said.size() - at);
            if (written <= 0) break;
            at += static_cast<std::size_t>(written);
        }
        ::_exit(0);
    }
    ::close(out[1]);
    std::string said = read_file_descriptor_text(out[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    if (WIFSIGNALED(status)) said += "ended by signal " + std::to_string(WTERMSIG(status));
    return said;
}

} // namespace test
