#pragma once

#include "export.hpp"

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

/// Whether a signal asked for it.
constexpr bool is_stop(Failure failure) {
    return failure == Failure::hangup || failure == Failure::interrupted ||
           failure == Failure::terminated;
}

/// What everything that fails throws: one of the types below, by its `failure`. `what()` says what,
/// where, wanted and found.
class CATOPTRIC_API Error : public std::runtime_error {
public:
    Error(Failure why, const std::string& message) : std::runtime_error(message), failure(why) {}
    Failure failure;
};

/// Of one kind of failure, for who catches only that.
template <Failure kind>
class CATOPTRIC_API ErrorOf : public Error {
public:
    explicit ErrorOf(const std::string& message) : Error(kind, message) {}
};
using UsageError = ErrorOf<Failure::usage>;
using BadData = ErrorOf<Failure::bad_data>;
using MissingInput = ErrorOf<Failure::missing_input>;
using NoDevice = ErrorOf<Failure::no_device>;
using InternalError = ErrorOf<Failure::internal>;
using CannotCreate = ErrorOf<Failure::cannot_create>;
using IoError = ErrorOf<Failure::io>;
using Exhausted = ErrorOf<Failure::exhausted>;
using DeviceLost = ErrorOf<Failure::device_lost>;

/// Throws what has this failure's type; `Error` itself where a signal or a threshold ends things.
[[noreturn]] CATOPTRIC_API void throw_error(Failure failure, const std::string& message);

/// The same with the parts streamed one after the other.
template <typename... Parts>
[[noreturn]] void fail(Failure failure, const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    throw_error(failure, text.str());
}

/// Fails with the streamed parts unless `ok`.
template <typename... Parts>
void check(bool ok, Failure failure, const Parts&... parts) {
    if (!ok) fail(failure, parts...);
}

} // namespace catoptric
