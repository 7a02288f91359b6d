// report.html: report.json with what a reader compares, in templates/page.html.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "measure/report/fill_template.h"
#include "measure/report/html_parts.h"
#include "measure/report/text.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

// How `interval` stands to `base`: "tie" where noise explains it, otherwise the change in percent. Null: not measured.
Json changeOf(const Interval& interval, const Interval& base) {
  if (!(interval.median > 0) || !(base.median > 0)) return nullptr;
  if (isTie(interval, base)) return {{"kind", "soft"}, {"text", "tie"}};
  const double change = (interval.median / base.median - 1) * 100;
  return {{"kind", change < 0 ? "better" : "worse"}, {"text", signedText(change, 1) + " %"}};
}

// The row of a point in tables.
Json rowOf(const Report& report, const ReportPoint& point) {
  Json row = pointAsJson(point);
  const ReportPoint* standard = defaultOf(report, point.renderer);
  row["settingsText"] = settingsText(point);
  row["isDefault"] = point.settings.empty();
  row["isPicked"] = point.id == report.chosen;
  row["change"] = standard && standard != &point ? changeOf(point.total, standard->total) : nullptr;
  row["bytesPerCell"] = shortNumber(double(point.diskBytes) / std::max(1.0, double(report.cells)));
  return row;
}

// With shares of passes, and the worst view marked.
Json defaultRow(const Report& report, const ReportPoint& point) {
  Json row = rowOf(report, point);
  for (size_t i = 0; i < point.passes.size(); ++i) {
    const double share = point.total.median > 0 ? point.passes[i].time.median / point.total.median : 0;
    row["passes"][i]["share"] = fmt::format("{:.0f}", share * 100);
    row["passes"][i]["barWidth"] = std::clamp(share, 0.0, 1.0) * 100;
  }
  const auto worst = std::min_element(point.views.begin(), point.views.end(),
                                      [](const auto& a, const auto& b) { return a.errors.psnr < b.errors.psnr; });
  if (worst != point.views.end()) row["views"][size_t(worst - point.views.begin())]["isWorst"] = true;
  return row;
}

std::string differenceText(double now, double before) {
  return std::isfinite(now - before) ? signedText(now - before, 2) + " dB" : "–";
}

std::string changeOfBytes(uint64_t now, uint64_t before) {
  if (now == before) return "none";
  return signedText(before ? (double(now) / double(before) - 1) * 100 : 0, 1) + " %";
}

Json pickOf(const Report& report, const ReportPoint& chosen) {
  Json pick = rowOf(report, chosen);
  const ReportPoint* standard = defaultOf(report, chosen.renderer);
  if (!standard || standard == &chosen) return pick;
  pick["standard"] = rowOf(report, *standard);
  pick["psnrChange"] = differenceText(chosen.errors.psnr, standard->errors.psnr);
  if (standard->photoErrors && chosen.photoErrors) {
    pick["photosChange"] = differenceText(chosen.photoErrors->psnr, standard->photoErrors->psnr);
  }
  pick["diskChange"] = changeOfBytes(chosen.diskBytes, standard->diskBytes);
  pick["residentChange"] = changeOfBytes(chosen.residentBytes, standard->residentBytes);
  return pick;
}

// Points that cost the same within the noise, with a larger error; a few by name.
std::string tiesOf(const Report& report, const ReportPoint& point, Cost cost) {
  std::string names;
  int count = 0;
  for (const ReportPoint& other : report.points) {
    const bool ties = cost == Cost::kTime ? isTie(other.total, point.total) : other.diskBytes == point.diskBytes;
    if (&other == &point || other.renderer != point.renderer || !ties || ++count > 4) continue;
    names += (names.empty() ? "" : "; ") + settingsText(other);
  }
  if (count > 4) names += fmt::format("; and {} more", count - 4);
  return count == 0 ? "–" : names;
}

Json frontOf(const Report& report, Cost cost, const std::vector<std::string>& front) {
  const double lowest = lowestDrawn(report, front);
  Json below = Json::array(), equal = Json::array();  // ids
  for (const ReportPoint* point : candidatesOf(report, front)) {
    if (point->errors.psnr < lowest) below.push_back(point->id);
    if (std::isinf(point->errors.psnr)) equal.push_back(point->id);
  }
  Json rows = Json::array();
  for (const std::string& id : front) {
    const ReportPoint* point = findPoint(report, id);
    if (!point) continue;
    rows.push_back(rowOf(report, *point));
    rows.back()["ties"] = tiesOf(report, *point, cost);
  }
  const bool isTime = cost == Cost::kTime;
  return {{"anchor", isTime ? "time" : "bytes"},
          {"heading", isTime ? "Error over milliseconds" : "Error over bytes"},
          {"tieTitle", isTime ? "ties with it in time" : "as large"},
          {"plot", frontPlot(report, cost, front)},
          {"lowest", decibels(lowest)},
          {"below", below},
          {"equal", equal},
          {"rows", rows}};
}

