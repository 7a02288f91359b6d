// Makes a failing case small enough to be understood: delta debugging (Zeller & Hildebrandt 2002) of its cells, then
// everything else that a cell and a view have.
#pragma once

#include <cstdint>

#include "base/progress.h"
#include "measure/stability/case_judge.h"

namespace froth {

struct ShrunkCase {
  StiffCase smallest;
  CaseFault fault;     // as found in it; of the kind that was asked for
  uint32_t tries = 0;  // cases judged
};

// Keeps every step after which `judge` finds a fault of the same kind: only the worst view, a crop of it around the
// worst pixel, fewer cells, detail sites and lobes, then values of 0, 1 and few digits. Ends when no step helps, or
// after `mostTries`; the same case, fault and judge give the same result. Fails when the judge does, or with
// kCancelled.
Result<ShrunkCase> shrinkCase(const StiffCase& failing, const CaseFault& fault, const CaseJudge& judge,
                              uint32_t mostTries, const Progress& progress = {});

}  // namespace froth
