#pragma once

/// A device, a scene on it, frame after frame.
#include "app/engine.hpp"
#include "app/run.hpp"
#include "app/session.hpp"
