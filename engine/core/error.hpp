#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace catoptric {

/// Why something failed; the value is the exit code of the command line program (sysexits.h).
enum class Failure {
    threshold = 1,      ///< a measured value is over the limit the user gave
    usage = 2,          ///< unknown name, value out of range
    bad_data = 65,      ///< an input file says something that cannot be
    missing_input = 66, ///< an input file is not there
    no_device = 69,     ///< no Vulkan device, or none that can do what is needed
    internal = 70,      ///< a promise of our own is broken
    cannot_create = 73, ///< an output file or folder cannot be made
    io = 74,            ///< reading or writing failed half-way
    exhausted = 75,     ///< out of memory or over a device limit
    device_lost = 76,
    hangup = 129,      ///< SIGHUP
    interrupted = 130, ///< SIGINT
    terminated = 143,  ///< SIGTERM
};

/// Thrown by `check` and `fail`. `what()` says what, where, wanted and found.
class Error : public std::runtime_error {
public:
    Error(Failure why, const std::string& message) : std::runtime_error(message), failure(why) {}
    Failure failure;
};

/// Whether a signal asked for it.
constexpr bool is_stop(Failure failure) {
    return failure == Failure::hangup || failure == Failure::interrupted ||
           failure == Failure::terminated;
}

/// Throws `Error` with the parts streamed one after the other.
template <typename... Parts>
[[noreturn]] void fail(Failure failure, const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    throw Error(failure, text.str());
}

/// Throws `Error(failure)` with the streamed parts unless `ok`.
template <typename... Parts>
void check(bool ok, Failure failure, const Parts&... parts) {
    if (!ok) fail(failure, parts...);
}

} // namespace catoptric
