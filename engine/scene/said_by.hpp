#pragma once

#include "../core/error.hpp"

#include <string>

namespace catoptric::scene {

/// Who said something of a scene: an option, or a file and its key. Begins every message about it.
struct SaidBy {
    std::string where;
    Failure failure = Failure::usage; ///< `bad_data` of a file
};

} // namespace catoptric::scene
