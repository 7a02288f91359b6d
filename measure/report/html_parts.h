// What report.html adds to report.json: which points are marked, how times compare, and plots.
#pragma once

#include "measure/report/report.h"

namespace froth {

const ReportPoint* findPoint(const Report& report, const std::string& id);        // null: none
const ReportPoint* defaultOf(const Report& report, const std::string& renderer);  // null: none
std::vector<std::string> renderersOf(const Report& report);                       // in the order of the points
std::string settingsText(const ReportPoint& point);  // "cutoff 0.01, positionBits 14"; "default"

struct SweepPoint {
  const ReportPoint* point;
  std::string value;
  double number;
};
// Renderer by renderer, by growing number; none of a renderer that the knob is not of.
std::vector<SweepPoint> pointsOf(const Report& report, const Sweep& sweep);
std::string titleOf(const Sweep& sweep);  // "lodError [pixels]"

// What counts in a front: what was timed (the rest was measured for its slope alone), and all of the front.
std::vector<const ReportPoint*> candidatesOf(const Report& report, const std::vector<std::string>& front);
// What lies below is not drawn [dB]: points far worse than the front would press it together.
double lowestDrawn(const Report& report, const std::vector<std::string>& front);

// What templates/plot.svg asks for.
nlohmann::ordered_json frontPlot(const Report& report, Cost cost, const std::vector<std::string>& front);
nlohmann::ordered_json sweepPlots(const Report& report, const Sweep& sweep);  // a list
nlohmann::ordered_json slopePlot(const Slope& slope);

// A list of what templates/picture.html asks for.
nlohmann::ordered_json picturesAsJson(const std::vector<ReportImage>& images);

// What templates/levels.html asks for; null: the asset has no levels.
nlohmann::ordered_json levelsOf(const Report& report);

}  // namespace froth
