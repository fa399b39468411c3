#pragma once

#include "core/error.hpp"

#include <string>

namespace catoptric::scene {

/// Origin of a setting of a scene: an option, or a file and its key. Every error message about the
/// setting begins with it.
struct SettingOrigin {
    std::string where;
    Failure failure = Failure::usage; ///< `bad_data` for a file
};

} // namespace catoptric::scene
