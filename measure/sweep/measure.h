// Errors and times of a report's points.
#pragma once

#include <vector>

#include "measure/sweep/bake_cache.h"
#include "measure/sweep/drawing.h"
#include "measure/sweep/log.h"
#include "measure/sweep/points.h"
#include "measure/sweep/references.h"

namespace froth {

// Refers to all of its parts.
struct Bench {
  BakeCache& bakes;
  SweepRenderer& renderer;
  const SweepReferences& references;
  const std::vector<SelectedView>& views;
  ReportLog& log;
  Rounds rounds;
  bool walks = true;  // assets hold a walk graph, and the renderer walks
};

Draw drawOf(const Bench& bench, const ReportConfig& config);

// Bakes, draws and compares those without errors, then times those without times; each result goes into the log.
Status measurePoints(const Bench& bench, std::vector<PlannedPoint*> points, const Progress& progress);

// Figures of points with the same ids are taken over.
void takeOver(const std::vector<ReportPoint>& found, PointList& points);

}  // namespace froth
