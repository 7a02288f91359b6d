#include "baker/appearance/appearance.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "foam/detail_colour.h"
#include "format/quantization.h"
#include "tests/reference/scenes.h"

namespace froth {
namespace {

std::vector<View> orbit(int count) {
  std::vector<View> views;
  for (int i = 0; i < count; ++i) {
    views.push_back(lookAt({4 * std::cos(0.4 * i), 0.5 * std::sin(i), 4 * std::sin(0.4 * i)}, {0, 0, 0}, 48, 40, 0.5));
  }
  return views;
}

AppearanceOptions typicalOptions() {
  AppearanceOptions options;
  options.errorBound = 0.03f;
  options.lobeLimit = 8;
  options.codebookSize = 64;
  options.colourStep = 0x1p-7f;
  options.lobeAxisStep = 0x1p-3f;
  return options;
}

// All cells of the coder's foam.
CellAppearance compressCells(const AppearanceCoder& coder, const Foam& foam) {
  std::vector<uint32_t> cells(foam.cellCount);
  std::iota(cells.begin(), cells.end(), 0u);
  return coder.compress(cells);
}

CellAppearance compressAll(const Foam& foam, const Visibility* visibility, const AppearanceOptions& options) {
  const Result<AppearanceCoder> coder = AppearanceCoder::create(foam, visibility, options);
  EXPECT_TRUE(coder);
  return compressCells(*coder, foam);
}

bool isFinite(const std::vector<glm::vec3>& values) {
  for (const glm::vec3& v : values) {
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) return false;
  }
  return true;
}

void expectWellFormed(const Foam& foam, const CellAppearance& coded, const AppearanceOptions& options) {
  const size_t details = size_t{foam.cellCount} * foam.detailCount;
  EXPECT_EQ(coded.cellColours.size(), foam.cellCount);
  EXPECT_EQ(coded.colourScales.size(), foam.cellCount);
  EXPECT_EQ(coded.baseColours.size(), details);
  ASSERT_EQ(coded.lobeCounts.size(), details);
  const size_t lobes = std::accumulate(coded.lobeCounts.begin(), coded.lobeCounts.end(), size_t{0});
  EXPECT_EQ(coded.lobeAxes.size(), lobes);
  EXPECT_EQ(coded.lobeColours.size(), lobes);
  for (uint8_t count : coded.lobeCounts) EXPECT_LE(count, std::min(options.lobeLimit, foam.lobeCount));
  EXPECT_TRUE(isFinite(coded.baseColours) && isFinite(coded.lobeAxes) && isFinite(coded.lobeColours));
  EXPECT_TRUE(std::isfinite(coded.squaredError) && std::isfinite(coded.maxError) && coded.weight > 0);
}

TEST(Appearance, ColoursAndAxesLieOnTheirLattices) {
  const Foam foam = randomFoam(80, 3, 4, 1);
  const auto visibility = measureVisibility(foam, orbit(12), {});
  ASSERT_TRUE(visibility);
  const AppearanceOptions options = typicalOptions();
  const CellAppearance coded = compressAll(foam, &*visibility, options);
  expectWellFormed(foam, coded, options);
  size_t lobe = 0;
  for (size_t site = 0; site < coded.lobeCounts.size(); ++site) {
    const float step = std::ldexp(options.colourStep, coded.colourScales[site / foam.detailCount]);
    const auto expectOnLattice = [&](const glm::vec3& colour) {
      for (int c = 0; c < 3; ++c) EXPECT_EQ(snapToStep(colour[c], step), colour[c]);
    };
    expectOnLattice(coded.baseColours[site]);
    for (int l = 0; l < coded.lobeCounts[site]; ++l, ++lobe) {
      expectOnLattice(coded.lobeColours[lobe]);
      EXPECT_EQ(snapToStep(coded.lobeAxes[lobe].x, 0x1p-5f),
                coded.lobeAxes[lobe].x);  // entries are on a finer lattice
    }
  }
  for (const glm::vec3& colour : coded.cellColours) EXPECT_FLOAT_EQ(std::nearbyint(colour.x * 255) / 255, colour.x);
}

TEST(Appearance, WithoutResidualsEveryAxisIsAnEntry) {
  const Foam foam = randomFoam(80, 3, 4, 1);
  AppearanceOptions options = typicalOptions();
  options.lobeAxisStep = 0;
  const auto coder = AppearanceCoder::create(foam, nullptr, options);
  ASSERT_TRUE(coder);
  const auto& entries = coder->codebook();
  EXPECT_LE(entries.size(), options.codebookSize);
  const std::vector<uint32_t> cells = {3, 1, 70};
  const CellAppearance coded = coder->compress(cells);
  EXPECT_FALSE(coded.lobeAxes.empty());
  for (const glm::vec3& axis : coded.lobeAxes) {
    EXPECT_NE(std::find(entries.begin(), entries.end(), axis), entries.end());
  }
}

// A foam whose colours do not depend on the direction needs no lobes, and keeps colours on the lattice to the
// bit.
TEST(Appearance, ColoursOnTheLatticeComeBackExactly) {
  Foam foam = randomFoam(40, 2, 2, 7);
  for (size_t i = 0; i < foam.lobeColours.size(); i += 2) {
    for (int c = 0; c < 3; ++c) foam.lobeColours[i][c] = snapToStep(foam.lobeColours[i][c] * 0.5f, 0x1p-7f);
    foam.lobeColours[i + 1] = foam.lobeColours[i];
  }
  AppearanceOptions options = typicalOptions();
  options.errorBound = 1e-3f;
  const CellAppearance coded = compressAll(foam, nullptr, options);
  EXPECT_TRUE(coded.lobeAxes.empty());
  for (size_t site = 0; site < coded.baseColours.size(); ++site) {
    EXPECT_EQ(coded.baseColours[site], foam.lobeColours[site * 2]);
  }
  EXPECT_LT(coded.maxError, 1e-6);
}

// Independent of the coder's own measure: directions spread anew over the hemisphere of each face.
TEST(Appearance, ErrorStaysNearTheBoundWithoutCameras) {
  const Foam foam = randomFoam(60, 1, 4, 11);
  AppearanceOptions options = typicalOptions();
  options.codebookSize = 0;
  options.lobeAxisStep = 0x1p-6f;
  const CellAppearance coded = compressAll(foam, nullptr, options);
  EXPECT_LE(std::sqrt(coded.squaredError / coded.weight), options.errorBound);
  const auto colourOf = [](const glm::dvec3& base, std::span<const glm::vec3> axes, std::span<const glm::vec3> colours,
                           const glm::dvec3& d) {
    glm::dvec3 sum(0);
    double weights = 0;
    for (size_t l = 0; l < axes.size(); ++l) {
      const double tau = glm::length(glm::dvec3(axes[l])),
                   weight = std::exp(-glm::length(tau * d - glm::dvec3(axes[l])));
      sum += weight * glm::dvec3(colours[l]);
      weights += weight;
    }
    return glm::max(base + 0.5 + (weights > 0 ? sum / weights : glm::dvec3(0)), 0.0);
  };
  double squared = 0;
  size_t lobe = 0, count = 0;
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    const auto frame = faceFrame<double>(foam.orientations[cell]);
    const uint32_t kept = coded.lobeCounts[cell];
    for (double z = 0.1; z < 1; z += 0.2) {
      for (double angle = 0; angle < 6.2; angle += 0.7) {
        const double s = std::sqrt(1 - z * z);
        const glm::dvec3 d =
            s * std::cos(angle) * frame.tangent + s * std::sin(angle) * frame.bitangent - z * frame.normal;
        const glm::dvec3 miss = colourOf(coded.baseColours[cell], std::span(coded.lobeAxes).subspan(lobe, kept),
                                         std::span(coded.lobeColours).subspan(lobe, kept), d) -
                                colourOf(glm::dvec3(0), std::span(foam.lobeAxes).subspan(cell * 4, 4),
                                         std::span(foam.lobeColours).subspan(cell * 4, 4), d);
        squared += glm::dot(miss, miss) / 3;
        ++count;
      }
    }
    lobe += kept;
  }
  EXPECT_LE(std::sqrt(squared / count), 1.5 * options.errorBound);
}

