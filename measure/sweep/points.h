// The configurations that a report measures: each once, whatever knobs lead to it.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "measure/sweep/config.h"

namespace froth {

struct PlannedPoint {
  ReportConfig config;
  bool isTimed = true;
  bool hasErrors = false, hasTimes = false;
  ReportPoint point;  // id, renderer and settings from the start
};

class PointList {
 public:
  explicit PointList(bool isCpu) : isCpu_(isCpu) {}

  // Returns the id of a configuration, known or new.
  std::string add(const ReportConfig& config, const std::vector<Setting>& settings, bool isTimed);
  // A sweep for each knob; its points are added.
  std::vector<Sweep> addSweeps(const std::vector<Knob>& knobs);

  bool has(const ReportConfig& config) const { return places_.count(configKey(config)) > 0; }
  PlannedPoint& at(const std::string& id);
  std::vector<PlannedPoint>& all() { return points_; }
  const std::vector<PlannedPoint>& all() const { return points_; }

 private:
  bool isCpu_;
  std::vector<PlannedPoint> points_;
  std::map<std::string, size_t> places_;  // by configKey
  std::map<std::string, size_t> idPlaces_;
};

}  // namespace froth
