#pragma once

/// Builds, loads, edits and saves scenes.
#include "scene/build.hpp"
#include "scene/load.hpp"
