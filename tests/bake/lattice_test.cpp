// What is snapped lies on its lattice and near the input; what the graph is built on is what a reader will have.
#include <algorithm>
#include <cmath>
#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "baker/graph/graph.h"
#include "tests/bake/random_foam.h"

namespace froth {
namespace {

// The geometry of preset "default"; colours as they are.
BakeOptions geometryOptions() {
  BakeOptions options;
  options.knobs = *presetKnobs("default");
  options.knobs.compressColours = false;
  options.steiner = options.measure = false;
  return options;
}

bool isMultiple(double value, double step) { return std::nearbyint(value / step) == value / step; }

class Lattice : public testing::Test {
 protected:
  Lattice() : foam_(makeMixedFoam()), result_(*bakeFoam(foam_, geometryOptions())) {}

  template <class Visit>
  void forLiveCells(Visit&& visit) const {
    size_t place = 0;
    for (const ChunkContents& chunk : result_.contents.chunks) {
      for (uint32_t cell = 0; cell < chunk.liveCount; ++cell) visit(chunk, cell, result_.sourceCells[place + cell]);
      place += chunk.cellCount;
    }
  }
  double error(const std::string& name) const {
    for (const AttributeError& error : result_.contents.errors) {
      if (error.name == name) return error.max;
    }
    ADD_FAILURE() << name;
    return 0;
  }

  const Foam foam_;
  const BakeResult result_;
};

TEST_F(Lattice, StepsAreTheKnobs) {
  const Quantization& lattices = result_.contents.quantization;
  // The foam is just under 10 wide: its extent over 2^bits, rounded down to a power of two.
  EXPECT_EQ(lattices.positionStep, std::ldexp(8.0, -static_cast<int>(geometryOptions().knobs.positionBits)));
  EXPECT_EQ(lattices.detailSiteStep, std::ldexp(1.0f, -static_cast<int>(geometryOptions().knobs.detailSiteBits)));
}

TEST_F(Lattice, SitesLieOnOneGridForTheScene) {
  const double step = result_.contents.quantization.positionStep;
  for (const ChunkContents& chunk : result_.contents.chunks) {
    for (const double coordinate : chunk.origin) EXPECT_TRUE(isMultiple(coordinate, step));
    for (const glm::vec3& site : chunk.sites) {
      for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(isMultiple(site[axis], step));
    }
  }
  EXPECT_GT(error("sites"), 0);
  EXPECT_LE(error("sites"), 0.5 * std::sqrt(3.0) * step);
}

TEST_F(Lattice, NumbersKeepTheBitsThatTheKnobsAskFor) {
  const Quantization& lattices = result_.contents.quantization;
  forLiveCells([&](const ChunkContents& chunk, uint32_t cell, uint32_t) {
    EXPECT_EQ(chunk.radii[cell], roundMantissa(chunk.radii[cell], lattices.radiusBits));
    EXPECT_EQ(chunk.densities[cell], roundMantissa(chunk.densities[cell], lattices.densityBits));
    for (uint32_t k = 0; k < 2; ++k) {
      EXPECT_TRUE(isMultiple(chunk.detailSites[2 * cell + k].x, lattices.detailSiteStep));
      EXPECT_TRUE(isMultiple(chunk.detailHeights[2 * cell + k], lattices.heightStep));
    }
    EXPECT_TRUE(isMultiple(chunk.cellHeights[cell], lattices.heightStep));
  });
  EXPECT_LE(error("radii"), std::ldexp(0.5, -static_cast<int>(lattices.radiusBits)));
  EXPECT_LE(error("densities"), std::ldexp(0.5, -static_cast<int>(lattices.densityBits)));
  EXPECT_LE(error("detail heights"), 0.5 * lattices.heightStep);
}

// A normal leaves the rotation about it open; detail sites turn with it and stay where they were.
TEST_F(Lattice, DetailSitesStayInPlaceWhileFramesTurn) {
  const Quantization& lattices = result_.contents.quantization;
  double largestTurn = 0;
  forLiveCells([&](const ChunkContents& chunk, uint32_t cell, uint32_t source) {
    const FaceFrame<double> before = faceFrame<double>(foam_.orientations[source]);
    const FaceFrame<double> after = faceFrame<double>(chunk.orientations[cell]);
    largestTurn = std::max(largestTurn, glm::distance(before.tangent, after.tangent));
    const auto distanceTo = [&](const glm::dvec2& a, const glm::dvec2& b) {
      return glm::distance(a.x * before.tangent + a.y * before.bitangent, b.x * after.tangent + b.y * after.bitangent);
    };
    const glm::dvec2 first(chunk.detailSites[2 * cell]), second(chunk.detailSites[2 * cell + 1]);
    EXPECT_LE(first.x, second.x);  // sorted
    for (uint32_t k = 0; k < 2; ++k) {
      const glm::dvec2 a(foam_.detailSites[2 * source + k]);
      EXPECT_LE(std::min(distanceTo(a, first), distanceTo(a, second)),
                std::sqrt(0.5) * lattices.detailSiteStep + error("normals") * glm::length(a) + 1e-6);
    }
  });
  EXPECT_GT(largestTurn, 1);  // frames did turn
  EXPECT_LE(error("normals"), 4.0 / (1 << lattices.normalBits));
}

TEST_F(Lattice, TheGraphIsThatOfTheSnappedSites) {
  // Neighbours are told by sites and radii alone: those of the asset, triangulated again, give its rows.
  const Result<Foam> shown = foamFromAsset(result_.contents);
  ASSERT_TRUE(shown);
  const Result<RegularTriangulation> triangulation = triangulateRegular(shown->sites, shown->radii);
  ASSERT_TRUE(triangulation);
  const ChunkContents& chunk = result_.contents.chunks.at(0);
  ASSERT_EQ(result_.contents.chunks.size(), 1u);
  for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) {
    const std::set<uint32_t> row(chunk.neighbours.begin() + chunk.neighbourOffsets[cell],
                                 chunk.neighbours.begin() + chunk.neighbourOffsets[cell + 1]);
    const CellGraph& graph = triangulation->graph;
    EXPECT_EQ(row, std::set<uint32_t>(graph.neighbours.begin() + graph.offsets[cell],
                                      graph.neighbours.begin() + graph.offsets[cell + 1]));
  }
}

TEST(LatticeFar, SitesFarFromTheOriginStayExact) {
  Foam foam = makeRandomFoam(300, 1, 1, 5);
  for (glm::vec3& site : foam.sites) site += glm::vec3(1e6f, 0, 0);
  BakeOptions options = geometryOptions();
  options.knobs.positionBits = 22;
  options.chunkCells = 64;
  const Result<BakeResult> result = bakeFoam(foam, options);
  ASSERT_TRUE(result) << result.error().message;
  size_t place = 0;
  for (const ChunkContents& chunk : result->contents.chunks) {
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell, ++place) {
      const double x = chunk.origin[0] + chunk.sites[cell].x;
      EXPECT_EQ(x, foam.sites[result->sourceCells[place]].x);  // floats out there are coarser than the grid
    }
  }
}

TEST(LatticeExact, ErrorsOfAnExactBakeAreZero) {
  const Result<BakeResult> result = bakeFoam(makeMixedFoam(), {});
  ASSERT_TRUE(result);
  ASSERT_FALSE(result->contents.errors.empty());
  for (const AttributeError& error : result->contents.errors) {
    EXPECT_EQ(error.rms, 0) << error.name;
    EXPECT_EQ(error.max, 0) << error.name;
  }
}

}  // namespace
}  // namespace froth
