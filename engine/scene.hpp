#pragma once

/// Builds, loads, edits and saves scenes.
#include "scene/build.hpp"
#include "scene/edit.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"
#include "scene/shapes.hpp"
