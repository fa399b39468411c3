#pragma once

/// Registers techniques that a program adds.
#include "session/technique.hpp"
