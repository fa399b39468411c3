#pragma once

/// A comparison as JSON, CSV, Markdown, HTML and pictures.
#include "report/write.hpp"
