// The section of report.html on convergence and scaling.
#include <cmath>

#include <fmt/format.h>

#include "measure/report/html_parts.h"
#include "measure/report/svg_plot.h"

namespace froth {
namespace {

PlotSeries lineThrough(const std::string& name, PlotLine style, double x0, double y0, double x1, double y1) {
  PlotSeries series{name, {}, style};
  series.hasMarkers = false;
  PlotPoint a, b;
  a.x = x0, a.y = y0, b.x = x1, b.y = y1;
  series.points = {a, b};
  return series;
}

// "raster: mean error over cutoff" as its parts.
struct SlopeNames {
  std::string who, y, x;

  explicit SlopeNames(const std::string& what) {
    const size_t colon = what.find(": "), from = colon == std::string::npos ? 0 : colon + 2;
    const size_t over = what.find(" over ", from);
    if (colon != std::string::npos) who = what.substr(0, colon);
    y = what.substr(from, over == std::string::npos ? over : over - from);
    if (over != std::string::npos) x = what.substr(over + 6);
  }
};

void addLines(Plot& plot, const Slope& slope, double first, double last) {
  const auto fitted = [&](double x) { return slope.atOne * std::pow(x, slope.measured); };
  const double middle = std::sqrt(first * last);
  const auto derived = [&](double x) { return fitted(middle) * std::pow(x / middle, slope.expected); };
  plot.series.push_back(lineThrough("slope " + signedText(slope.measured, 2), PlotLine::kSolid, first,
                                    fitted(first), last, fitted(last)));
  plot.series.back().colour = 0;
  plot.series.push_back(lineThrough(fmt::format("derived {:g}", slope.expected), PlotLine::kDashed, first,
                                    derived(first), last, derived(last)));
  plot.series.back().colour = PlotSeries::kNeutral;
  if (slope.floor > 0) {
    plot.series.push_back(lineThrough("floor", PlotLine::kDotted, first, slope.floor, last, slope.floor));
    plot.series.back().colour = 1;
  }
}

Plot slopePlot(const Slope& slope) {
  const SlopeNames names(slope.what);
  Plot plot;
  plot.width = 350;
  plot.height = 250;
  plot.title = (names.who.empty() ? "" : names.who + ": ") + slope.verdict;
  plot.showsTitle = true;
  plot.x = {names.x, true, {}, {}, {}};
  plot.y = {names.y, true, {}, {}, {}};
  PlotSeries measured{"measured", {}};
  double first = 0, last = 0;
  for (size_t i = 0; i < slope.x.size() && i < slope.y.size(); ++i) {
    PlotPoint point;
    point.x = slope.x[i];
    point.y = slope.y[i];
    point.isHollow = slope.floor > 0 && slope.y[i] <= kFloorFactor * slope.floor;
    point.tooltip = fmt::format("{} at {}", shortNumber(point.y), shortNumber(point.x));
    measured.points.push_back(point);
    if (!(point.x > 0) || !(point.y > 0)) continue;
    if (first == 0) first = point.x;
    last = point.x;
  }
  plot.series.push_back(std::move(measured));
  if (slope.atOne > 0 && last > first) addLines(plot, slope, first, last);
  return plot;
}

Cell verdictCell(const Slope& slope) {
  const char* kind = slope.verdict == kVerdictAsDerived ? "good"
                     : slope.verdict == kVerdictFloor   ? "fair"
                     : slope.verdict == kVerdictTooFew  ? ""
                                                        : "bad";
  return {fmt::format("<span class=\"badge {}\">{}</span>", kind, escapeMarkup(slope.verdict)), "text"};
}

}  // namespace

std::string slopesSection(const Report& report) {
  if (report.slopes.empty()) return "";
  Table table({"what", "derived", "measured", "points fitted", "verdict", "note"});
  std::string plots;
  for (const Slope& slope : report.slopes) {
    table.add({textCell(slope.what), numberCell(fmt::format("{:g}", slope.expected)),
               numberCell(slope.atOne > 0 ? signedText(slope.measured, 2) : "–"),
               numberCell(fmt::format("{} of {}", slope.fitted, slope.x.size())), verdictCell(slope),
               textCell(slope.note)});
    plots += drawPlot(slopePlot(slope));
  }
  return section(
      "slopes", "Convergence and scaling",
      paragraph(
          "Log-log slopes by least squares; hollow points lie at the floor and are left out. Error must fall "
          "with a knob's step as derived, down to a floor "
          "that something else sets; a knob whose error does not fall is a fault or a floor. Time is held "
          "against cells and pixels in the same way.") +
          table.html() + "<div class=\"plots\">\n" + plots + "</div>\n");
}

}  // namespace froth
