#pragma once

/// Every technique's cost and error, measured.
#include "app/compare.hpp"
#include "app/watcher.hpp"
