// A report as a measured one looks: three renderers' worth of sweeps, noise, floors, ties. All figures are made up, by
// rule.
#pragma once

#include "measure/report/training_html.h"

namespace froth::test {

Report makeSampleReport();
TrainingReport makeSampleTraining(double position);  // with a pair of pictures

}  // namespace froth::test
