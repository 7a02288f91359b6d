#include "measure/sweep/points.h"

#include <algorithm>

#include <fmt/format.h>

namespace froth {
namespace {

std::string idOf(const std::string& renderer, const std::vector<Setting>& settings) {
  std::string id = renderer;
  for (const Setting& setting : settings) id += fmt::format(" {}={}", setting.knob, setting.value);
  return id;
}

}  // namespace

std::string PointList::add(const ReportConfig& config, const std::vector<Setting>& settings, bool isTimed) {
  const auto [place, isNew] = places_.emplace(configKey(config), points_.size());
  if (isNew) {
    PlannedPoint planned;
    planned.config = config;
    planned.point.renderer = isCpu_ ? "cpu" : infoOf(config.method).name;
    planned.point.id = idOf(planned.point.renderer, settings);
    planned.point.settings = settings;
    idPlaces_[planned.point.id] = points_.size();
    points_.push_back(std::move(planned));
    points_.back().isTimed = isTimed;
  }
  points_[place->second].isTimed |= isTimed;
  return points_[place->second].point.id;
}

std::vector<Sweep> PointList::addSweeps(const std::vector<Knob>& knobs) {
  std::vector<Sweep> sweeps;
  for (const Knob& knob : knobs) {
    Sweep sweep = knob.sweep;
    ReportConfig base = knob.isConvergence ? exactConfig() : defaultConfig();
    base.method = knob.method;
    for (const KnobValue& value : knob.values) {
      ReportConfig config = base;
      value.apply(config);
      if (knob.isConvergence) config.walkGraph = config.steiner = knob.method == Method::kWalk;
      const Setting setting{sweep.knob, value.text, value.number};
      const bool isBase = configKey(config) == configKey(base);
      if (isBase) sweep.base = setting;
      sweep.points.push_back(add(config, isBase ? std::vector<Setting>{} : std::vector{setting}, !knob.isConvergence));
    }
    sweeps.push_back(std::move(sweep));
  }
  return sweeps;
}

PlannedPoint& PointList::at(const std::string& id) { return points_[idPlaces_.at(id)]; }

}  // namespace froth
