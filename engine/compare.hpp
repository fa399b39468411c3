#pragma once

/// Compares the cost and the error of techniques.
#include "app/compare.hpp"
#include "app/watcher.hpp"
