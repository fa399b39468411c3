#pragma once

/// Registers techniques that a program adds.
#include "app/technique.hpp"
