#pragma once

/// Stands before every function that programs outside may call: all others, and what libraries
/// below bring along, are hidden in the shared library (engine/exported.map).
#define CATOPTRIC_API __attribute__((visibility("default")))
