#include <cmath>
#include <limits>

#include "measure/report/report.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

// JSON knows no infinity and no NaN; both are written as text that reads back ("inf", "-inf", "nan").
Json figure(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

Json errorsAsJson(const ErrorFigures& errors) {
  return {{"psnr", figure(errors.psnr)},
          {"ssim", figure(errors.ssim)},
          {"flip", figure(errors.flip)},
          {"meanError", figure(errors.meanError)},
          {"maxError", figure(errors.maxError)},
          {"overOneStep", figure(errors.overOneStep)},
          {"distanceError", figure(errors.distanceError)}};
}

Json intervalAsJson(const Interval& interval) {
  return {{"median", figure(interval.median)}, {"p5", figure(interval.p5)}, {"p95", figure(interval.p95)}};
}

Json settingAsJson(const Setting& setting) {
  return {{"knob", setting.knob}, {"value", setting.value}, {"number", figure(setting.number)}};
}

Json sweepAsJson(const Sweep& sweep) {
  return {{"knob", sweep.knob},
          {"meaning", sweep.meaning},
          {"unit", sweep.unit},
          {"isLogarithmic", sweep.isLogarithmic},
          {"expectedOrder", figure(sweep.expectedOrder)},
          {"isBits", sweep.isBits},
          {"base", settingAsJson(sweep.base)},
          {"points", sweep.points}};
}

Json slopeAsJson(const Slope& slope) {
  Json x = Json::array(), y = Json::array();
  for (double value : slope.x) x.push_back(figure(value));
  for (double value : slope.y) y.push_back(figure(value));
  return {{"what", slope.what},
          {"expected", figure(slope.expected)},
          {"measured", figure(slope.measured)},
          {"verdict", slope.verdict},
          {"note", slope.note},
          {"fitted", slope.fitted},
          {"atOne", figure(slope.atOne)},
          {"floor", figure(slope.floor)},
          {"x", x},
          {"y", y}};
}

Json featureAsJson(const FeatureCost& feature) {
  return {{"feature", feature.feature},
          {"isUsed", feature.isUsed},
          {"variant", feature.variant},
          {"diskBytes", feature.diskBytes},
          {"residentBytes", feature.residentBytes},
          {"rasterWithout", intervalAsJson(feature.rasterWithout)},
          {"rasterWith", intervalAsJson(feature.rasterWith)},
          {"walkWithout", intervalAsJson(feature.walkWithout)},
          {"walkWith", intervalAsJson(feature.walkWith)},
          {"psnr", figure(feature.psnr)}};
}

Json rayCostAsJson(const RayCost& rays) {
  Json json = {{"rays", rays.rays},
               {"prepared", rays.prepared},
               {"time", intervalAsJson(rays.time)},
               {"count", rays.count},
               {"residentBytes", rays.residentBytes}};
  if (rays.psnr) json["psnr"] = figure(*rays.psnr);
  if (rays.maxError) json["maxError"] = figure(*rays.maxError);
  return json;
}

// Reads members by name; the first that is missing or of the wrong kind is remembered, and all after it are
// left alone.
class Reader {
 public:
  Reader(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json.is_object()) fail("", "an object");
  }

  void read(const char* name, std::string& value) {
    if (const Json* found = member(name)) found->is_string() ? void(value = *found) : fail(name, "text");
  }
  void read(const char* name, double& value) {
    const Json* found = member(name);
    if (!found) return;
    if (found->is_number()) {
      value = *found;
    } else if (*found == "inf") {
      value = std::numeric_limits<double>::infinity();
    } else if (*found == "-inf") {
      value = -std::numeric_limits<double>::infinity();
    } else if (*found == "nan") {
      value = std::numeric_limits<double>::quiet_NaN();
    } else {
      fail(name, "a number");
    }
  }
  template <class Count>
  requires std::is_unsigned_v<Count>
  void read(const char* name, Count& value) {
    const Json* found = member(name);
    if (!found) return;
    if (!found->is_number_unsigned() || found->template get<uint64_t>() > std::numeric_limits<Count>::max()) {
      return fail(name, "a whole number that is not negative");
    }
    value = *found;
  }
  template <class Part, class ReadPart>
  void readList(const char* name, std::vector<Part>& parts, const ReadPart& readPart) {
    const Json* found = member(name);
    if (!found) return;
    if (!found->is_array()) return fail(name, "a list");
    for (size_t i = 0; i < found->size() && status_; ++i) {
      Reader reader((*found)[i], place_ + name + "[" + std::to_string(i) + "].");
      parts.emplace_back();
      readPart(reader, parts.back());
      if (status_) status_ = reader.status_;
    }
  }
  template <class Part, class ReadPart>
  void readPart(const char* name, Part& part, const ReadPart& readPart) {
    const Json* found = member(name);
    if (!found) return;
    Reader reader(*found, place_ + name + ".");
    readPart(reader, part);
    if (status_) status_ = reader.status_;
  }
  bool has(const char* name) const { return json_.is_object() && json_.contains(name); }
  const Status& status() const { return status_; }

 private:
  const Json* member(const char* name) {
    if (!status_) return nullptr;
    const auto found = json_.find(name);
    if (found != json_.end()) return &*found;
    fail(name, "present");
    return nullptr;
  }
  void fail(const std::string& name, const char* wanted) {
    status_ = makeError(ErrorKind::kBadInput, "report point: '%s%s' is not %s; measure the point again", place_.c_str(),
                        name.c_str(), wanted);
  }

  const Json& json_;
  std::string place_;  // path of this object, with a trailing dot
  Status status_;
};

