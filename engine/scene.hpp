#pragma once

/// Scenes: made in memory, loaded, edited, saved.
#include "scene/build.hpp"
#include "scene/edit.hpp"
#include "scene/load.hpp"
#include "scene/scene.hpp"
#include "scene/shapes.hpp"
