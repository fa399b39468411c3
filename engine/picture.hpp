#pragma once

/// Pictures, their files, and how far two are apart.
#include "measure/difference.hpp"
#include "measure/flip.hpp"
#include "measure/picture.hpp"
#include "measure/picture_file.hpp"
#include "measure/statistics.hpp"
