// A report as a measured one looks: three renderers' worth of sweeps, noise, floors, ties. All figures are made up, by
// rule.
#pragma once

#include "measure/report/report.h"

namespace froth::test {

Report makeSampleReport();

}  // namespace froth::test
