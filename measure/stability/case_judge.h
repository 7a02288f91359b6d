// What finds a fault in a stiff case: the one thing that search, shrinking and the replay of found cases ask.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "base/result.h"
#include "measure/stability/cases/stiff_case.h"
#include "measure/stability/image_bound.h"

namespace froth {

struct CaseFault {
  std::string kind;       // "float: over its bound": the same for the same fault in another case
  std::string what;       // one line with the numbers found
  size_t view = 0;        // where it is worst
  uint32_t x = 0, y = 0;  // [pixels]
  double factor = 0;      // times the bound; 0: of kinds without a number
};

// Nothing: the case holds. An error is for what is no fault of the case: cancelled, no device.
using CaseJudge = std::function<Result<std::optional<CaseFault>>(const StiffCase&)>;

// The first fault that any of them finds.
CaseJudge judgeByAll(std::vector<CaseJudge> judges);

// The float reference of every view against its bound: finite, within it, the same on a second run. It draws the foam
// of a case: of what assets and devices alone have, layers, chunks, jitter and where all is moved to, it knows nothing,
// and of several instances it has no float image: there the double one alone is judged, for being finite.
CaseJudge judgeOfReference(BoundOptions options = {});

// The options under which a view of a case is rendered by every renderer: its own near limits and ends of rays, no
// cut-off. Refers to the case's images.
ReferenceOptions optionsOfCase(const StiffCase& stiff, size_t index);

}  // namespace froth
