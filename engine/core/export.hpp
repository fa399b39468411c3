#pragma once

/// Marks a function that other programs may call. All other functions, and those of linked
/// libraries, are hidden in the shared library (engine/exported.map).
#define CATOPTRIC_API __attribute__((visibility("default")))
