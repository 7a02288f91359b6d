// Hunts for cases that fail: draws, judges, shrinks, for as long as it is given.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/progress.h"
#include "measure/stability/case_judge.h"

namespace froth {

struct FoundCase {
  StiffCase shrunk;  // named "found/<kind>_<seed>_<place in the sequence>": also a file's name; `what` is its fault
  CaseFault fault;
  uint32_t cellsBefore = 0;
};

struct SearchOptions {
  uint64_t seed = 1;
  double seconds = 60;
  uint32_t mostTries = 2000;                             // cases judged to shrink one
  uint32_t mostOfOneKind = 3;                            // faults of a kind that are shrunk; more are only counted
  std::function<Status(const FoundCase&)> onFound = {};  // as soon as it is shrunk; an error ends the search
};

struct SearchResult {
  uint64_t tried = 0, failing = 0;  // cases drawn
  std::vector<FoundCase> found;     // in the order of the sequence
};

// The sequence of cases depends on the seed alone, how far it comes on the time; a case that has begun is finished and
// shrunk beyond it. Calls progress("search", seconds gone, seconds given). Fails when the judge or onFound does, or
// with kCancelled.
Result<SearchResult> searchCases(const SearchOptions& options, const CaseJudge& judge, const Progress& progress = {});

}  // namespace froth
