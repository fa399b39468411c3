#pragma once

/// Writes a comparison as JSON, CSV, Markdown, HTML and pictures.
#include "report/write.hpp"
