// A foam without a part, or with one that it lacks: only that part changes, and a bake sees it.
#include "baker/synth/simplify.h"

#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "baker/synth/synth.h"
#include "reference/image/metrics.h"
#include "reference/render/reference.h"

namespace froth {
namespace {

Foam randomFoam() {
  SynthOptions options;
  options.name = "random";
  options.cellCount = 60;
  return *synthesizeFoam(options);
}

View viewFrom(const glm::dvec3& eye) {
  View view;
  view.width = view.height = 48;
  view.fx = view.fy = 48;
  view.cx = view.cy = 24;
  view.worldFromCamera = {1, 0, 0, eye.x, 0, 1, 0, eye.y, 0, 0, 1, eye.z};
  view.nearRatio = view.nearDepth = 0;
  return view;
}

RenderedImages render(const Foam& foam) {
  ReferenceOptions options;
  options.nearRatio = 0;
  return *ReferenceRenderer(foam).render(viewFrom({0, 0, 0}), options);
}

BakeResult bakeDefault(const Foam& foam) {
  BakeOptions options;
  options.knobs = *presetKnobs("default");
  options.measure = false;
  return *bakeFoam(foam, options);
}

bool keepsHeights(const BakeResult& baked) {
  for (const ChunkContents& chunk : baked.contents.chunks) {
    for (float height : chunk.detailHeights) {
      if (height != 0) return true;
    }
  }
  return false;
}

TEST(Simplify, WithoutViewDependenceLeavesShapeAndMeanColour) {
  const Foam foam = randomFoam(), flat = withoutViewDependence(foam);
  EXPECT_EQ(flat.lobeCount, 1u);
  const RenderedImages before = render(foam), after = render(flat);
  EXPECT_EQ(before.alpha.values, after.alpha.values);
  const ImageDifference difference = *compareImages(before.colour, after.colour);
  EXPECT_GT(difference.maxError, 0.01);  // it showed
  EXPECT_LT(difference.meanError, 0.1);  // and the mean stands for it
  EXPECT_EQ(bakeDefault(flat).contents.lobeCount, 0u);
  EXPECT_GT(bakeDefault(foam).contents.lobeCount, 0u);
}

TEST(Simplify, FlatColoursStayAsTheyAre) {
  const Foam flat = withoutViewDependence(randomFoam());
  EXPECT_LT(compareImages(render(flat).colour, render(withoutViewDependence(flat)).colour)->maxError, 1e-6);
}

TEST(Simplify, WithoutDisplacementFacesArePlain) {
  const Foam foam = randomFoam(), plain = withoutDisplacement(foam);
  EXPECT_TRUE(keepsHeights(bakeDefault(foam)));
  EXPECT_FALSE(keepsHeights(bakeDefault(plain)));
  EXPECT_GT(compareImages(render(foam).alpha, render(plain).alpha)->maxError, 0.01);
}

TEST(Simplify, FewerDetailSitesAreSomeOfTheOldOnes) {
  const Foam foam = randomFoam(), two = withFewerDetailSites(foam, 2);
  ASSERT_EQ(two.detailCount, 2u);
  ASSERT_EQ(two.lobeColours.size(), size_t{foam.cellCount} * 2 * foam.lobeCount);
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    for (uint32_t k = 0; k < 2; ++k) {
      const auto first = foam.detailSites.begin() + cell * foam.detailCount;
      EXPECT_NE(std::find(first, first + foam.detailCount, two.detailSites[cell * 2 + k]), first + foam.detailCount);
    }
  }
}

TEST(Simplify, AllDetailSitesAreTheSameFoam) {
  const Foam foam = randomFoam();
  EXPECT_EQ(render(foam).colour.values, render(withFewerDetailSites(foam, foam.detailCount)).colour.values);
}

TEST(Simplify, WhatIsPutInABakeKeeps) {
  const Foam flat = withoutDisplacement(withFewerDetailSites(withoutViewDependence(randomFoam()), 1));
  EXPECT_EQ(bakeDefault(flat).contents.lobeCount, 0u);
  EXPECT_GT(bakeDefault(withSomeViewDependence(flat)).contents.lobeCount, 0u);
  EXPECT_TRUE(keepsHeights(bakeDefault(withSomeDisplacement(flat))));
  EXPECT_EQ(bakeDefault(flat).contents.detailCount, 1u);
  EXPECT_EQ(bakeDefault(withSomeDetailSites(flat)).contents.detailCount, 2u);
}

}  // namespace
}  // namespace froth
