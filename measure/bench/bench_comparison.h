// Two results of `froth bench` side by side.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "base/percentiles.h"
#include "base/result.h"

namespace froth {

enum class Verdict { kTie, kFaster, kSlower };

// A pass, or the total. Mean frames of cycles over the views [ms]. A tie: the intervals p5 to p95 overlap, so that
// noise alone can explain the difference.
struct TimeComparison {
  std::string name;
  Percentiles a, b;
  Verdict verdict = Verdict::kTie;  // of b against a

  double ratio() const { return b.median / a.median; }
};

// What has no noise: bytes, pairs, averages of FrothWork.
struct CountComparison {
  std::string name;
  double a = 0, b = 0;
};

struct BenchComparison {
  std::vector<std::string> differences;  // in what was measured: "cutoff: 0.01 and 0.001"
  std::vector<TimeComparison> times;     // passes that both have, then the total
  std::vector<CountComparison> counts;
};

// The objects that `froth bench --json` writes. An error names the field that is missing.
Result<BenchComparison> compareBench(const nlohmann::ordered_json& a, const nlohmann::ordered_json& b);

const char* verdictName(Verdict verdict);  // "tie", "faster", "slower"

}  // namespace froth
