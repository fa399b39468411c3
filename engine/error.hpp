#pragma once

/// What the library throws.
#include "core/error.hpp"
