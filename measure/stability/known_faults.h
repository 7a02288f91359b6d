// Holds the faults that were seen in a case against those that are known of it.
#pragma once

#include <string>
#include <vector>

#include "measure/stability/cases/stiff_case.h"

namespace froth {

struct SeenFault {
  std::string preset, renderer, kind;  // as in KnownFault
  double factor = 0;                   // times the bound; 0: of kinds without a number
  std::string text;                    // one line with all of it
};

// One line for every seen fault that is not known, and for every known one that is gone or another one now. None: as
// known.
std::vector<std::string> unexplainedFaults(const std::vector<KnownFault>& known, const std::vector<SeenFault>& seen);

}  // namespace froth
