#include <cmath>

#include <gtest/gtest.h>

#include "baker/bake/bake.h"
#include "baker/synth/synth.h"
#include "reference/image/metrics.h"
#include "reference/render/reference.h"
#include "tests/synth/foam_checks.h"

namespace froth {
namespace {

using glm::dmat3;
using glm::dvec3;

View frontView() {
  View view;
  view.width = view.height = 40;
  view.fx = view.fy = 40;
  view.cx = view.cy = 20;
  view.worldFromCamera = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -1};
  view.nearRatio = 0;
  return view;
}

Foam copyOf(const Foam& tiled, uint32_t copy, uint32_t cells) {
  Foam one = tiled;
  const uint64_t details = uint64_t{cells} * tiled.detailCount, firstDetail = copy * details;
  const uint64_t firstLobe = lobesOf(tiled, firstDetail).first;
  const LobeRange lastLobes = lobesOf(tiled, firstDetail + details - 1);
  one.cellCount = cells;
  visitArrays([&](const FoamArray& array, auto values) {
    if ((tiled.*values).empty()) return;
    LobeRange range{uint64_t{copy} * cells, cells};
    if (array.index == FoamIndex::kDetailSite) range = {firstDetail, static_cast<uint32_t>(details)};
    if (array.index == FoamIndex::kLobe) {
      range = {firstLobe, static_cast<uint32_t>(lastLobes.first + lastLobes.count - firstLobe)};
    }
    const auto begin = (tiled.*values).begin() + static_cast<std::ptrdiff_t>(range.first);
    one.*values = {begin, begin + range.count};
  });
  if (tiled.lobeOffsets.empty()) return one;
  const auto begin = tiled.lobeOffsets.begin() + static_cast<std::ptrdiff_t>(firstDetail);
  one.lobeOffsets = {begin, begin + static_cast<std::ptrdiff_t>(details + 1)};
  for (uint64_t& offset : one.lobeOffsets) offset -= firstLobe;
  return one;
}

// The rigid motion that takes cell i's frame and site of `a` to those of `b`.
struct Motion {
  dmat3 turn;
  dvec3 move;
};

dmat3 frameOf(const Foam& foam, size_t i) {
  const FaceFrame<double> frame = faceFrame<double>(foam.orientations[i]);
  return {frame.normal, frame.tangent, frame.bitangent};
}

Motion motionBetween(const Foam& a, const Foam& b, size_t i) {
  const dmat3 turn = frameOf(b, i) * glm::transpose(frameOf(a, i));
  return {turn, dvec3(b.sites[i]) - turn * dvec3(a.sites[i])};
}

TEST(TileFoam, KeepsTheFirstCopyAsItIs) {
  const Foam foam = *synthesizeFoam({"random", 60});
  const Foam tiled = *tileFoam(foam, 5);
  EXPECT_EQ(tiled.cellCount, 300u);
  expectSound(tiled);
  EXPECT_TRUE(haveSameBits(copyOf(tiled, 0, 60), foam));
}

// As an asset holds it: with base colours and a number of lobes for each detail site, if colours are compressed.
Foam bakedFoam(const char* preset) {
  BakeOptions options;
  options.knobs = *presetKnobs(preset);
  options.measure = false;
  return *foamFromAsset(bakeFoam(*synthesizeFoam({"random", 60}), options)->contents);
}

TEST(TileFoam, AnAssetOfAnyPresetHasTheSameCellsInEachCopy) {
  for (const char* preset : {"exact", "high", "default", "small"}) {
    const Foam foam = bakedFoam(preset);
    const Foam tiled = *tileFoam(foam, 3);
    EXPECT_EQ(tiled.baseColours.empty(), foam.baseColours.empty());
    EXPECT_TRUE(haveSameBits(copyOf(tiled, 0, foam.cellCount), foam)) << preset;
    // A copy with the places and directions of the original is the original.
    Foam copy = copyOf(tiled, 2, foam.cellCount);
    const dmat3 turn = motionBetween(foam, copy, 0).turn;
    ASSERT_EQ(copy.lobeAxes.size(), foam.lobeAxes.size()) << preset;
    for (size_t m = 0; m < foam.lobeAxes.size(); ++m) {
      ASSERT_LT(glm::distance(dvec3(copy.lobeAxes[m]), turn * dvec3(foam.lobeAxes[m])),
                1e-5 * (1 + glm::length(foam.lobeAxes[m])));
    }
    copy.sites = foam.sites;
    copy.orientations = foam.orientations;
    copy.lobeAxes = foam.lobeAxes;
    EXPECT_TRUE(haveSameBits(copy, foam)) << preset;
  }
}

TEST(TileFoam, CopiesDoNotTouch) {
  const Foam tiled = *tileFoam(*synthesizeFoam({"random", 60}), 9);
  for (uint32_t i = 0; i < tiled.cellCount; ++i) {
    for (uint32_t j = 0; j < i - i % 60; ++j) {
      ASSERT_GT(glm::distance(tiled.sites[i], tiled.sites[j]), tiled.radii[i] + tiled.radii[j]) << i << ", " << j;
    }
  }
}

TEST(TileFoam, EveryCopyIsTurnedByItsOwnAngle) {
  const Foam foam = *synthesizeFoam({"random", 20});
  const Foam tiled = *tileFoam(foam, 4);
  std::vector<double> angles;
  for (uint32_t copy = 0; copy < 4; ++copy) {
    const dmat3 turn = motionBetween(foam, copyOf(tiled, copy, 20), 0).turn;
    angles.push_back(std::atan2(turn[0].y, turn[0].x));
  }
  for (size_t a = 0; a < 4; ++a) {
    for (size_t b = 0; b < a; ++b) EXPECT_GT(std::abs(angles[a] - angles[b]), 0.1);
  }
}

TEST(TileFoam, ACopySeenByACameraMovedAlongLooksLikeTheOriginal) {
  const Foam foam = *synthesizeFoam({"random", 200});
  const Foam copy = copyOf(*tileFoam(foam, 3), 2, 200);
  const Motion motion = motionBetween(foam, copy, 0);
  const View view = frontView();
  View moved = view;
  auto& m = moved.worldFromCamera;
  const dmat3 axes = motion.turn * dmat3(dvec3(1, 0, 0), dvec3(0, 1, 0), dvec3(0, 0, 1));
  const dvec3 eye = motion.turn * dvec3(0, 0, -1) + motion.move;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m[static_cast<size_t>(4 * row + column)] = axes[column][row];
    m[static_cast<size_t>(4 * row + 3)] = eye[row];
  }
  ReferenceOptions options;
  options.nearRatio = 0;
  const auto original = ReferenceRenderer(foam).render(view, options);
  const auto turned = ReferenceRenderer(copy).render(moved, options);
  ASSERT_TRUE(original && turned);
  const auto difference = compareImages(original->colour, turned->colour);
  ASSERT_TRUE(difference);
  // Sites and frames of the copy are rounded to float, which may move an edge across a pixel's ray.
  EXPECT_GT(difference->psnr, 60);
}

TEST(TileFoam, RefusesNoCopiesAndTooMany) {
  const Foam foam = *synthesizeFoam({"random", 1000});
  for (const uint32_t count : {0u, 4294968u}) {
    const auto tiled = tileFoam(foam, count);
    ASSERT_FALSE(tiled);
    EXPECT_EQ(tiled.error().kind, ErrorKind::kUsage);
  }
}

}  // namespace
}  // namespace froth
