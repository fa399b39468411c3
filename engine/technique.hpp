#pragma once

/// Techniques of a program's own.
#include "app/technique.hpp"
