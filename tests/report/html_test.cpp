#include <gtest/gtest.h>

#include <fstream>

#include "tests/report/sample_report.h"

namespace froth::test {
TEST(Html, Slice) {
  const Report report = makeSampleReport();
  std::ofstream("/tmp/lenses_report.html") << reportAsHtml(report);
  std::ofstream("/tmp/lenses_report.json") << reportAsJson(report).dump(1);
  std::ofstream("/tmp/lenses_report.csv") << reportAsCsv(report);
}
}  // namespace froth::test
