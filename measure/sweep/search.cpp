#include "measure/sweep/search.h"

#include <algorithm>
#include <optional>
#include <random>

#include "base/progress_printer.h"

namespace froth {
namespace {

constexpr size_t kBatch = 8;     // configurations that are baked together
constexpr int kMaxDraws = 1000;  // of a configuration that is new

struct Candidate {
  ReportConfig config;
  std::vector<Setting> settings;
};

class CandidateSource {
 public:
  CandidateSource(const std::vector<Knob>& knobs, uint64_t seed) : random_(seed) {
    // A preset sets what the others turn; larger pixels lie beside all of these.
    for (const Knob& knob : knobs) {
      const std::string& name = knob.sweep.knob;
      if (!knob.isConvergence && knob.method == Method::kRaster && name != "preset" && name != "walkGraph") {
        knobs_.push_back(knob);
      }
    }
  }

  bool isEmpty() const { return knobs_.empty(); }

  // Turns one or two more knobs of a point on a front.
  std::optional<Candidate> next(const PointList& points, const std::vector<const PlannedPoint*>& parents) {
    for (int i = 0; i < kMaxDraws; ++i) {
      const PlannedPoint& parent = *parents[pick(parents.size())];
      Candidate candidate{parent.config, parent.point.settings};
      const size_t turns = 1 + pick(2);
      for (size_t turn = 0; turn < turns; ++turn) turnOne(candidate);
      if (!points.has(candidate.config)) return candidate;
    }
    return std::nullopt;
  }

 private:
  size_t pick(size_t count) { return static_cast<size_t>(random_() % count); }

  void turnOne(Candidate& candidate) {
    const Knob& knob = knobs_[pick(knobs_.size())];
    const KnobValue& value = knob.values[pick(knob.values.size())];
    value.apply(candidate.config);
    std::erase_if(candidate.settings, [&](const Setting& setting) { return setting.knob == knob.sweep.knob; });
    candidate.settings.push_back({knob.sweep.knob, value.text, value.number});
  }

  std::vector<Knob> knobs_;
  std::mt19937_64 random_;
};

std::vector<const PlannedPoint*> pointsOnFronts(PointList& points, const std::string& renderer) {
  std::vector<ReportPoint> measured;
  for (const PlannedPoint& planned : points.all()) {
    if (planned.isTimed) measured.push_back(planned.point);
  }
  std::vector<const PlannedPoint*> front;
  for (const Cost cost : {Cost::kTime, Cost::kDiskBytes}) {
    for (const std::string& id : paretoFront(measured, renderer, cost)) front.push_back(&points.at(id));
  }
  return front;
}

}  // namespace

Status searchJointly(const Bench& bench, const std::vector<Knob>& knobs, double seconds, uint64_t seed,
                     PointList& points, const Progress& progress) {
  using Seconds = std::chrono::duration<double>;
  const auto start = std::chrono::steady_clock::now();
  const std::string renderer = points.all().front().point.renderer;
  CandidateSource source(knobs, seed);
  for (double spent = 0; spent < seconds; spent = Seconds(std::chrono::steady_clock::now() - start).count()) {
    if (!report(progress, "search [s]", static_cast<uint64_t>(spent), static_cast<uint64_t>(seconds))) {
      return stoppedError();
    }
    const std::vector<const PlannedPoint*> parents = pointsOnFronts(points, renderer);
    if (parents.empty() || source.isEmpty()) return {};
    std::vector<Candidate> batch;
    for (size_t i = 0; i < kBatch; ++i) {
      const std::optional<Candidate> candidate = source.next(points, parents);
      if (candidate) batch.push_back(*candidate);
    }
    if (batch.empty()) return {};
    std::vector<std::string> ids;
    for (const Candidate& candidate : batch) ids.push_back(points.add(candidate.config, candidate.settings, true));
    std::vector<PlannedPoint*> added;
    for (const std::string& id : ids) added.push_back(&points.at(id));
    const Progress quiet = [&](std::string_view, uint64_t, uint64_t) { return !isStopRequested(); };
    if (Status measured = measurePoints(bench, added, quiet); !measured) return measured;
  }
  return {};
}

}  // namespace froth
