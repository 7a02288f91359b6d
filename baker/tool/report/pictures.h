// Pictures of a report: where the default's errors are.
#pragma once

#include <vector>

#include "baker/report/report.h"
#include "baker/tool/report/measure.h"

namespace froth {

// For every view of the point: the image beside its FLIP map, and what lies around its worst pixel, exact, drawn, and their
// difference.
Result<std::vector<ReportImage>> drawPictures(const Bench& bench, const PlannedPoint& planned);

}  // namespace froth
