#pragma once

/// Runs sessions on the caller's Vulkan device. Needs the Vulkan headers.
#include "embed/embed.hpp"
