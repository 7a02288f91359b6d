// report.json and report.csv.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <sstream>

#include "measure/report/report.h"
#include "tests/report/sample_report.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;

// As --resume does: through text.
Result<ReportPoint> throughText(const ReportPoint& point) {
  return pointFromJson(Json::parse(pointAsJson(point).dump()));
}

TEST(ReportJson, EveryPointComesBackAsItWas) {
  for (const ReportPoint& point : test::makeSampleReport().points) {
    const Result<ReportPoint> back = throughText(point);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(pointAsJson(*back), pointAsJson(point));
    EXPECT_EQ(back->views.size(), point.views.size());
    EXPECT_EQ(back->errors.psnr, point.errors.psnr);  // to the last bit
    EXPECT_EQ(back->total.p95, point.total.p95);
  }
}

TEST(ReportJson, InfinityAndNaNComeBack) {
  ReportPoint point;
  point.id = "raster";
  point.errors.psnr = std::numeric_limits<double>::infinity();
  point.errors.ssim = std::nan("");
  point.photoErrors.emplace().psnr = -std::numeric_limits<double>::infinity();
  const Result<ReportPoint> back = throughText(point);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->errors.psnr, point.errors.psnr);
  EXPECT_TRUE(std::isnan(back->errors.ssim));
  EXPECT_EQ(back->photoErrors->psnr, point.photoErrors->psnr);
}

void expectRefused(const Json& json, const std::string& place) {
  const Result<ReportPoint> point = pointFromJson(json);
  ASSERT_FALSE(point) << place;
  EXPECT_EQ(point.error().kind, ErrorKind::kBadInput);
  EXPECT_NE(point.error().message.find(place), std::string::npos) << point.error().message;
}

TEST(ReportJson, ABrokenPointIsRefusedByTheNameOfWhatIsBroken) {
  const Json good = pointAsJson(test::makeSampleReport().points[2]);
  for (const auto& [name, value] : good.items()) {
    if (name == "photoErrors") continue;  // may be missing
    Json json = good;
    json.erase(name);
    expectRefused(json, "'" + name + "'");
    json[name] = true;
    expectRefused(json, "'" + name);
  }
  const auto broken = [&](const char* pointer, const Json& value) {
    Json json = good;
    json[Json::json_pointer(pointer)] = value;
    return json;
  };
  expectRefused(broken("/errors/psnr", "great"), "'errors.psnr'");
  expectRefused(broken("/errors/psnr", nullptr), "'errors.psnr'");
  expectRefused(broken("/photoErrors/flip", Json::array()), "'photoErrors.flip'");
  expectRefused(broken("/views/3/worstX", -1), "'views[3].worstX'");
  expectRefused(broken("/views/3/worstX", 4294967296), "'views[3].worstX'");
  expectRefused(broken("/views/0/errors", 1), "'views[0].errors.'");
  expectRefused(broken("/settings/0", "cutoff"), "'settings[0].'");
  expectRefused(broken("/passes/1/time/p5", {}), "'passes[1].time.p5'");
  expectRefused(broken("/diskBytes", 1.5), "'diskBytes'");
  expectRefused(Json::array(), "object");
  expectRefused(Json(), "object");
}

TEST(ReportJson, HoldsAllButThePictures) {
  const Report report = test::makeSampleReport();
  const Json json = reportAsJson(report);
  EXPECT_EQ(json["points"].size(), report.points.size());
  EXPECT_EQ(json["sweeps"].size(), report.sweeps.size());
  EXPECT_EQ(json["slopes"].size(), report.slopes.size());
  EXPECT_EQ(json["features"][0]["diskBytes"], report.features[0].diskBytes);
  EXPECT_EQ(json["rays"].size(), report.rays.size());
  EXPECT_EQ(json["rays"][1]["psnr"], *report.rays[1].psnr);
  EXPECT_EQ(json["chosen"], report.chosen);
  EXPECT_FALSE(json.contains("images"));
  EXPECT_EQ(Json::parse(json.dump()), json);
}

// Fields of one line, with quotes taken off.
std::vector<std::string> fieldsOf(const std::string& line) {
  std::vector<std::string> fields(1);
  bool isQuoted = false;
  for (size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '"') {
      if (isQuoted && line[i + 1] == '"') {
        fields.back() += line[i++];
      } else {
        isQuoted = !isQuoted;
      }
    } else if (line[i] == ',' && !isQuoted) {
      fields.emplace_back();
    } else {
      fields.back() += line[i];
    }
  }
  return fields;
}

TEST(ReportCsv, HasARowOfAllColumnsForEveryPoint) {
  Report report = test::makeSampleReport();
  report.points[0].id = "raster, \"quoted\"";
  report.points[0].errors.psnr = std::numeric_limits<double>::infinity();
  report.points[1].photoErrors.reset();
  std::istringstream csv(reportAsCsv(report));
  std::string line;
  std::getline(csv, line);
  const std::vector<std::string> head = fieldsOf(line);
  EXPECT_EQ(head[0], "id");
  std::vector<std::vector<std::string>> rows;
  while (std::getline(csv, line)) rows.push_back(fieldsOf(line));
  ASSERT_EQ(rows.size(), report.points.size());
  for (const auto& row : rows) EXPECT_EQ(row.size(), head.size());

  const auto at = [&](size_t row, const std::string& name) {
    return rows[row][size_t(std::find(head.begin(), head.end(), name) - head.begin())];
  };
  EXPECT_EQ(at(0, "id"), report.points[0].id);
  EXPECT_EQ(at(0, "psnr"), "inf");
  EXPECT_EQ(at(0, "settings"), "");
  EXPECT_EQ(at(1, "photoPsnr"), "");
  EXPECT_EQ(at(2, "settings"), report.points[2].settings[0].knob + "=" + report.points[2].settings[0].value);
  EXPECT_NEAR(std::stod(at(2, "ms shade")), report.points[2].passes[1].time.median, 1e-8);
  EXPECT_EQ(at(1, "ms shade"), "");  // the walk has no such pass
  size_t chosen = 0;
  for (size_t row = 0; row < rows.size(); ++row) chosen += at(row, "chosen") == "1";
  EXPECT_EQ(chosen, 1u);
}

}  // namespace
}  // namespace froth
