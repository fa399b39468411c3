#pragma once

/// Renders frames of a scene on a device.
#include "session/run.hpp"
