#include "measure/bench/bench_comparison.h"

#include <utility>

#include <fmt/format.h>

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

Percentiles readPercentiles(const Json& times) {
  return {times.at("median").get<double>(), times.at("p5").get<double>(), times.at("p95").get<double>()};
}

Verdict judge(const Percentiles& a, const Percentiles& b) {
  if (b.p95 < a.p5) return Verdict::kFaster;
  return b.p5 > a.p95 ? Verdict::kSlower : Verdict::kTie;
}

TimeComparison compareTimes(std::string name, const Json& a, const Json& b) {
  TimeComparison comparison{std::move(name), readPercentiles(a), readPercentiles(b)};
  comparison.verdict = judge(comparison.a, comparison.b);
  return comparison;
}

// Numbers that both objects have, also in objects within them, by the path of their names.
void compareCounts(const std::string& path, const Json& a, const Json& b, std::vector<CountComparison>& counts) {
  for (const auto& [name, value] : a.items()) {
    if (!b.contains(name)) continue;
    const std::string fullName = path + name;
    if (value.is_object()) {
      compareCounts(fullName + ", ", value, b.at(name), counts);
    } else {
      counts.push_back({fullName, value.get<double>(), b.at(name).get<double>()});
    }
  }
}

BenchComparison compareWell(const Json& a, const Json& b) {
  BenchComparison comparison;
  for (const char* field : {"input", "device", "driver", "renderer", "output", "cutoff", "width", "height", "layers",
                            "cells", "isCounting"}) {
    if (a.at(field) != b.at(field)) {
      comparison.differences.push_back(fmt::format("{}: {} and {}", field, a.at(field).dump(), b.at(field).dump()));
    }
  }
  const auto entriesOf = [](const Json& result) { return result.value("maxEntries", 0u); };  // none in older results
  if (entriesOf(a) != entriesOf(b)) {
    comparison.differences.push_back(fmt::format("maxEntries: {} and {}", entriesOf(a), entriesOf(b)));
  }
  const Json &cyclesA = a.at("cycles"), &cyclesB = b.at("cycles");
  for (const auto& [name, times] : cyclesA.at("passes").items()) {
    if (cyclesB.at("passes").contains(name)) {
      comparison.times.push_back(compareTimes(name, times, cyclesB.at("passes").at(name)));
    }
  }
  comparison.times.push_back(compareTimes("total", cyclesA.at("total"), cyclesB.at("total")));
  for (const char* bytes : {"assetBytes", "viewBytes"}) {
    comparison.counts.push_back({bytes, a.at(bytes).get<double>(), b.at(bytes).get<double>()});
  }
  compareCounts("bytes of ", a.at("memory"), b.at("memory"), comparison.counts);
  if (a.contains("work") && b.contains("work")) compareCounts("", a.at("work"), b.at("work"), comparison.counts);
  return comparison;
}

}  // namespace

Result<BenchComparison> compareBench(const Json& a, const Json& b) {
  try {
    return compareWell(a, b);
  } catch (const nlohmann::json::exception& error) {
    return makeError(ErrorKind::kBadInput, "not two results of `froth bench --json`: %s", error.what());
  }
}

const char* verdictName(Verdict verdict) {
  if (verdict == Verdict::kTie) return "tie";
  return verdict == Verdict::kFaster ? "faster" : "slower";
}

}  // namespace froth
