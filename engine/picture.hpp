#pragma once

/// Pictures, picture files and differences of two pictures.
#include "measure/difference.hpp"
#include "measure/flip.hpp"
#include "measure/picture.hpp"
#include "measure/picture_file.hpp"
#include "measure/statistics.hpp"
