// Drawing, shrinking and searching of cases, with judges whose faults are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "baker/bake/check_foam.h"
#include "measure/stability/case_file.h"
#include "measure/stability/cases/random_case.h"
#include "measure/stability/known_faults.h"
#include "measure/stability/random_search.h"
#include "measure/stability/shrink.h"
#include "reference/camera/view_check.h"
#include "tests/surroundings.h"

namespace froth {
namespace {

// Fails where two cells have the same site.
Result<std::optional<CaseFault>> judgeDuplicates(const StiffCase& stiffCase) {
  const std::vector<glm::vec3>& sites = stiffCase.foam.sites;
  for (size_t i = 0; i < sites.size(); ++i) {
    if (std::find(sites.begin(), sites.begin() + static_cast<ptrdiff_t>(i), sites[i]) == sites.begin() + static_cast<ptrdiff_t>(i)) continue;
    const View& last = stiffCase.views.back();
    return std::optional(CaseFault{"duplicate", "sites coincide", stiffCase.views.size() - 1, last.width - 1, last.height - 1});
  }
  return std::optional<CaseFault>();
}

TEST(RandomCases, AreTheSameForTheSameSeed) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(drawCase(seed).foam.sites, drawCase(seed).foam.sites);
    EXPECT_EQ(drawCase(seed).views[0].worldFromCamera, drawCase(seed).views[0].worldFromCamera);
    EXPECT_NE(drawCase(seed).foam.sites, drawCase(seed + 1).foam.sites);
  }
}

TEST(RandomCases, CanBeBakedAndRendered) {
  for (uint64_t seed = 0; seed < 3000; ++seed) {
    const StiffCase drawn = drawCase(seed);
    const Status foam = checkFoam(drawn.foam);
    ASSERT_TRUE(foam) << seed << ": " << foam.error().message;
    ASSERT_GE(drawn.foam.cellCount, 2u);
    ASSERT_LE(drawn.foam.cellCount, 40u);
    for (const View& view : drawn.views) {
      const Status status = checkView(view, "view");
      ASSERT_TRUE(status) << seed << ": " << status.error().message;
    }
  }
}

TEST(Shrinking, LeavesTwoCellsOfADuplicateAndOnePixel) {
  uint32_t count = 0;
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const StiffCase drawn = drawCase(seed);
    const auto fault = judgeDuplicates(drawn);
    if (!*fault) continue;
    const Result<ShrunkCase> shrunk = shrinkCase(drawn, **fault, judgeDuplicates, 3000);
    ASSERT_TRUE(shrunk);
    const Foam& foam = shrunk->smallest.foam;
    EXPECT_EQ(foam.cellCount, 2u) << seed;
    EXPECT_EQ(foam.detailCount, 1u);
    EXPECT_EQ(foam.lobeCount, 0u);
    EXPECT_TRUE(checkFoam(foam));
    EXPECT_EQ(foam.sites[0], glm::vec3(0));
    EXPECT_EQ(foam.radii[0], 1);
    ASSERT_EQ(shrunk->smallest.views.size(), 1u);
    EXPECT_EQ(shrunk->smallest.views[0].width, 1u);
    EXPECT_EQ(shrunk->smallest.views[0].height, 1u);
    ++count;
  }
  EXPECT_GE(count, 5u);
}

TEST(Shrinking, KeepsThePixelThatFails) {
  StiffCase drawn = drawCase(0);
  drawn.views.resize(1);
  View& view = drawn.views[0];
  view.width = 32, view.height = 24, view.cx = 16, view.cy = 12;
  // The pixel that looks along the ray of pixel (20, 5) of the whole image.
  const auto judge = [](const StiffCase& candidate) -> Result<std::optional<CaseFault>> {
    const View& found = candidate.views[0];
    const double x = 20 - 16 + found.cx, y = 5 - 12 + found.cy;
    if (x < 0 || y < 0 || x >= found.width || y >= found.height) return std::optional<CaseFault>();
    return std::optional(CaseFault{"ray", "seen", 0, static_cast<uint32_t>(x), static_cast<uint32_t>(y)});
  };
  const Result<ShrunkCase> shrunk = shrinkCase(drawn, {"ray", "", 0, 20, 5}, judge, 500);
  ASSERT_TRUE(shrunk);
  EXPECT_EQ(shrunk->smallest.views[0].width, 1u);
  EXPECT_EQ(shrunk->smallest.views[0].height, 1u);
  EXPECT_EQ(shrunk->fault.x, 0u);
}

