#pragma once

/// Pictures, picture files and differences of two pictures.
#include "measure/picture.hpp"