void completeSweep(const Report& report, const Sweep& sweep, Json& json) {
  json["title"] = titleOf(sweep);
  json["plots"] = sweepPlots(report, sweep);
  json["rows"] = Json::array();
  for (const SweepPoint& swept : pointsOf(report, sweep)) {
    json["rows"].push_back(rowOf(report, *swept.point));
    json["rows"].back()["value"] = swept.value;
  }
}

void completeSlope(const Slope& slope, Json& json) {
  json["expected"] = fmt::format("{:g}", slope.expected);
  json["measured"] = slope.atOne > 0 ? signedText(slope.measured, 2) : "–";
  json["kind"] = slope.verdict == kVerdictAsDerived ? "good"
                 : slope.verdict == kVerdictFloor   ? "fair"
                 : slope.verdict == kVerdictTooFew  ? ""
                                                    : "bad";
  json["plot"] = slopePlot(slope);
}

void completeFeature(const FeatureCost& feature, Json& json) {
  json["diskText"] = bytesText(double(feature.diskBytes));
  json["residentText"] = bytesText(double(feature.residentBytes));
  json["rasterWith"]["change"] = changeOf(feature.rasterWith, feature.rasterWithout);
  json["walkWith"]["change"] = changeOf(feature.walkWith, feature.walkWithout);
}

// A row per kind; a column for each form of what is prepared. costs: reportAsJson()'s.
Json rayTableOf(const Json& costs) {
  if (costs.empty()) return nullptr;
  Json rows = Json::array(), bytes = Json::array();
  for (const Json& cost : costs) {
    if (bytes.empty() || bytes.back()["prepared"] != cost["prepared"]) bytes.push_back(cost);
    auto row = std::ranges::find_if(rows, [&](const Json& made) { return made["rays"] == cost["rays"]; });
    if (row == rows.end()) row = rows.insert(rows.end(), cost);  // kind and error are the same in all forms
    (*row)["forms"].push_back(Json::object({{"time", cost["time"]}}));
  }
  bytes.back()["isLast"] = true;
  return {{"rows", rows}, {"bytes", bytes}};
}

std::string encodeBase64(const std::vector<uint8_t>& bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = std::min<size_t>(3, bytes.size() - i);
    uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k) word = word << 8 | (k < count ? bytes[i + k] : 0);
    for (size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

}  // namespace

nlohmann::ordered_json picturesAsJson(const std::vector<ReportImage>& images) {
  Json pictures = Json::array();
  for (const ReportImage& image : images) {
    pictures.push_back({{"title", image.title}, {"caption", image.caption}, {"png", encodeBase64(image.png)}});
  }
  return pictures;
}

std::string reportAsHtml(const Report& report) {
  Json page = reportAsJson(report);
  page["viewNumbers"] = fmt::format("{}", fmt::join(report.views, ", "));
  page["points"] = page["defaults"] = page["fronts"] = Json::array();
  page["hasPasses"] = page["hasViews"] = page["hasPhotos"] = false;
  for (const ReportPoint& point : report.points) {
    if (point.photoErrors) page["hasPhotos"] = true;
    page["points"].push_back(rowOf(report, point));
    if (defaultOf(report, point.renderer) != &point) continue;
    page["defaults"].push_back(defaultRow(report, point));
    if (!point.passes.empty()) page["hasPasses"] = true;
    if (!point.views.empty()) page["hasViews"] = true;
  }
  if (const ReportPoint* chosen = findPoint(report, report.chosen)) page["pick"] = pickOf(report, *chosen);
  if (!report.points.empty()) {
    page["fronts"].push_back(frontOf(report, Cost::kTime, report.frontOverTime));
    page["fronts"].push_back(frontOf(report, Cost::kDiskBytes, report.frontOverBytes));
  }
  for (size_t i = 0; i < report.sweeps.size(); ++i) completeSweep(report, report.sweeps[i], page["sweeps"][i]);
  for (size_t i = 0; i < report.slopes.size(); ++i) completeSlope(report.slopes[i], page["slopes"][i]);
  for (size_t i = 0; i < report.features.size(); ++i) completeFeature(report.features[i], page["features"][i]);
  page["levels"] = levelsOf(report);
  page["rayTable"] = rayTableOf(page["rays"]);
  page["images"] = picturesAsJson(report.images);
  return fillTemplate("page.html", page);
}

}  // namespace froth