TEST(Appearance, TighterBoundsKeepMoreLobesAndErrLess) {
  const Foam foam = randomFoam(60, 3, 6, 13);
  const auto visibility = measureVisibility(foam, orbit(12), {});
  ASSERT_TRUE(visibility);
  AppearanceOptions options = typicalOptions();
  options.codebookSize = 0;
  const CellAppearance tight = compressAll(foam, &*visibility, options);
  options.errorBound *= 8;
  const CellAppearance loose = compressAll(foam, &*visibility, options);
  EXPECT_GT(tight.lobeAxes.size(), loose.lobeAxes.size());
  EXPECT_LT(tight.squaredError, loose.squaredError);
}

TEST(Appearance, GroupingAndThreadsDoNotChangeACell) {
  const Foam foam = randomFoam(50, 3, 4, 17);
  const auto visibility = measureVisibility(foam, orbit(8), {});
  ASSERT_TRUE(visibility);
  const auto coder = AppearanceCoder::create(foam, &*visibility, typicalOptions());
  const auto again = AppearanceCoder::create(foam, &*visibility, typicalOptions());
  ASSERT_TRUE(coder && again);
  EXPECT_EQ(coder->codebook(), again->codebook());
  std::vector<uint32_t> cells(foam.cellCount);
  std::iota(cells.begin(), cells.end(), 0u);
  const CellAppearance together = coder->compress(cells);
  std::vector<CellAppearance> single(cells.size());
  tbb::parallel_for(size_t{0}, cells.size(),
                    [&](size_t i) { single[i] = again->compress(std::span(cells).subspan(i, 1)); });
  std::vector<glm::vec3> axes, colours;
  for (const CellAppearance& one : single) {
    axes.insert(axes.end(), one.lobeAxes.begin(), one.lobeAxes.end());
    colours.insert(colours.end(), one.lobeColours.begin(), one.lobeColours.end());
  }
  EXPECT_EQ(axes, together.lobeAxes);
  EXPECT_EQ(colours, together.lobeColours);
}

