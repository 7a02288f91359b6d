// Drawing, shrinking and searching of cases, with judges whose faults are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <set>

#include "baker/bake/check_foam.h"
#include "measure/stability/case_file.h"
#include "measure/stability/cases/case_parts.h"
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
    if (std::find(sites.begin(), sites.begin() + static_cast<ptrdiff_t>(i), sites[i]) ==
        sites.begin() + static_cast<ptrdiff_t>(i)) {
      continue;
    }
    const View& last = stiffCase.views.back();
    return std::optional(
        CaseFault{"duplicate", "sites coincide", stiffCase.views.size() - 1, last.width - 1, last.height - 1});
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

TEST(RandomCases, PartsAreTheSameForTheSameSeed) {
  for (uint64_t seed = 0; seed < 300; ++seed) {
    const StiffCase one = drawCase(seed), other = drawCase(seed);
    EXPECT_EQ(one.places, other.places);
    EXPECT_EQ(one.jitter, other.jitter);
    EXPECT_EQ(one.layers, other.layers);
    EXPECT_EQ(one.chunkCells, other.chunkCells);
    ASSERT_EQ(one.ends.size(), other.ends.size());
    for (size_t i = 0; i < one.ends.size(); ++i) EXPECT_EQ(one.ends[i].values, other.ends[i].values);
  }
}

// How many of the first cases have it.
uint32_t countOf(const std::function<bool(const StiffCase&)>& hasIt) {
  uint32_t count = 0;
  for (uint64_t seed = 0; seed < 1000; ++seed) count += hasIt(drawCase(seed));
  return count;
}

bool hasEnd(const StiffCase& stiff, const std::function<bool(float)>& isSuch) {
  return std::ranges::any_of(stiff.ends, [&](const Image& image) { return std::ranges::any_of(image.values, isSuch); });
}