void readErrors(Reader& reader, ErrorFigures& errors) {
  reader.read("psnr", errors.psnr);
  reader.read("ssim", errors.ssim);
  reader.read("flip", errors.flip);
  reader.read("meanError", errors.meanError);
  reader.read("maxError", errors.maxError);
  reader.read("overOneStep", errors.overOneStep);
  reader.read("distanceError", errors.distanceError);
}

void readInterval(Reader& reader, Interval& interval) {
  reader.read("median", interval.median);
  reader.read("p5", interval.p5);
  reader.read("p95", interval.p95);
}

void readSetting(Reader& reader, Setting& setting) {
  reader.read("knob", setting.knob);
  reader.read("value", setting.value);
  reader.read("number", setting.number);
}

void readView(Reader& reader, ViewErrors& view) {
  reader.read("view", view.view);
  reader.readPart("errors", view.errors, readErrors);
  reader.read("worstX", view.worstX);
  reader.read("worstY", view.worstY);
}

void readPass(Reader& reader, PassTimes& pass) {
  reader.read("pass", pass.pass);
  reader.readPart("time", pass.time, readInterval);
}

}  // namespace

Json pointAsJson(const ReportPoint& point) {
  Json settings = Json::array(), views = Json::array(), passes = Json::array();
  for (const Setting& setting : point.settings) settings.push_back(settingAsJson(setting));
  for (const ViewErrors& view : point.views) {
    views.push_back(
        {{"view", view.view}, {"errors", errorsAsJson(view.errors)}, {"worstX", view.worstX}, {"worstY", view.worstY}});
  }
  for (const PassTimes& pass : point.passes) {
    passes.push_back({{"pass", pass.pass}, {"time", intervalAsJson(pass.time)}});
  }
  Json json = {
      {"id", point.id}, {"renderer", point.renderer}, {"settings", settings}, {"errors", errorsAsJson(point.errors)}};
  if (point.photoErrors) json["photoErrors"] = errorsAsJson(*point.photoErrors);
  if (point.wholeErrors) json["wholeErrors"] = errorsAsJson(*point.wholeErrors);
  json["views"] = views;
  json["total"] = intervalAsJson(point.total);
  json["passes"] = passes;
  json["diskBytes"] = point.diskBytes;
  json["residentBytes"] = point.residentBytes;
  json["drawnBytes"] = point.drawnBytes;
  json["viewBytes"] = point.viewBytes;
  json["drawnCells"] = point.drawnCells;
  json["bakeSeconds"] = figure(point.bakeSeconds);
  return json;
}

Result<ReportPoint> pointFromJson(const Json& json) {
  ReportPoint point;
  Reader reader(json, "");
  reader.read("id", point.id);
  reader.read("renderer", point.renderer);
  reader.readList("settings", point.settings, readSetting);
  reader.readPart("errors", point.errors, readErrors);
  if (reader.has("photoErrors")) reader.readPart("photoErrors", point.photoErrors.emplace(), readErrors);
  if (reader.has("wholeErrors")) reader.readPart("wholeErrors", point.wholeErrors.emplace(), readErrors);
  reader.readList("views", point.views, readView);
  reader.readPart("total", point.total, readInterval);
  reader.readList("passes", point.passes, readPass);
  reader.read("diskBytes", point.diskBytes);
  reader.read("residentBytes", point.residentBytes);
  reader.read("drawnBytes", point.drawnBytes);
  reader.read("viewBytes", point.viewBytes);
  reader.read("drawnCells", point.drawnCells);
  reader.read("bakeSeconds", point.bakeSeconds);
  if (!reader.status()) return reader.status().error();
  return point;
}

Json reportAsJson(const Report& report) {
  Json json = {{"scene", report.scene},         {"input", report.input},
               {"credit", report.credit},       {"device", report.device},
               {"driver", report.driver},       {"version", report.version},
               {"command", report.command},     {"width", report.width},
               {"height", report.height},       {"frames", report.frames},
               {"seed", report.seed},           {"views", report.views},
               {"cells", report.cells},         {"detailCount", report.detailCount},
               {"lobeCount", report.lobeCount}, {"isLinearTime", report.isLinearTime}};
  json["points"] = Json::array();
  for (const ReportPoint& point : report.points) json["points"].push_back(pointAsJson(point));
  json["sweeps"] = Json::array();
  for (const Sweep& sweep : report.sweeps) json["sweeps"].push_back(sweepAsJson(sweep));
  json["frontOverTime"] = report.frontOverTime;
  json["frontOverBytes"] = report.frontOverBytes;
  json["chosen"] = report.chosen;
  json["choice"] = report.choice;
  json["slopes"] = Json::array();
  for (const Slope& slope : report.slopes) json["slopes"].push_back(slopeAsJson(slope));
  json["features"] = Json::array();
  for (const FeatureCost& feature : report.features) json["features"].push_back(featureAsJson(feature));
  json["rays"] = Json::array();
  for (const RayCost& rays : report.rays) json["rays"].push_back(rayCostAsJson(rays));
  json["levelNeeds"] = Json::array();
  for (const LevelNeed& need : levelNeeds(report)) {
    json["levelNeeds"].push_back({{"psnr", need.psnr}, {"point", need.point ? Json(need.point->id) : Json(nullptr)}});
  }
  json["notes"] = report.notes;
  return json;
}

}  // namespace froth
