#pragma once

/// Renders frames of a scene on a device.
#include "session/engine.hpp"
#include "session/run.hpp"
#include "session/session.hpp"
