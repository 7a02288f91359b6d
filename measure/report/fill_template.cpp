#include "measure/report/fill_template.h"

#include <cmath>
#include <limits>
#include <map>

#include <fmt/format.h>
#include <kainjow/mustache.hpp>

#include "measure/report/text.h"

namespace froth {
namespace {

using Json = nlohmann::ordered_json;
using kainjow::mustache::data;
using kainjow::mustache::mustache;

std::string bytesOrNone(double bytes) { return bytes == 0 ? "–" : bytesText(bytes); }
std::string timeOrAbsent(double time) { return time == 0 ? "" : shortNumber(time); }
std::string secondsOrNone(double seconds) { return seconds > 0 ? shortNumber(seconds) : "–"; }
std::string similarity(double ssim) { return std::isnan(ssim) ? "–" : fmt::format("{:.5f}", ssim); }

// How a report's figures are written, by the names of report.json.
const std::map<std::string, std::string (*)(double)> kFormats{{"psnr", decibels},
                                                              {"ssim", similarity},
                                                              {"flip", shortNumber},
                                                              {"meanError", shortNumber},
                                                              {"maxError", shortNumber},
                                                              {"overOneStep", percent},
                                                              {"median", timeOrAbsent},
                                                              {"p5", shortNumber},
                                                              {"p95", shortNumber},
                                                              {"diskBytes", bytesOrNone},
                                                              {"residentBytes", bytesOrNone},
                                                              {"drawnBytes", bytesOrNone},
                                                              {"viewBytes", bytesOrNone},
                                                              {"drawnCells", countText},
                                                              {"bakeSeconds", secondsOrNone},
                                                              {"cells", countText},
                                                              {"distanceError", shortNumber}};

double numberOf(const Json& value) {
  if (value.is_number()) return value.get<double>();
  const double infinity = std::numeric_limits<double>::infinity();
  return value == "inf" ? infinity : value == "-inf" ? -infinity : std::numeric_limits<double>::quiet_NaN();
}

// Control characters have no place in markup.
data dataOfText(const std::string& text) {
  std::string kept;
  for (char c : text) {
    if (c == '\n' || c == '\t') c = ' ';
    if (static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) kept += c;
  }
  return kept.empty() ? data(data::type::bool_false) : data(kept);
}

data dataOf(const std::string& name, const Json& value) {
  const auto format = kFormats.find(name);
  if (value.is_object()) {
    kainjow::mustache::object members;
    for (const auto& [member, inside] : value.items()) {
      members[member] = dataOf(member, inside);
      if (inside.is_array()) members[member + "Count"] = dataOf("", inside.empty() ? Json() : Json(inside.size()));
    }
    return data(members);
  }
  if (value.is_array()) {
    kainjow::mustache::list entries;
    for (const Json& entry : value) entries.push_back(dataOf("", entry));
    return data(entries);
  }
  if (format != kFormats.end()) return dataOfText(format->second(numberOf(value)));
  if (value.is_string()) return dataOfText(value.get<std::string>());
  if (value.is_number()) return dataOfText(coordinate(value.get<double>()));
  return data(value == true);
}

}  // namespace

std::string coordinate(double value) {
  std::string text = fmt::format("{:.1f}", value);
  if (text.ends_with(".0")) text.resize(text.size() - 2);
  return text == "-0" ? "0" : text;
}

std::string fillTemplate(const std::string& name, const Json& values) {
  data root = dataOf("", values);
  std::string text;
  for (const auto& [file, content] : allTemplates()) {
    if (file == name) text = content;
    root.set(file, content);
  }
  return mustache(text).render(root);
}

}  // namespace froth
