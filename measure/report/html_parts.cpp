#include "measure/report/html_parts.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measure/report/svg_plot.h"

namespace froth {

const ReportPoint* findPoint(const Report& report, const std::string& id) {
  for (const ReportPoint& point : report.points) {
    if (point.id == id) return &point;
  }
  return nullptr;
}

const ReportPoint* defaultOf(const Report& report, const std::string& renderer) {
  for (const ReportPoint& point : report.points) {
    if (point.renderer == renderer && isDefault(point)) return &point;
  }
  return nullptr;
}

std::vector<std::string> renderersOf(const Report& report) {
  std::vector<std::string> renderers;
  for (const ReportPoint& point : report.points) {
    if (std::find(renderers.begin(), renderers.end(), point.renderer) == renderers.end()) {
      renderers.push_back(point.renderer);
    }
  }
  return renderers;
}

bool isDefault(const ReportPoint& point) {
  return point.settings.empty();
}

bool isTimed(const ReportPoint& point) {
  return point.total.median > 0;
}

bool hasPhotos(const Report& report) {
  return std::any_of(report.points.begin(), report.points.end(),
                     [](const ReportPoint& point) { return point.photoErrors.has_value(); });
}

std::string settingsText(const ReportPoint& point) {
  if (isDefault(point)) return "default";
  std::string text;
  for (const Setting& setting : point.settings) {
    text += (text.empty() ? "" : ", ") + setting.knob + " " + setting.value;
  }
  return text;
}

int colourOf(const Report& report, const std::string& renderer) {
  const std::vector<std::string> renderers = renderersOf(report);
  return int(std::find(renderers.begin(), renderers.end(), renderer) - renderers.begin());
}

std::string milliseconds(double value) {
  return shortNumber(value) + " ms";
}

std::string intervalText(const Interval& interval) {
  return fmt::format("{} ({} to {})", milliseconds(interval.median), shortNumber(interval.p5),
                     shortNumber(interval.p95));
}

std::string bytesText(double bytes) {
  const ByteUnit unit = unitOfBytes(std::abs(bytes));
  return unit.bytes == 1 ? fmt::format("{:.0f} B", bytes) : shortNumber(bytes / unit.bytes) + " " + unit.name;
}

ByteUnit unitOfBytes(double largest) {
  if (largest >= 1e9) return {"GB", 1e9};
  if (largest >= 1e6) return {"MB", 1e6};
  if (largest >= 1e3) return {"kB", 1e3};
  return {"B", 1};
}

std::string decibels(double value) {
  if (std::isnan(value)) return "not a number";
  return std::isinf(value) ? shortNumber(value) : fmt::format("{:.2f}", value);
}

std::string percent(double share) {
  return share == 0 ? "0 %" : shortNumber(share * 100) + " %";
}

std::string countText(uint64_t count) {
  std::string text = std::to_string(count);
  for (size_t at = text.size(); at > 3;)
    text.insert(at -= 3, "\u202f");  // a narrow space that does not break
  return text;
}

std::string signedText(double value, int decimals) {
  const std::string size = fmt::format("{:.{}f}", std::abs(value), decimals);
  const bool isZero = size.find_first_not_of("0.") == std::string::npos;
  return (isZero ? "" : value < 0 ? "−" : "+") + size;
}

std::string tooltipOf(const ReportPoint& point) {
  return fmt::format("{}: {}; {} dB, FLIP {}, mean error {}, max {}; {}; {} on disk, {} resident",
                     point.renderer, settingsText(point), decibels(point.errors.psnr),
                     shortNumber(point.errors.flip), shortNumber(point.errors.meanError),
                     shortNumber(point.errors.maxError), intervalText(point.total),
                     bytesText(double(point.diskBytes)), bytesText(double(point.residentBytes)));
}

Cell textCell(const std::string& text) {
  return {escapeMarkup(text), "text"};
}

Cell numberCell(const std::string& text) {
  return {escapeMarkup(text), "number"};
}

Cell bytesCell(uint64_t bytes) {
  return numberCell(bytes == 0 ? "–" : bytesText(double(bytes)));
}

Cell timeCell(const Interval& interval) {
  if (interval.median == 0 && interval.p95 == 0) return numberCell("–");
  return {fmt::format("{} <small>{}–{}</small>", shortNumber(interval.median), shortNumber(interval.p5),
                      shortNumber(interval.p95)),
          "number"};
}

Cell changeCell(const Interval& interval, const Interval& base) {
  if (!(interval.median > 0) || !(base.median > 0)) return numberCell("–");
  if (isTie(interval, base)) return {"<span class=\"soft\">tie</span>", "number"};
  const double change = (interval.median / base.median - 1) * 100;
  return {
      fmt::format("<span class=\"{}\">{} %</span>", change < 0 ? "better" : "worse", signedText(change, 1)),
      "number"};
}

Cell pointCell(const Report& report, const ReportPoint& point) {
  std::string html = escapeMarkup(settingsText(point));
  if (isDefault(point)) html = "<b>default</b>";
  if (point.id == report.chosen) html += " <span class=\"badge pick\">picked</span>";
  return {html, "text"};
}

Table::Table(const std::vector<std::string>& head) : head_(head) {}

void Table::add(const std::vector<Cell>& cells, bool isMarked) {
  if (styles_.empty()) {
    for (const Cell& cell : cells) styles_.push_back(cell.style);
  }
  rows_ += isMarked ? "<tr class=\"marked\">" : "<tr>";
  for (const Cell& cell : cells) rows_ += fmt::format("<td class=\"{}\">{}</td>", cell.style, cell.html);
  rows_ += "</tr>\n";
}

std::string Table::html() const {
  std::string titles;
  for (size_t i = 0; i < head_.size(); ++i) {
    titles += fmt::format("<th class=\"{}\">{}</th>", i < styles_.size() ? styles_[i] : "text",
                          escapeMarkup(head_[i]));
  }
  return "<div class=\"scroll\"><table><thead><tr>" + titles + "</tr></thead><tbody>\n" + rows_ +
         "</tbody></table></div>\n";
}

std::vector<std::string> errorHead() {
  return {"PSNR [dB]", "SSIM", "FLIP", "mean error", "max error", ">\u00a01/255", "depth error"};
}

std::vector<Cell> errorCells(const ErrorFigures& errors) {
  return {numberCell(decibels(errors.psnr)),
          numberCell(std::isnan(errors.ssim) ? "–" : fmt::format("{:.5f}", errors.ssim)),
          numberCell(shortNumber(errors.flip)),
          numberCell(shortNumber(errors.meanError)),
          numberCell(shortNumber(errors.maxError)),
          numberCell(percent(errors.overOneStep)),
          numberCell(shortNumber(errors.depthError))};
}

std::string section(const std::string& anchor, const std::string& heading, const std::string& body) {
  return "<section id=\"" + anchor + "\"><h2>" + escapeMarkup(heading) + "</h2>\n" + body + "</section>\n";
}

std::string paragraph(const std::string& text) {
  return text.empty() ? "" : "<p>" + escapeMarkup(text) + "</p>\n";
}

std::string figure(const std::string& content, const std::string& caption) {
  return "<figure>" + content +
         (caption.empty() ? "" : "<figcaption>" + escapeMarkup(caption) + "</figcaption>") + "</figure>\n";
}

}  // namespace froth
