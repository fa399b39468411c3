#include "external_program.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace catoptric::cli {

std::string find_program(const std::string& name) {
    const char* const path = std::getenv("PATH");
    std::string_view rest = path ? path : "";
    while (!rest.empty()) {
        const std::size_t end = std::min(rest.find(':'), rest.size());
        const std::filesystem::path file = std::filesystem::path(rest.substr(0, end)) / name;
        std::error_code error;
        if (end > 0 && std::filesystem::is_regular_file(file, error) &&
            ::access(file.c_str(), X_OK) == 0)
            return file.string();
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    return {};
}

void run_external(const std::vector<std::string>& words, const std::string& name) {
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    // Our stdin may be a scene, and our stdout may carry JSON.
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    // In a process group of its own, a signal from the terminal stops this program only.
    posix_spawnattr_t attributes;
    ::posix_spawnattr_init(&attributes);
    ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    pid_t process = 0;
    const int error = ::posix_spawn(&process, words.front().c_str(), &actions, &attributes,
                                    arguments.data(), environ);
    ::posix_spawnattr_destroy(&attributes);
    ::posix_spawn_file_actions_destroy(&actions);
    check(error == 0, Failure::missing_input, words.front(),
          ": cannot be run: ", std::generic_category().message(error));
    int status = 0;
    pid_t ended = 0;
    do ended = ::waitpid(process, &status, 0);
    while (ended < 0 && errno == EINTR);
    check(ended > 0, Failure::io, name, ": wanted the exit code of ", words.front(),
          ", found: ", std::generic_category().message(errno));
    check(WIFEXITED(status) && WEXITSTATUS(status) == 0, Failure::io, name,
          ": cannot be written: ", words.front(), ", wanted exit code 0, found ",
          WIFSIGNALED(status) ? "signal " : "",
          WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status));
}

} // namespace catoptric::cli