TEST(Shrinking, EndsAfterItsTries) {
  StiffCase drawn = drawCase(0);
  uint32_t judged = 0;
  const auto judge = [&](const StiffCase&) -> Result<std::optional<CaseFault>> {
    ++judged;
    return std::optional(CaseFault{"other", "", 0, 0, 0});
  };
  const Result<ShrunkCase> shrunk = shrinkCase(drawn, {"fault", "", 0, 0, 0}, judge, 50);
  ASSERT_TRUE(shrunk);
  EXPECT_EQ(judged, 50u);
  EXPECT_EQ(shrunk->smallest.foam.sites, drawn.foam.sites) << "a fault of another kind was taken";
}

// What searches have found, in this folder's found/: `froth stability --search` writes such files.
TEST(FoundCases, HoldOnTheCpu) {
  uint32_t count = 0;
  for (const auto& file : std::filesystem::directory_iterator(test::sourceFolder() / "tests/stability/found")) {
    const Result<StiffCase> found = readCase(file.path());
    ASSERT_TRUE(found) << found.error().message;
    const auto fault = judgeOfReference()(*found);
    ASSERT_TRUE(fault) << found->name << ": " << fault.error().message;
    std::vector<SeenFault> seen;
    if (*fault) seen.push_back({"exact", "float", (*fault)->kind.substr((*fault)->kind.find(": ") + 2), (*fault)->factor, (*fault)->what});
    std::vector<KnownFault> known = found->known;
    std::erase_if(known, [](const KnownFault& one) { return one.renderer != "float"; });
    for (const std::string& line : unexplainedFaults(known, seen)) ADD_FAILURE() << found->name << ": " << line;
    ++count;
  }
  EXPECT_GE(count, 25u);
}

TEST(Search, FindsNamesAndShrinksTheSameFaultsAgain) {
  SearchOptions options;
  options.seconds = 0.5;
  options.mostOfOneKind = 2;
  const Result<SearchResult> first = searchCases(options, judgeDuplicates), second = searchCases(options, judgeDuplicates);
  ASSERT_TRUE(first);
  ASSERT_TRUE(second);
  ASSERT_EQ(first->found.size(), 2u) << "of " << first->tried;
  EXPECT_GE(first->failing, 2u);
  for (size_t i = 0; i < 2; ++i) {
    EXPECT_THAT(first->found[i].shrunk.name, testing::StartsWith("found/duplicate_1_"));
    EXPECT_EQ(first->found[i].shrunk.name, second->found[i].shrunk.name);
    EXPECT_EQ(first->found[i].shrunk.foam.sites, second->found[i].shrunk.foam.sites);
    EXPECT_EQ(first->found[i].shrunk.foam.cellCount, 2u);
  }
}

// A bound that knows of no rounding is a planted fault: floats break it.
TEST(Search, ShrinksARealFaultToAFewCellsThatTheTrueBoundHolds) {
  BoundOptions tooTight;
  tooTight.rounding = 0;
  SearchOptions options;
  options.seconds = 1;
  options.mostOfOneKind = 2;
  const CaseJudge judge = judgeOfReference(tooTight);
  const Result<SearchResult> result = searchCases(options, judge);
  ASSERT_TRUE(result) << result.error().message;
  ASSERT_FALSE(result->found.empty()) << "of " << result->tried;
  for (const FoundCase& found : result->found) {
    EXPECT_LE(found.shrunk.foam.cellCount, 3u);
    EXPECT_EQ(found.fault.kind, "float: over its bound");
    const auto again = judge(found.shrunk), truly = judgeOfReference()(found.shrunk);
    ASSERT_TRUE(again && truly);
    EXPECT_TRUE(*again) << "the shrunk case does not fail";
    EXPECT_FALSE(*truly) << (*truly)->what;
  }
}

TEST(Search, AFoundCaseIsHandedOverAtOnceAndFailsAsAFileToo) {
  const std::filesystem::path path = std::filesystem::temp_directory_path() / "froth_search_found.json";
  SearchOptions options;
  options.seconds = 0.5;
  options.mostOfOneKind = 1;
  uint32_t handedOver = 0;
  options.onFound = [&](const FoundCase& found) {
    ++handedOver;
    return writeCase(path, found.shrunk);
  };
  const Result<SearchResult> result = searchCases(options, judgeDuplicates);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_EQ(handedOver, 1u);
  const Result<StiffCase> read = readCase(path);
  std::filesystem::remove(path);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(read->name, result->found[0].shrunk.name);
  const auto fault = judgeDuplicates(*read);
  EXPECT_TRUE(*fault);

  options.onFound = [](const FoundCase&) -> Status { return makeError(ErrorKind::kIo, "full"); };
  EXPECT_FALSE(searchCases(options, judgeDuplicates));
}

TEST(Search, StopsOnRequest) {
  const Result<SearchResult> result =
      searchCases({}, judgeDuplicates, [](std::string_view, uint64_t, uint64_t) { return false; });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().kind, ErrorKind::kCancelled);
}

}  // namespace
}  // namespace froth
