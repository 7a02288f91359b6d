// The built-in cases are well formed, and hold what their names say.
#include <regex>
#include <set>

#include <gtest/gtest.h>

#include "baker/bake/check_foam.h"
#include "measure/stability/cases/stiff_case.h"
#include "tests/same_bits.h"

namespace froth {
namespace {

TEST(BuiltInCases, HaveNamesOfTheirOwnAndSayWhatTheyAre) {
  std::set<std::string> names;
  for (const StiffCase& stiff : builtInCases()) {
    EXPECT_TRUE(std::regex_match(stiff.name, std::regex("[a-z]+/[a-z0-9_-]+"))) << stiff.name;
    EXPECT_TRUE(names.insert(stiff.name).second) << stiff.name;
    EXPECT_FALSE(stiff.what.empty() || stiff.analysis.empty() || stiff.views.empty()) << stiff.name;
  }
  EXPECT_GT(names.size(), 50u);
}

TEST(BuiltInCases, AreFoamsThatCanBeBakedUnlessTheyGoThroughTheImporter) {
  for (const StiffCase& stiff : builtInCases()) {
    if (stiff.isImported) continue;
    const Status status = checkFoam(stiff.foam);
    EXPECT_TRUE(status) << stiff.name << ": " << status.error().message;
  }
}

TEST(BuiltInCases, AreTheSameOnEveryCall) {
  const std::vector<StiffCase> a = builtInCases(), b = builtInCases();
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].name, b[i].name);
    EXPECT_TRUE(haveSameBits(a[i].foam.sites, b[i].foam.sites)) << a[i].name;
    EXPECT_TRUE(haveSameBits(a[i].foam.lobeColours, b[i].foam.lobeColours)) << a[i].name;
  }
}

}  // namespace
}  // namespace froth
