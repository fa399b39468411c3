#pragma once

/// Renders frames of a scene on a device.
#include "app/engine.hpp"
#include "app/run.hpp"
#include "app/session.hpp"
