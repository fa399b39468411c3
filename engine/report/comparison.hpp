#pragma once

#include "measure/causes.hpp"
#include "measure/comparison.hpp"
#include "measure/lag.hpp"
#include "measure/path_distance.hpp"
#include "measure/scene_contents.hpp"
#include "measure/setup.hpp"

// Short names, in the namespace report, for the data of measure/ that reports contain.
namespace catoptric::report {

using catoptric::Setting;
using measure::AutoFace;
using measure::Causes;
using measure::CauseShare;
using measure::Comparison;
using measure::DeviceFacts;
using measure::EnvironmentFacts;
using measure::LagAtSpeed;
using measure::LagResults;
using measure::LagRow;
using measure::LightFacts;
using measure::PassFacts;
using measure::Row;
using measure::SceneFacts;
using measure::SettlingAfterCut;
using measure::SetupFacts;
using measure::UnsupportedFeatureFacts;
using measure::WorstLag;

} // namespace catoptric::report
