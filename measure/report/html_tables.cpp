// The sections of report.html that list: summary, passes, views, features, pictures, all points, origin.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "measure/report/html_parts.h"
#include "measure/report/svg_plot.h"

namespace froth {
namespace {

std::string encodeBase64(const std::vector<uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? bytes[i + k] : 0);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

// A bar of `share` of the cell's width behind a figure.
std::string bar(double share) {
  return fmt::format("<span class=\"share\" style=\"width:{:.1f}%\"></span>",
                     std::clamp(share, 0.0, 1.0) * 100);
}

std::string tile(const std::string& name, const std::string& value, const std::string& more) {
  return "<div class=\"tile\"><span>" + escapeMarkup(name) + "</span><b>" + escapeMarkup(value) +
         "</b><small>" + escapeMarkup(more) + "</small></div>\n";
}

std::string tilesOf(const Report& report, const ReportPoint& point) {
  const double cells = std::max(1.0, double(report.cells));
  std::string tiles =
      tile(point.renderer + ", a frame", milliseconds(point.total.median),
           fmt::format("5–95 %: {}–{}", shortNumber(point.total.p5), shortNumber(point.total.p95)));
  tiles += tile("PSNR", decibels(point.errors.psnr) + " dB",
                point.photoErrors ? decibels(point.photoErrors->psnr) + " dB against photos"
                                  : "against double precision");
  tiles += tile("FLIP", shortNumber(point.errors.flip), fmt::format("SSIM {:.5f}", point.errors.ssim));
  tiles += tile("Mean error", shortNumber(point.errors.meanError),
                "largest " + shortNumber(point.errors.maxError));
  tiles += tile("Off by > 1/255", percent(point.errors.overOneStep),
                "depth off by " + shortNumber(point.errors.depthError));
  tiles += tile("On disk", bytesText(double(point.diskBytes)),
                fmt::format("{} bytes a cell", shortNumber(double(point.diskBytes) / cells)));
  tiles += tile("Resident", bytesText(double(point.residentBytes)), "asset and view");
  return "<div class=\"tiles\">\n" + tiles + "</div>\n";
}

std::string differenceText(double now, double before, const char* unit) {
  const double difference = now - before;
  if (!std::isfinite(difference)) return "–";
  return signedText(difference, 2) + " " + unit;
}

std::string pickTable(const ReportPoint& standard, const ReportPoint& chosen) {
  Table table({"", "default", "picked: " + settingsText(chosen), "change"});
  table.add({textCell("PSNR [dB]"), numberCell(decibels(standard.errors.psnr)),
             numberCell(decibels(chosen.errors.psnr)),
             numberCell(differenceText(chosen.errors.psnr, standard.errors.psnr, "dB"))});
  table.add({textCell("FLIP"), numberCell(shortNumber(standard.errors.flip)),
             numberCell(shortNumber(chosen.errors.flip)), numberCell("")});
  if (standard.photoErrors && chosen.photoErrors) {
    table.add({textCell("PSNR against photos [dB]"), numberCell(decibels(standard.photoErrors->psnr)),
               numberCell(decibels(chosen.photoErrors->psnr)),
               numberCell(differenceText(chosen.photoErrors->psnr, standard.photoErrors->psnr, "dB"))});
  }
  table.add({textCell("ms"), timeCell(standard.total), timeCell(chosen.total),
             changeCell(chosen.total, standard.total)});
  const auto bytesRow = [&](const char* name, uint64_t before, uint64_t now) {
    const double change = before ? (double(now) / double(before) - 1) * 100 : 0;
    table.add({textCell(name), numberCell(bytesText(double(before))), numberCell(bytesText(double(now))),
               numberCell(now == before ? "none" : signedText(change, 1) + " %")});
  };
  bytesRow("on disk", standard.diskBytes, chosen.diskBytes);
  bytesRow("resident", standard.residentBytes, chosen.residentBytes);
  return table.html();
}

std::string imageTag(const ReportImage& image) {
  return "<img alt=\"" + escapeMarkup(image.title) + "\" src=\"data:image/png;base64," +
         encodeBase64(image.png) + "\">";
}

}  // namespace

std::string summarySection(const Report& report) {
  std::string body;
  for (const std::string& renderer : renderersOf(report)) {
    if (const ReportPoint* standard = defaultOf(report, renderer)) body += tilesOf(report, *standard);
  }
  const ReportPoint* chosen = findPoint(report, report.chosen);
  if (chosen) {
    const ReportPoint* standard = defaultOf(report, chosen->renderer);
    body += "<h3>What this report picks</h3>\n<p><b>" +
            escapeMarkup(isDefault(*chosen) ? "The default stands." : settingsText(*chosen)) + "</b> " +
            escapeMarkup(report.choice) + "</p>\n";
    if (standard && standard != chosen) body += pickTable(*standard, *chosen);
  }
  return section("summary", "The default", body);
}

std::string passesSection(const Report& report) {
  std::string body;
  for (const std::string& renderer : renderersOf(report)) {
    const ReportPoint* standard = defaultOf(report, renderer);
    if (!standard || standard->passes.empty()) continue;
    Table table({renderer + ": pass", "ms", "5 % to 95 %", "share of the frame"});
    for (const PassTimes& pass : standard->passes) {
      const double share = standard->total.median > 0 ? pass.time.median / standard->total.median : 0;
      table.add({textCell(pass.pass),
                 numberCell(shortNumber(pass.time.median)),
                 numberCell(shortNumber(pass.time.p5) + " to " + shortNumber(pass.time.p95)),
                 {bar(share) + escapeMarkup(fmt::format("{:.0f} %", share * 100)), "bars"}});
    }
    table.add({textCell("whole frame"), numberCell(shortNumber(standard->total.median)),
               numberCell(shortNumber(standard->total.p5) + " to " + shortNumber(standard->total.p95)),
               textCell("")},
              true);
    body += table.html();
  }
  return body.empty() ? "" : section("passes", "Where the default's time goes", body);
}

std::string viewsSection(const Report& report) {
  std::string body;
  for (const std::string& renderer : renderersOf(report)) {
    const ReportPoint* standard = defaultOf(report, renderer);
    if (!standard || standard->views.empty()) continue;
    const auto worst = std::min_element(
        standard->views.begin(), standard->views.end(),
        [](const ViewErrors& a, const ViewErrors& b) { return a.errors.psnr < b.errors.psnr; });
    std::vector<std::string> head{renderer + ": view"};
    for (const std::string& title : errorHead()) head.push_back(title);
    head.push_back("worst pixel");
    Table table(head);
    for (const ViewErrors& view : standard->views) {
      std::vector<Cell> row{numberCell(std::to_string(view.view))};
      for (const Cell& cell : errorCells(view.errors)) row.push_back(cell);
      row.push_back(numberCell(fmt::format("({}, {})", view.worstX, view.worstY)));
      if (&view == &*worst) row[0].html += " <span class=\"badge\">worst</span>";
      table.add(row, &view == &*worst);
    }
    body += table.html();
  }
  return body.empty() ? "" : section("views", "The default, view by view", body);
}

std::string featuresSection(const Report& report) {
  if (report.features.empty()) return "";
  Table table({"feature", "this scene", "measured as", "on disk", "resident", "raster without", "raster with",
               "change", "walk without", "walk with", "change", "PSNR without it"});
  for (const FeatureCost& feature : report.features) {
    table.add({textCell(feature.feature),
               {feature.isUsed ? "<span class=\"badge\">uses it</span>"
                               : "<span class=\"badge good\">left out</span>",
                "text"},
               textCell(feature.variant),
               numberCell(bytesText(double(feature.diskBytes))),
               numberCell(bytesText(double(feature.residentBytes))),
               timeCell(feature.rasterWithout),
               timeCell(feature.rasterWith),
               changeCell(feature.rasterWith, feature.rasterWithout),
               timeCell(feature.walkWithout),
               timeCell(feature.walkWith),
               changeCell(feature.walkWith, feature.walkWithout),
               numberCell(feature.isUsed ? decibels(feature.psnr) : "–")});
  }
  return section(
      "features", "What the scene does not need",
      paragraph(
          "What each feature costs: with it minus without it, in bytes and in milliseconds. What the scene "
          "does not use was left out by baker and runtime, and put in only to be measured.") +
          table.html());
}

std::string imagesSection(const Report& report) {
  if (report.images.empty()) return "";
  std::string body = "<div class=\"images\">\n";
  for (const ReportImage& image : report.images) {
    body += "<figure><figcaption><b>" + escapeMarkup(image.title) + "</b> " + escapeMarkup(image.caption) +
            "</figcaption>" + imageTag(image) + "</figure>\n";
  }
  return section("pictures", "Pictures of the error", body + "</div>\n");
}

std::string pointsSection(const Report& report) {
  if (report.points.empty()) return "";
  std::vector<std::string> head{"renderer", "settings"};
  for (const std::string& title : errorHead()) head.push_back(title);
  head.insert(head.end(), {"ms", "against default", "on disk", "resident", "bake [s]"});
  Table table(head);
  for (const ReportPoint& point : report.points) {
    const ReportPoint* standard = defaultOf(report, point.renderer);
    std::vector<Cell> row{textCell(point.renderer), pointCell(report, point)};
    for (const Cell& cell : errorCells(point.errors)) row.push_back(cell);
    row.push_back(timeCell(point.total));
    row.push_back(standard && standard != &point ? changeCell(point.total, standard->total)
                                                 : numberCell("–"));
    row.push_back(bytesCell(point.diskBytes));
    row.push_back(bytesCell(point.residentBytes));
    row.push_back(numberCell(point.bakeSeconds > 0 ? shortNumber(point.bakeSeconds) : "–"));
    table.add(row, isDefault(point));
  }
  return section("points", "Everything that was measured",
                 fmt::format("<details><summary>{} configurations</summary>\n", report.points.size()) +
                     table.html() + "</details>\n");
}

std::string originSection(const Report& report) {
  std::string views;
  for (uint32_t view : report.views) views += (views.empty() ? "" : ", ") + std::to_string(view);
  Table table({"", ""});
  const auto row = [&](const char* name, const std::string& value) {
    if (!value.empty()) table.add({textCell(name), textCell(value)});
  };
  row("scene", report.scene);
  row("input", report.input);
  row("foam", fmt::format("{} cells, {} detail sites, {} lobes a site", countText(report.cells),
                          report.detailCount, report.lobeCount));
  row("images", fmt::format("{} x {} pixels, views {}", report.width, report.height, views));
  row("time", fmt::format("{} frames; {}", report.frames,
                          report.isLinearTime ? "GPU timestamps" : "wall clock of the CPU renderer"));
  row("device", report.device);
  row("driver", report.driver);
  row("version", report.version);
  row("command", report.command);
  std::string body = table.html();
  if (!report.notes.empty()) {
    body += "<h3>Notes</h3>\n<ul>\n";
    for (const std::string& note : report.notes) body += "<li>" + escapeMarkup(note) + "</li>\n";
    body += "</ul>\n";
  }
  if (!report.credit.empty()) body += "<p class=\"credit\">" + escapeMarkup(report.credit) + "</p>\n";
  return section("origin", "Device, versions, notes", body);
}

}  // namespace froth
