#include "measure/report/svg_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace froth {
namespace {

constexpr double kCharacter = 6.2;  // [px] mean width at the plot's 11 px; wide enough that labels keep apart
constexpr double kLineHeight = 14;
constexpr double kMarker = 4;  // half its size
constexpr int kColours = 8;

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
  bool meets(const Box& other) const {
    return left < other.right && other.left < right && top < other.bottom && other.top < bottom;
  }
  bool holds(const Box& other) const {
    return left <= other.left && other.right <= right && top <= other.top && other.bottom <= bottom;
  }
};

// Characters as a reader counts them: UTF-8 continuation bytes are none.
double textWidth(const std::string& text) {
  return kCharacter *
         double(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

std::string number(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

// From values to pixels along one axis.
struct Scale {
  bool isLogarithmic = false;
  double from = 0, to = 1;  // values
  double pixelFrom = 0, pixelTo = 1;

  bool hasPlace(double value) const { return std::isfinite(value) && (!isLogarithmic || value > 0); }
  bool shows(double value) const {
    const double slack = 1e-6 * (place(to) - place(from));
    return hasPlace(value) && place(value) >= place(from) - slack && place(value) <= place(to) + slack;
  }
  double place(double value) const { return isLogarithmic ? std::log10(value) : value; }
  double pixel(double value) const {
    return pixelFrom + (place(value) - place(from)) / (place(to) - place(from)) * (pixelTo - pixelFrom);
  }
  double clampedPixel(double value) const {
    if (!hasPlace(value)) return pixelFrom;
    return std::clamp(pixel(value), std::min(pixelFrom, pixelTo), std::max(pixelFrom, pixelTo));
  }
};

// The range of the data with a margin of a twentieth.
Scale fitScale(const PlotAxis& axis, const std::vector<double>& values) {
  Scale scale{axis.isLogarithmic};
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (double value : values) {
    if (!scale.hasPlace(value)) continue;
    low = std::min(low, scale.place(value));
    high = std::max(high, scale.place(value));
  }
  if (low > high) low = 0, high = 1;
  double margin = (high - low) / 20;
  if (margin < 1e-12 * std::max(1.0, std::abs(high)))
    margin = axis.isLogarithmic ? 0.3 : std::max(std::abs(high) * 0.1, 0.5);
  const auto value = [&](double place) { return axis.isLogarithmic ? std::pow(10, place) : place; };
  scale.from = axis.from.value_or(value(low - margin));
  scale.to = axis.to.value_or(value(high + margin));
  return scale;
}

std::vector<double> valuesOf(const Plot& plot, double PlotPoint::*value, double PlotPoint::*low,
                             double PlotPoint::*high) {
  std::vector<double> values;
  for (const PlotSeries& series : plot.series) {
    for (const PlotPoint& point : series.points) {
      values.push_back(point.*value);
      if (point.*low < point.*high) values.insert(values.end(), {point.*low, point.*high});
    }
  }
  return values;
}

class Drawing {
 public:
  explicit Drawing(const Plot& plot) : plot_(plot) {}

  std::string draw(bool isFile) {
    area_ = {58, 10, double(plot_.width) - 14, double(plot_.height) - 42};
    if (plot_.x.label.empty()) area_.bottom += 16;
    if (plot_.y.label.empty()) area_.left -= 16;
    drawHead();
    fitScales();
    drawGrid();
    for (size_t s = 0; s < plot_.series.size(); ++s) drawLine(s);
    for (size_t s = 0; s < plot_.series.size(); ++s) drawBars(s);
    for (size_t s = 0; s < plot_.series.size(); ++s) drawMarkers(s);
    drawLabels();
    std::string svg = fmt::format(
        "<svg class=\"plot\" {}viewBox=\"0 0 {} {}\" width=\"{}\" height=\"{}\" role=\"img\" "
        "aria-label=\"{}\">\n",
        isFile ? "xmlns=\"http://www.w3.org/2000/svg\" " : "", plot_.width, plot_.height, plot_.width,
        plot_.height, escapeMarkup(plot_.title));
    if (isFile) {
      svg += "<style>" + plotStyle() + "</style>\n";
      svg += fmt::format("<rect class=\"paper\" width=\"{}\" height=\"{}\"/>\n", plot_.width, plot_.height);
    }
    return svg + body_ + "</svg>\n";
  }

 private:
  template <class... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    body_ += fmt::format(format, std::forward<Args>(args)...);
    body_ += '\n';
  }

  // Of colour and marker.
  int look(size_t s) const { return plot_.series[s].colour < 0 ? int(s) : plot_.series[s].colour; }
  bool isNeutral(size_t s) const { return plot_.series[s].colour == PlotSeries::kNeutral; }
  std::string colourClass(size_t s) const {
    return isNeutral(s) ? "cn" : fmt::format("c{}", look(s) % kColours);
  }

  // Title and legend; what they need is taken from the top of the area.
  void drawHead() {
    if (plot_.showsTitle) {
      add("<text class=\"title\" x=\"{}\" y=\"{}\">{}</text>", number(area_.left), number(area_.top + 10),
          escapeMarkup(plot_.title));
      area_.top += 22;
    }
    double x = area_.left, y = area_.top + 4;
    bool hasLegend = false;
    for (size_t s = 0; s < plot_.series.size(); ++s) {
      const PlotSeries& series = plot_.series[s];
      if (series.name.empty()) continue;
      const double needed = 24 + textWidth(series.name) + 14;
      if (hasLegend && x + needed > area_.right) x = area_.left, y += kLineHeight + 2;
      hasLegend = true;
      if (series.line != PlotLine::kNone) {
        add("<path class=\"line {} {}\" d=\"M{} {}h18\"/>", colourClass(s), dashClass(series), number(x),
            number(y));
      }
      if (series.hasMarkers) addMarker(s, {}, x + 9, y);
      add("<text x=\"{}\" y=\"{}\">{}</text>", number(x + 24), number(y + 4), escapeMarkup(series.name));
      x += needed;
    }
    if (hasLegend) area_.top = y + 14;
  }

  void fitScales() {
    x_ = fitScale(plot_.x, valuesOf(plot_, &PlotPoint::x, &PlotPoint::xLow, &PlotPoint::xHigh));
    y_ = fitScale(plot_.y, valuesOf(plot_, &PlotPoint::y, &PlotPoint::yLow, &PlotPoint::yHigh));
    x_.pixelFrom = area_.left;
    x_.pixelTo = area_.right;
    y_.pixelFrom = area_.bottom;
    y_.pixelTo = area_.top;
  }

  void drawGrid() {
    const int mostX = std::max(2, int((area_.right - area_.left) / 62)),
              mostY = std::max(2, int((area_.bottom - area_.top) / 28));
    const std::vector<PlotTick> ticksX =
        plot_.x.ticks.empty() ? chooseTicks(x_.from, x_.to, x_.isLogarithmic, mostX) : plot_.x.ticks;
    const std::vector<PlotTick> ticksY =
        plot_.y.ticks.empty() ? chooseTicks(y_.from, y_.to, y_.isLogarithmic, mostY) : plot_.y.ticks;
    double taken = -std::numeric_limits<double>::infinity();  // right end of the last label
    for (const PlotTick& tick : ticksX) {
      if (!x_.shows(tick.at)) continue;
      const double x = x_.pixel(tick.at), half = textWidth(tick.label) / 2;
      add("<path class=\"grid\" d=\"M{} {}V{}\"/>", number(x), number(area_.top), number(area_.bottom));
      if (x - half < taken + 4) continue;
      taken = x + half;
      add("<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", number(x),
          number(area_.bottom + 15), escapeMarkup(tick.label));
    }
    for (const PlotTick& tick : ticksY) {
      if (!y_.shows(tick.at)) continue;
      const double y = y_.pixel(tick.at);
      add("<path class=\"grid\" d=\"M{} {}H{}\"/>", number(area_.left), number(y), number(area_.right));
      add("<text class=\"tick\" x=\"{}\" y=\"{}\" text-anchor=\"end\">{}</text>", number(area_.left - 6),
          number(y + 4), escapeMarkup(tick.label));
    }
    add("<path class=\"axis\" d=\"M{} {}V{}H{}\"/>", number(area_.left), number(area_.top),
        number(area_.bottom), number(area_.right));
    if (!plot_.x.label.empty()) {
      add("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>", number((area_.left + area_.right) / 2),
          number(area_.bottom + 34), escapeMarkup(plot_.x.label));
    }
    if (!plot_.y.label.empty()) {
      const double y = (area_.top + area_.bottom) / 2;
      add("<text x=\"12\" y=\"{0}\" text-anchor=\"middle\" transform=\"rotate(-90 12 {0})\">{1}</text>",
          number(y), escapeMarkup(plot_.y.label));
    }
  }

  static const char* dashClass(const PlotSeries& series) {
    return series.line == PlotLine::kDashed ? "dashed" : series.line == PlotLine::kDotted ? "dotted" : "";
  }

  bool shows(const PlotPoint& point) const { return x_.shows(point.x) && y_.shows(point.y); }

  void drawLine(size_t s) {
    const PlotSeries& series = plot_.series[s];
    if (series.line == PlotLine::kNone) return;
    std::string path;
    for (const PlotPoint& point : series.points) {
      if (!shows(point)) continue;
      const std::string x = number(x_.clampedPixel(point.x)), y = number(y_.clampedPixel(point.y));
      if (path.empty()) {
        path = fmt::format("M{} {}", x, y);
      } else if (series.isStepped) {
        path += fmt::format("H{}V{}", x, y);
      } else {
        path += fmt::format("L{} {}", x, y);
      }
    }
    if (series.isStepped) keepClear(series);
    if (!path.empty()) add("<path class=\"line {} {}\" d=\"{}\"/>", colourClass(s), dashClass(series), path);
  }

  // Labels keep off the steps of a line.
  void keepClear(const PlotSeries& series) {
    constexpr double kHalf = 1.5;
    for (size_t i = 1; i < series.points.size(); ++i) {
      if (!shows(series.points[i - 1]) || !shows(series.points[i])) continue;
      const double x0 = x_.pixel(series.points[i - 1].x), y0 = y_.pixel(series.points[i - 1].y);
      const double x1 = x_.pixel(series.points[i].x), y1 = y_.pixel(series.points[i].y);
      taken_.push_back({std::min(x0, x1), y0 - kHalf, std::max(x0, x1), y0 + kHalf});
      taken_.push_back({x1 - kHalf, std::min(y0, y1), x1 + kHalf, std::max(y0, y1)});
    }
  }

  void drawBars(size_t s) {
    for (const PlotPoint& point : plot_.series[s].points) {
      if (!shows(point)) continue;
      const std::string x = number(x_.pixel(point.x)), y = number(y_.pixel(point.y));
      if (point.xLow < point.xHigh) {
        const double low = x_.clampedPixel(point.xLow), high = x_.clampedPixel(point.xHigh);
        bars_.push_back({low, y_.pixel(point.y) - 1, high, y_.pixel(point.y) + 1});
        add("<path class=\"bar {0}\" d=\"M{1} {2}H{3}M{1} {4}v6M{3} {4}v6\"/>", colourClass(s), number(low),
            y, number(high), number(y_.pixel(point.y) - 3));
      }
      if (point.yLow < point.yHigh) {
        const double low = y_.clampedPixel(point.yLow), high = y_.clampedPixel(point.yHigh);
        add("<path class=\"bar {0}\" d=\"M{1} {2}V{3}M{4} {2}h6M{4} {3}h6\"/>", colourClass(s), x,
            number(low), number(high), number(x_.pixel(point.x) - 3));
      }
    }
  }

  void addMarker(size_t s, const PlotPoint& point, double x, double y) {
    const double r = kMarker;
    std::string shape;
    switch (isNeutral(s) ? 0 : look(s) % 4) {
      case 0:
        shape = fmt::format("M{} {}a{r} {r} 0 1 0 {} 0a{r} {r} 0 1 0 {} 0Z", number(x - r), number(y),
                            number(2 * r), number(-2 * r), fmt::arg("r", number(r)));
        break;
      case 1:
        shape = fmt::format("M{} {}h{r}v{r}h-{r}Z", number(x - r + 0.5), number(y - r + 0.5),
                            fmt::arg("r", number(2 * r - 1)));
        break;
      case 2:
        shape = fmt::format("M{} {}L{} {}H{}Z", number(x), number(y - r - 0.5), number(x + r + 0.5),
                            number(y + r - 0.5), number(x - r - 0.5));
        break;
      default:
        shape = fmt::format("M{} {}L{} {}L{} {}L{} {}Z", number(x), number(y - r - 1), number(x + r + 1),
                            number(y), number(x), number(y + r + 1), number(x - r - 1), number(y));
    }
    const std::string tooltip =
        point.tooltip.empty() ? "" : "<title>" + escapeMarkup(point.tooltip) + "</title>";
    if (point.isRinged) {
      add("<circle class=\"ring {}\" cx=\"{}\" cy=\"{}\" r=\"{}\">{}</circle>", colourClass(s), number(x),
          number(y), number(r + 4), tooltip);
    }
    add("<path class=\"mark {}{}\" d=\"{}\">{}</path>", colourClass(s), point.isHollow ? " hollow" : "",
        shape, tooltip);
  }

  void drawMarkers(size_t s) {
    if (!plot_.series[s].hasMarkers) return;
    const std::vector<PlotPoint>& points = plot_.series[s].points;
    for (auto it = points.rbegin(); it != points.rend(); ++it) {  // the first, which matter most, on top
      const PlotPoint& point = *it;
      if (!shows(point)) continue;
      const double x = x_.pixel(point.x), y = y_.pixel(point.y), r = kMarker + (point.isRinged ? 4 : 0);
      addMarker(s, point, x, y);
      taken_.push_back({x - r, y - r, x + r, y + r});
    }
  }

  // Each label at the first of a few places around its point that nothing else has taken.
  void drawLabels() {
    for (const PlotSeries& series : plot_.series) {
      for (const PlotPoint& point : series.points) {
        if (!point.label.empty() && shows(point)) drawLabel(point);
      }
    }
  }

  void drawLabel(const PlotPoint& point) {
    for (bool avoidsBars : {true, false}) {
      for (double distance : {0.0, 10.0, 24.0}) {
        for (const Box& box : placesAround(point, distance)) {
          if (isFree(box, avoidsBars)) return drawLabelAt(point, box, distance > 0);
        }
      }
    }
  }

  std::vector<Box> placesAround(const PlotPoint& point, double distance) const {
    const double x = x_.pixel(point.x), y = y_.pixel(point.y), width = textWidth(point.label);
    const double away = kMarker + (point.isRinged ? 6 : 3) + distance, slant = away * 0.7,
                 line = kLineHeight / 2;
    return {{x + away, y - line, x + away + width, y + line},
            {x - away - width, y - line, x - away, y + line},
            {x - width / 2, y - away - 2 * line, x + width / 2, y - away},
            {x - width / 2, y + away, x + width / 2, y + away + 2 * line},
            {x + slant, y - slant - 2 * line, x + slant + width, y - slant},
            {x + slant, y + slant, x + slant + width, y + slant + 2 * line},
            {x - slant - width, y - slant - 2 * line, x - slant, y - slant},
            {x - slant - width, y + slant, x - slant, y + slant + 2 * line}};
  }

  bool isFree(const Box& box, bool avoidsBars) const {
    const auto meets = [&](const Box& other) { return other.meets(box); };
    return area_.holds(box) && std::none_of(taken_.begin(), taken_.end(), meets) &&
           !(avoidsBars && std::any_of(bars_.begin(), bars_.end(), meets));
  }

  void drawLabelAt(const PlotPoint& point, const Box& box, bool hasLeader) {
    const double x = x_.pixel(point.x), y = y_.pixel(point.y);
    if (hasLeader) {
      add("<path class=\"leader\" d=\"M{} {}L{} {}\"/>", number(x), number(y),
          number(std::clamp(x, box.left, box.right)), number(std::clamp(y, box.top, box.bottom)));
    }
    add("<text class=\"label\" x=\"{}\" y=\"{}\">{}</text>", number(box.left), number(box.bottom - 3.5),
        escapeMarkup(point.label));
    taken_.push_back(box);
  }

  const Plot& plot_;
  std::string body_;
  Box area_;
  Scale x_, y_;
  std::vector<Box> taken_;  // by markers, steps and labels
  std::vector<Box> bars_;   // where a label is better not
};

}  // namespace

std::string drawPlot(const Plot& plot) {
  return Drawing(plot).draw(false);
}

std::string drawPlotFile(const Plot& plot) {
  return Drawing(plot).draw(true);
}

}  // namespace froth