TEST(RandomCases, HaveEachPartNowAndThenAndMostlyNone) {
  for (const size_t places : {2, 3, 4}) {
    EXPECT_GE(countOf([&](const StiffCase& stiff) { return stiff.places.size() == places; }), 20u)
        << places << " instances";
  }
  EXPECT_GE(
      countOf([](const StiffCase& stiff) { return stiff.places.size() > 1 && stiff.places[0] == stiff.places[1]; }),
      20u)
      << "coinciding";
  EXPECT_GE(countOf([](const StiffCase& stiff) { return stiff.places.size() > 1 && stiff.places[1].rotation.w != 1; }),
            20u)
      << "turned";
  EXPECT_GE(countOf([](const StiffCase& stiff) { return stiff.places.size() > 1 && stiff.places[1].scale != 1; }), 20u)
      << "scaled";
  EXPECT_GE(countOf([](const StiffCase& stiff) { return hasEnd(stiff, [](float end) { return end == 0; }); }), 20u)
      << "at once";
  EXPECT_GE(countOf([](const StiffCase& stiff) { return hasEnd(stiff, [](float end) { return end < 0; }); }), 20u)
      << "behind the eye";
  EXPECT_GE(countOf([](const StiffCase& stiff) { return hasEnd(stiff, [](float end) { return std::isinf(end); }); }),
            20u)
      << "never";
  EXPECT_GE(countOf([](const StiffCase& stiff) {
              return hasEnd(stiff, [](float end) { return end > 0 && !std::isinf(end); });
            }),
            80u);
  EXPECT_GE(countOf([](const StiffCase& stiff) { return stiff.jitter != glm::vec2(0); }), 20u);
  for (const uint32_t layers : {1u, 2u}) {
    EXPECT_GE(countOf([&](const StiffCase& stiff) { return stiff.layers == layers; }), 20u) << layers;
  }
  EXPECT_GE(
      countOf([](const StiffCase& stiff) { return stiff.chunkCells > 0 && stiff.chunkCells < stiff.foam.cellCount; }),
      20u);
  const uint32_t plain = countOf([](const StiffCase& stiff) {
    return stiff.places.empty() && stiff.ends.empty() && stiff.jitter == glm::vec2(0) &&
           stiff.layers == kAllLayersOfCase && stiff.chunkCells == 0;
  });
  EXPECT_GE(plain, 500u);
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
    EXPECT_FALSE(hasEnd(drawn, [](float end) {
      return std::isnan(end) || end == -std::numeric_limits<float>::infinity();
    })) << seed;
    for (const CasePlace& place : drawn.places) {
      EXPECT_NEAR(glm::length(place.rotation), 1, 1e-6) << seed;
      EXPECT_GT(place.scale, 0) << seed;
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

// A case with all that a case may have beside foam and views.
StiffCase caseWithParts() {
  const View view = caseView({0, 0, -3}, {0, 0, 0});
  StiffCase stiff{"", "", "", drawCase(0).foam, {view, view}};
  stiff.places = {{},
                  {{0.123456, 1, 2}, glm::normalize(glm::quat(0.9f, 0.1f, 0.35f, -0.1f)), 0.7654f},
                  {{3, 0, 0}, {0, 0, 1, 0}, 2}};
  for (const float first : {0.0f, 100.0f}) {
    stiff.ends.push_back({32, 24, 1, {}});
    for (uint32_t i = 0; i < 32 * 24; ++i) stiff.ends.back().values.push_back(first + static_cast<float>(i) + 0.125f);
  }
  stiff.jitter = {0.25f, -3};
  stiff.layers = 1;
  stiff.chunkCells = 2;
  return stiff;
}

// Shrunk by a judge that finds a fault in the last view's pixel (20, 5) of whatever `fails`.
StiffCase shrinkParts(const std::function<bool(const StiffCase&)>& fails) {
  const auto judge = [&](const StiffCase& stiff) -> Result<std::optional<CaseFault>> {
    const View& view = stiff.views.back();
    const CaseFault fault{"part", "", stiff.views.size() - 1, static_cast<uint32_t>(20 - 16 + view.cx),
                          static_cast<uint32_t>(5 - 12 + view.cy)};
    const bool isSeen = 4 + view.cx >= 0 && -7 + view.cy >= 0 && fault.x < view.width && fault.y < view.height;
    return isSeen && fails(stiff) ? std::optional(fault) : std::nullopt;
  };
  Result<ShrunkCase> shrunk = shrinkCase(caseWithParts(), {"part", "", 1, 20, 5}, judge, 3000);
  EXPECT_TRUE(shrunk);
  return shrunk ? std::move(shrunk->smallest) : StiffCase();
}

TEST(Shrinking, DropsPartsThatAFaultDoesNotNeed) {
  const StiffCase smallest = shrinkParts([](const StiffCase&) { return true; });
  EXPECT_TRUE(smallest.places.empty());
  EXPECT_TRUE(smallest.ends.empty());
  EXPECT_EQ(smallest.jitter, glm::vec2(0));
  EXPECT_EQ(smallest.layers, kAllLayersOfCase);
  EXPECT_EQ(smallest.chunkCells, 0u);
}

TEST(Shrinking, KeepsPartsThatAFaultNeeds) {
  EXPECT_EQ(shrinkParts([](const StiffCase& stiff) { return stiff.jitter == glm::vec2(0.25f, -3); }).jitter,
            glm::vec2(0.25f, -3));
  EXPECT_EQ(shrinkParts([](const StiffCase& stiff) { return stiff.layers == 1; }).layers, 1u);
  EXPECT_EQ(shrinkParts([](const StiffCase& stiff) { return stiff.chunkCells == 2; }).chunkCells, 2u);
}

TEST(Shrinking, KeepsTheInstancesThatAFaultNeedsAndMakesThemPlain) {
  const auto hasScaled = [](const StiffCase& stiff) {
    return std::ranges::any_of(stiff.places, [](const CasePlace& place) { return place.scale == 0.7654f; });
  };
  const StiffCase one = shrinkParts(hasScaled);
  ASSERT_EQ(one.places.size(), 1u);
  EXPECT_EQ(one.places[0], (CasePlace{{0, 0, 0}, {1, 0, 0, 0}, 0.7654f}));
  const StiffCase two = shrinkParts([](const StiffCase& stiff) { return stiff.places.size() >= 2; });
  EXPECT_EQ(two.places, std::vector<CasePlace>(2));
}

// Of the view that fails, and of the pixel that does: value 5 * 32 + 20 of the second image.
TEST(Shrinking, KeepsTheEndOfTheRayThatFails) {
  const StiffCase smallest = shrinkParts([](const StiffCase& stiff) {
    const View& view = stiff.views.back();
    const auto x = static_cast<uint32_t>(4 + view.cx), y = static_cast<uint32_t>(-7 + view.cy);
    return !stiff.ends.empty() && stiff.ends.back().width == view.width &&
           *stiff.ends.back().pixel(x, y) == 100 + 5 * 32 + 20 + 0.125f;
  });
  ASSERT_EQ(smallest.ends.size(), 1u);
  EXPECT_EQ(smallest.views.size(), 1u);
  EXPECT_EQ(smallest.ends[0].width, 1u);
  EXPECT_EQ(smallest.ends[0].height, 1u);
  EXPECT_EQ(smallest.ends[0].values, std::vector<float>{280.125f});
  const StiffCase any =
      shrinkParts([](const StiffCase& stiff) { return !stiff.ends.empty() && stiff.ends.back().values[0] > 0; });
  EXPECT_EQ(any.ends[0].values, std::vector<float>{1});
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

// A bound that knows of no rounding is a planted fault: floats break it wherever something is drawn.
BoundOptions tooTight() {
  BoundOptions bound;
  bound.rounding = 0;
  bound.cells = 0;
  return bound;
}

StiffCase cloudCase() { return {"", "", "", foamOfCells(cloud(40, 3)), outsideViews()}; }

TEST(Judge, OfTheReferenceEndsRaysWhereTheCaseDoes) {
  StiffCase stiff = cloudCase();
  const auto open = judgeOfReference(tooTight())(stiff);
  ASSERT_TRUE(open);
  EXPECT_TRUE(*open);
  for (const View& view : stiff.views) {
    stiff.ends.push_back({view.width, view.height, 1, std::vector<float>(size_t{view.width} * view.height)});
  }
  const auto ended = judgeOfReference(tooTight())(stiff);
  ASSERT_TRUE(ended);
  EXPECT_FALSE(*ended) << "rays that end at once show nothing: " << (*ended)->what;
}

// It has no float image of them. A distance of the second instance is beyond the floats, so the double image is not
// finite.
TEST(Judge, OfTheReferenceHoldsSeveralInstancesToFiniteNumbersAlone) {
  StiffCase stiff = cloudCase();
  stiff.places.resize(2);
  const auto within = judgeOfReference(tooTight())(stiff);
  ASSERT_TRUE(within);
  EXPECT_FALSE(*within) << (*within)->what;
  stiff.places[0] = stiff.places[1] = {{0, 0, -1e39}, {1, 0, 0, 0}, 3e38f};
  stiff.views = {caseView({0, 0, -3}, {0, 0, -4}), caseView({0, 0, -3e39}, {0, 0, 0})};
  const auto beyond = judgeOfReference()(stiff);
  ASSERT_TRUE(beyond);
  ASSERT_TRUE(*beyond);
  EXPECT_EQ((*beyond)->kind, "double: not finite");
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
    if (*fault) {
      seen.push_back(
          {"exact", "float", (*fault)->kind.substr((*fault)->kind.find(": ") + 2), (*fault)->factor, (*fault)->what});
    }
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
  const Result<SearchResult> first = searchCases(options, judgeDuplicates),
                             second = searchCases(options, judgeDuplicates);
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

TEST(Search, ShrinksARealFaultToAFewCellsThatTheTrueBoundHolds) {
  SearchOptions options;
  options.seconds = 1;
  options.mostOfOneKind = 2;
  const CaseJudge judge = judgeOfReference(tooTight());
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
