#include "core/error.hpp"

namespace catoptric {

void throw_error(Failure failure, const std::string& message) {
    switch (failure) {
    case Failure::usage: throw UsageError(message);
    case Failure::bad_data: throw BadData(message);
    case Failure::missing_input: throw MissingInput(message);
    case Failure::no_device: throw NoDevice(message);
    case Failure::internal: throw InternalError(message);
    case Failure::cannot_create: throw CannotCreate(message);
    case Failure::io: throw IoError(message);
    case Failure::exhausted: throw Exhausted(message);
    case Failure::device_lost: throw DeviceLost(message);
    case Failure::threshold:
    case Failure::hangup:
    case Failure::interrupted:
    case Failure::terminated: break;
    }
    throw Error(failure, message);
}

} // namespace catoptric
