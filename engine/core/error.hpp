#pragma once

#include "../error.hpp"

#include <sstream>
#include <string>

namespace catoptric {

constexpr bool is_signal(Failure failure) {
    return failure == Failure::hangup || failure == Failure::interrupted ||
           failure == Failure::terminated;
}

/// Throws the exception type of this failure, or `Error` itself for a signal or a threshold.
[[noreturn]] void throw_error(Failure failure, const std::string& message);

/// Throws as `throw_error` does, with the parts streamed into the message.
template <typename... Parts>
[[noreturn]] void fail(Failure failure, const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    throw_error(failure, text.str());
}

/// Throws as `fail` does, unless `ok` is true.
template <typename... Parts>
void check(bool ok, Failure failure, const Parts&... parts) {
    if (!ok) fail(failure, parts...);
}

} // namespace catoptric
