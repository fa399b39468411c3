#pragma once

/// Builds, loads, edits and saves scenes.
#include "import/load.hpp"
#include "scene/build.hpp"
