#pragma once

/// Sessions on a Vulkan device of the caller's. Needs Vulkan's headers.
#include "embed/embed.hpp"
