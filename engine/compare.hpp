#pragma once

/// Compares the cost and the error of techniques.
#include "session/watcher.hpp"
#include "study/compare.hpp"
