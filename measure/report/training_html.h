// How a training run goes, as one HTML page: curves, and test photos beside what the foam shows.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "measure/report/report.h"

namespace froth {

struct TrainingPoint {
  uint32_t steps = 0;
  double seconds = 0;
  uint32_t cells = 0;
  double psnr = 0;  // [dB] mean of the test photos; 0: there are none
};

struct TrainingReport {
  std::string title;
  double position = 0;                // [0..1] in the schedule; before 1 a browser that shows the page loads it again
  std::vector<TrainingPoint> points;  // [>= 1] in the order of steps
  std::vector<ReportImage> pictures;
};

// Needs no other file.
std::string trainingAsHtml(const TrainingReport& report);

// Two images of the same size side by side, shrunk to a width that a page has room for.
Result<ReportImage> makePair(std::string title, std::string caption, const Image& left, const Image& right);

}  // namespace froth
