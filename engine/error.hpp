#pragma once

#include "core/export.hpp"

#include <stdexcept>
#include <string>

/// Exceptions that the library throws.
namespace catoptric {

/// The kind of a failure. The value is the exit code of the command line program (sysexits.h).
enum class Failure {
    threshold = 1,      ///< a measured value exceeds the limit that the user gave
    usage = 2,          ///< unknown name, value out of range
    bad_data = 65,      ///< an input file has invalid contents
    missing_input = 66, ///< an input file does not exist
    no_device = 69,     ///< no Vulkan device, or none with the required features
    internal = 70,      ///< a bug of the engine or of its caller
    cannot_create = 73, ///< an output file or folder cannot be created
    io = 74,            ///< reading or writing failed half-way
    exhausted = 75,     ///< out of memory or over a device limit
    device_lost = 76,
    hangup = 129,      ///< SIGHUP
    interrupted = 130, ///< SIGINT
    terminated = 143,  ///< SIGTERM
};

/// The base of all exceptions that the library throws. The type below that is thrown depends on
/// `failure`. `what()` says what failed, where, what was expected and what was found.
class CATOPTRIC_API Error : public std::runtime_error {
public:
    Error(Failure why, const std::string& message) : std::runtime_error(message), failure(why) {}
    Failure failure;
};

/// The exception for one kind of failure, to catch only that kind.
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

} // namespace catoptric
