#include "measure/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "measure/report/fill_template.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kCharacter = 6.2;  // [px] mean width at the plot's 11 px; wide enough that labels keep apart
constexpr double kLineHeight = 14;
constexpr double kMarker = 4;  // half its size
constexpr int kColours = 8;
constexpr const char* kShapes[] = {"M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0Z", "M-3.5-3.5h7v7h-7Z", "M0-4.5L4.5 3.5H-4.5Z",
                                   "M0-5L5 0L0 5L-5 0Z"};

struct Area {
  double left = 0, top = 0, right = 0, bottom = 0;
  bool meets(const Area& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  bool holds(const Area& other) const {
    return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
  }
};

// Characters as a reader counts them: UTF-8 continuation bytes are none.
double textWidth(const std::string& text) {
  return kCharacter * double(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

// From values to pixels along one axis.
struct Scale {
  bool isLogarithmic = false;
  double from = 0, to = 1;  // places
  double pixelFrom = 0, pixelTo = 1;

  // Not finite where the axis has no place for the value.
  double place(double value) const { return isLogarithmic ? std::log10(std::max(value, 0.0)) : value; }
  double value(double place) const { return isLogarithmic ? std::pow(10, place) : place; }
  bool shows(double value) const {
    const double slack = 1e-6 * (to - from);
    return place(value) >= from - slack && place(value) <= to + slack;
  }
  double pixel(double value) const {
    return pixelFrom + std::clamp((place(value) - from) / (to - from), 0.0, 1.0) * (pixelTo - pixelFrom);
  }
};

// The range of the values with a margin of a twentieth.
Scale fitScale(const PlotAxis& axis, const std::vector<double>& values) {
  Scale scale{axis.isLogarithmic};
  double least = std::numeric_limits<double>::infinity(), most = -least;
  for (double value : values) {
    if (!std::isfinite(scale.place(value))) continue;
    least = std::min(least, scale.place(value));
    most = std::max(most, scale.place(value));
  }
  if (least > most) least = 0, most = 1;
  double margin = (most - least) / 20;
  const bool isOneValue = margin < 1e-12 * std::max(1.0, std::abs(most));
  if (isOneValue) margin = axis.isLogarithmic ? 0.3 : std::max(std::abs(most) * 0.1, 0.5);
  scale.from = axis.from ? scale.place(*axis.from) : least - margin;
  scale.to = axis.to ? scale.place(*axis.to) : most + margin;
  return scale;
}

// A tick for each `distance` pixels at most.
std::vector<PlotTick> ticksOf(const PlotAxis& axis, const Scale& scale, double distance) {
  const int most = std::max(2, int(std::abs(scale.pixelTo - scale.pixelFrom) / distance));
  std::vector<PlotTick> ticks = axis.ticks;
  if (ticks.empty()) ticks = chooseTicks(scale.value(scale.from), scale.value(scale.to), axis.isLogarithmic, most);
  std::erase_if(ticks, [&](const PlotTick& tick) { return !scale.shows(tick.at); });
  return ticks;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {
    area_ = {plot.y.label.empty() ? 42.0 : 58.0, plot.showsTitle ? 32.0 : 10.0, double(plot.width) - 14,
             double(plot.height) - (plot.x.label.empty() ? 26 : 42)};
  }

  Json draw() {
    for (const char* part : {"legend", "ticksX", "ticksY", "lines", "bars", "marks", "labels"}) {
      parts_[part] = Json::array();
    }
    drawLegend();
    drawAxes();
    for (size_t s = 0; s < plot_.series.size(); ++s) drawSeries(s);
    for (const PlotSeries& series : plot_.series) {
      for (const PlotPoint& point : series.points) {
        if (series.hasMarkers && !point.label.empty() && shows(point)) drawLabel(point);
      }
    }
    return parts_;
  }

 private:
  // What it needs is taken from the top of the area.
  void drawLegend() {
    double x = area_.left, y = area_.top + 4;
    for (size_t s = 0; s < plot_.series.size(); ++s) {
      const PlotSeries& series = plot_.series[s];
      if (series.name.empty()) continue;
      const double needed = 24 + textWidth(series.name) + 14;
      if (x > area_.left && x + needed > area_.right) x = area_.left, y += kLineHeight + 2;
      Json entry{{"look", colourOf(s)}, {"line", series.line}, {"x", x}, {"y", y}, {"name", series.name}};
      entry["marks"] = Json::array();
      if (series.hasMarkers) entry["marks"].push_back(markAt(s, {}, x + 9, y));
      parts_["legend"].push_back(entry);
      x += needed;
    }
    if (!parts_["legend"].empty()) area_.top = y + 14;
  }

  void drawAxes() {
    std::vector<double> xs, ys;
    for (const PlotSeries& series : plot_.series) {
      for (const PlotPoint& point : series.points) {
        xs.push_back(point.x), ys.push_back(point.y);
        if (point.xLow < point.xHigh) xs.insert(xs.end(), {point.xLow, point.xHigh});
        if (point.yLow < point.yHigh) ys.insert(ys.end(), {point.yLow, point.yHigh});
      }
    }
    x_ = fitScale(plot_.x, xs), y_ = fitScale(plot_.y, ys);
    x_.pixelFrom = area_.left, x_.pixelTo = area_.right;
    y_.pixelFrom = area_.bottom, y_.pixelTo = area_.top;
    double taken = -std::numeric_limits<double>::infinity();  // right end of the last label
    for (const PlotTick& tick : ticksOf(plot_.x, x_, 62)) {
      const double x = x_.pixel(tick.at), half = textWidth(tick.label) / 2;
      const bool hasRoom = x - half >= taken + 4;
      if (hasRoom) taken = x + half;
      parts_["ticksX"].push_back({{"at", x}, {"label", hasRoom ? tick.label : ""}});
    }
    for (const PlotTick& tick : ticksOf(plot_.y, y_, 28)) {
      parts_["ticksY"].push_back({{"at", y_.pixel(tick.at)}, {"label", tick.label}});
    }
    parts_.update({{"width", plot_.width},
                   {"height", plot_.height},
                   {"title", plot_.title},
                   {"showsTitle", plot_.showsTitle},
                   {"left", area_.left},
                   {"right", area_.right},
                   {"top", area_.top},
                   {"bottom", area_.bottom},
                   {"xLabel", plot_.x.label},
                   {"middleX", (area_.left + area_.right) / 2},
                   {"yLabel", plot_.y.label},
                   {"middleY", (area_.top + area_.bottom) / 2}});
  }

  bool shows(const PlotPoint& point) const { return x_.shows(point.x) && y_.shows(point.y); }
  int placeOf(size_t s) const { return plot_.series[s].colour == -1 ? int(s) : plot_.series[s].colour; }
  std::string colourOf(size_t s) const { return placeOf(s) < 0 ? "cn" : fmt::format("c{}", placeOf(s) % kColours); }

  Json markAt(size_t s, const PlotPoint& point, double x, double y) const {
    return {{"look", colourOf(s)},
            {"shape", kShapes[std::max(placeOf(s), 0) % 4]},
            {"x", x},
            {"y", y},
            {"isRinged", point.isRinged},
            {"isHollow", point.isHollow},
            {"tooltip", point.tooltip}};
  }

  void drawSeries(size_t s) {
    const PlotSeries& series = plot_.series[s];
    std::vector<PlotPoint> shown = series.points;
    std::erase_if(shown, [&](const PlotPoint& point) { return !shows(point); });
    if (!series.line.empty()) drawLine(s, shown);
    for (const PlotPoint& point : shown) drawBars(s, point);
    if (!series.hasMarkers) return;
    for (auto point = shown.rbegin(); point != shown.rend(); ++point) {  // the first, which matter most, on top
      const double x = x_.pixel(point->x), y = y_.pixel(point->y), r = kMarker + (point->isRinged ? 4 : 0);
      parts_["marks"].push_back(markAt(s, *point, x, y));
      taken_.push_back({x - r, y - r, x + r, y + r});
    }
  }

  // Labels keep off the steps of a line.
  void drawLine(size_t s, const std::vector<PlotPoint>& points) {
    constexpr double kHalf = 1.5;
    const bool isStepped = plot_.series[s].isStepped;
    std::string path;
    double lastX = 0, lastY = 0;
    for (const PlotPoint& point : points) {
      const double x = x_.pixel(point.x), y = y_.pixel(point.y);
      if (isStepped && !path.empty()) {
        path += fmt::format("H{}V{}", coordinate(x), coordinate(y));
        taken_.push_back({std::min(lastX, x), lastY - kHalf, std::max(lastX, x), lastY + kHalf});
        taken_.push_back({x - kHalf, std::min(lastY, y), x + kHalf, std::max(lastY, y)});
      } else {
        path += fmt::format("{}{} {}", path.empty() ? "M" : "L", coordinate(x), coordinate(y));
      }
      lastX = x, lastY = y;
    }
    parts_["lines"].push_back({{"look", colourOf(s)}, {"line", plot_.series[s].line}, {"path", path}});
  }

  void drawBars(size_t s, const PlotPoint& point) {
    const double x = x_.pixel(point.x), y = y_.pixel(point.y);
    const auto add = [&](bool isAcross, double low, double high) {
      parts_["bars"].push_back(
          {{"look", colourOf(s)}, {"isAcross", isAcross}, {"x", x}, {"y", y}, {"low", low}, {"high", high}});
    };
    if (point.xLow < point.xHigh) {
      bars_.push_back({x_.pixel(point.xLow), y - 1, x_.pixel(point.xHigh), y + 1});
      add(true, x_.pixel(point.xLow), x_.pixel(point.xHigh));
    }
    if (point.yLow < point.yHigh) add(false, y_.pixel(point.yLow), y_.pixel(point.yHigh));
  }

  // At the first of a few places around the point that nothing else has taken.
  void drawLabel(const PlotPoint& point) {
    const double x = x_.pixel(point.x), y = y_.pixel(point.y), width = textWidth(point.label);
    for (bool avoidsBars : {true, false}) {
      for (double distance : {0.0, 10.0, 24.0}) {
        for (const Area& box : placesAround(x, y, width, kMarker + (point.isRinged ? 6 : 3) + distance)) {
          if (!isFree(box, avoidsBars)) continue;
          taken_.push_back(box);
          parts_["labels"].push_back({{"label", point.label}, {"x", box.left}, {"y", box.bottom - 3.5}});
          parts_["labels"].back().update({{"hasLeader", distance > 0},
                                          {"fromX", x},
                                          {"fromY", y},
                                          {"toX", std::clamp(x, box.left, box.right)},
                                          {"toY", std::clamp(y, box.top, box.bottom)}});
          return;
        }
      }
    }
  }

  static std::vector<Area> placesAround(double x, double y, double width, double away) {
    constexpr double kDirections[][2] = {{1, 0},      {-1, 0},    {0, -1},      {0, 1},
                                         {0.7, -0.7}, {0.7, 0.7}, {-0.7, -0.7}, {-0.7, 0.7}};
    const auto begin = [&](double at, double direction, double size) {
      return at + direction * away - (direction > 0 ? 0 : direction < 0 ? size : size / 2);
    };
    std::vector<Area> places;
    for (const auto& [right, down] : kDirections) {
      const double left = begin(x, right, width), top = begin(y, down, kLineHeight);
      places.push_back({left, top, left + width, top + kLineHeight});
    }
    return places;
  }

  bool isFree(const Area& box, bool avoidsBars) const {
    const auto meets = [&](const Area& other) { return other.meets(box); };
    return area_.holds(box) && std::none_of(taken_.begin(), taken_.end(), meets) &&
           !(avoidsBars && std::any_of(bars_.begin(), bars_.end(), meets));
  }

  const Plot& plot_;
  Json parts_;
  Area area_;
  Scale x_, y_;
  std::vector<Area> taken_;  // by markers, steps and labels
  std::vector<Area> bars_;   // where a label is better not
};

}  // namespace

Json layOutPlot(const Plot& plot) { return Drawing(plot).draw(); }

std::string drawPlotFile(const Plot& plot) {
  Json parts = layOutPlot(plot);
  parts["isFile"] = true;
  return fillTemplate("plot.svg", parts);
}

}  // namespace froth
