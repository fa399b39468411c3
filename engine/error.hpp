#pragma once

/// Exceptions that the library throws.
#include "core/error.hpp"