TEST(Appearance, ExtremeFoamsGiveFiniteColours) {
  for (const uint32_t lobes : {0u, 1u, 3u}) {
    for (const float temperature : {0.0f, 1.0f, 1e4f}) {
      Foam foam = randomFoam(12, lobes + 1, lobes, 19);
      for (glm::vec3& axis : foam.lobeAxes) axis *= temperature;
      const auto visibility = measureVisibility(foam, orbit(2), {});
      ASSERT_TRUE(visibility);
      for (const Visibility* seen : {static_cast<const Visibility*>(nullptr), &*visibility}) {
        SCOPED_TRACE(testing::Message() << lobes << " lobes, temperature " << temperature << (seen ? ", cameras" : ""));
        expectWellFormed(foam, compressAll(foam, seen, typicalOptions()), typicalOptions());
      }
    }
  }
}

TEST(Appearance, CellsThatNoCameraSeesKeepTheirColour) {
  const Foam foam = foamOf(
      {{.site = {0, 0, 0}, .colour = {0.25f, 0.5f, 0.75f}}, {.site = {0, 0, 500}, .colour = {0.75f, 0.25f, 0.5f}}});
  const auto visibility = measureVisibility(foam, std::vector{lookAt({0.1, 0, -6}, {0, 0, 0}, 24, 24, 0.4)}, {});
  ASSERT_TRUE(visibility);
  ASSERT_EQ(visibility->offsets[1], visibility->offsets[2]);  // the second one is seen by none
  const CellAppearance coded = compressAll(foam, &*visibility, typicalOptions());
  EXPECT_LT(glm::distance(coded.cellColours[1], glm::vec3(0.75f, 0.25f, 0.5f)), 0.01f);
  EXPECT_LT(glm::distance(coded.baseColours[1] + 0.5f, glm::vec3(0.75f, 0.25f, 0.5f)), 0.2f);
}

// Merged cells of levels of detail are those of another foam.
struct TwoFoams {
  Foam foam = randomFoam(80, 3, 4, 1), other = randomFoam(60, 3, 4, 2);
  AppearanceCoder coder = *AppearanceCoder::create(foam, nullptr, typicalOptions());

  CellAppearance compressOther(const Visibility* visibility, float weight) const {
    return compressCells(coder.forFoam(other, visibility, weight), other);
  }
};

TEST(Appearance, CellsOfAnotherFoamThatShowLittleKeepFewLobes) {
  const TwoFoams foams;
  const size_t all = foams.compressOther(nullptr, 1).lobeColours.size();
  EXPECT_EQ(compressCells(foams.coder.forFoam(foams.foam, nullptr, 1), foams.foam).lobeColours,
            compressCells(foams.coder, foams.foam).lobeColours);
  EXPECT_LT(foams.compressOther(nullptr, 0.05f).lobeColours.size(), all);
}

// Where a foam is known to show in few views, its colours are those of these views.
TEST(Appearance, CellsOfAnotherFoamLookRightWhereTheyAreSeen) {
  const TwoFoams foams;
  const Foam& other = foams.other;
  const glm::vec3 eye(0, 0, -6);
  Visibility seen;
  seen.eyes = {eye};
  seen.pixels = {400};
  seen.detailsPerRow = 3;
  seen.offsets = {0};
  for (uint32_t cell = 0; cell < other.cellCount; ++cell) {
    seen.views.push_back(0);
    seen.weights.push_back(1);
    seen.offsets.push_back(seen.views.size());
  }
  // The first site's base colour alone, with so small a weight that there are no lobes.
  const auto errorWith = [&](const Visibility* visibility) {
    const CellAppearance coded = foams.compressOther(visibility, 1e-3f);
    EXPECT_TRUE(coded.lobeColours.empty());
    double sum = 0;
    for (uint32_t cell = 0; cell < other.cellCount; ++cell) {
      const glm::vec3 direction = glm::normalize(other.sites[cell] - eye);
      const glm::vec3 shown = detailColour(other, uint64_t{3} * cell, direction);
      sum += glm::distance(coded.baseColours[size_t{3} * cell] + 0.5f, shown);
    }
    return sum;
  };
  EXPECT_LT(errorWith(&seen), 0.6 * errorWith(nullptr));
}

}  // namespace
}  // namespace froth
