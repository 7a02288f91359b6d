// The id image names the instance and the cell that a pixel shows: against the double reference, and as queries see it.
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "froth/froth_query.h"
#include "reference/camera/view_rays.h"
#include "tests/render/random_foam.h"
#include "tests/render/render_harness.h"
#include "tests/render/split_asset.h"

namespace froth::test {
namespace {

constexpr uint32_t kWidth = 120, kHeight = 90, kUser = 4711;
constexpr uint32_t kLenses = FROTH_LENS_CLASS_MAPPED | FROTH_LENS_CLASS_ORTHOGRAPHIC;
using Id = std::array<uint32_t, 2>;
constexpr Id kNone = {UINT32_MAX, UINT32_MAX};

const Foam& foam() {
  static const Foam made = makeRandomFoam(400, 4, 2, 57);  // in [-1, 1]^3 + (0, 0, 3)
  return made;
}

const AssetContents& contents() {
  static const AssetContents made = splitAsset(bakeForTest(foam()), 5, 0.25);
  return made;
}

FrothContext* context() {
  static FrothContext* const made = createCheckedContext(kLenses);
  return made;
}

FrothInstanceInfo namedPlacement() {
  FrothInstanceInfo placement{};
  placement.userId = kUser;
  return placement;
}

Stage& stage() {
  static Stage* const made = [] {
    auto* opened = new Stage(contents(), {kWidth, kHeight}, context(), 0, kLenses, true);
    opened->place(namedPlacement());
    return opened;
  }();
  return *made;
}

View viewOf(LensKind kind, double pixelsPerUnit) {
  View view = lookAt({0.6, -0.5, 0.3}, {0.05, 0.1, 3}, kWidth, kHeight, 0.5);
  view.lens.kind = kind;
  view.fx = view.fy = pixelsPerUnit;
  return view;
}

// What the id image should hold for each cell of the foam.
std::vector<Id> idsOfCells() {
  std::map<float, uint32_t> codes;  // by radius: random, so that no two are alike
  const uint32_t bits = stage().assetStatus().cellBits;
  for (uint32_t c = 0; c < contents().chunks.size(); ++c) {
    const ChunkContents& chunk = contents().chunks[c];
    for (uint32_t cell = 0; cell < chunk.cellCount; ++cell) codes[chunk.radii[cell]] = c << bits | cell;
  }
  std::vector<Id> ids;
  EXPECT_GT(codes.size(), foam().cellCount / 2) << "only cells that can never be seen are left out of an asset";
  for (const float radius : foam().radii) {
    const auto found = codes.find(radius);
    ids.push_back(found == codes.end() ? kNone : Id{kUser, found->second});
  }
  return ids;
}

// All but a few pixels: along the borders of cells the last place of a float decides.
void expectIdsOfReference(const View& view, const FrothRenderInfo& info, const Image* sceneDistance = nullptr) {
  static const std::vector<Id> idOf = idsOfCells();
  const RenderedImages reference = renderReference(foam(), view, 1e-3, sceneDistance);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame frame = stage().draw(method, info, {view.width, view.height});
    size_t differing = 0, none = 0, thin = 0;
    for (size_t i = 0; i < frame.id.size(); ++i) {
      const uint32_t cell = reference.cells[i];
      differing += frame.id[i] != (cell == UINT32_MAX ? kNone : idOf[cell]);
      none += cell == UINT32_MAX;
      thin += cell != UINT32_MAX && reference.distance.values[i] < 0;
    }
    EXPECT_LE(differing, 2 + frame.id.size() / 1000) << "lens " << static_cast<int>(view.lens.kind);
    EXPECT_GT(none, 0u);
    EXPECT_GT(thin, 0u) << "every ray is stopped or meets nothing";
    EXPECT_LT(none + thin, frame.id.size());
  }
}

TEST(Ids, AreThoseOfTheReferenceForAJitteredPinhole) {
  const View view = viewOf(LensKind::kPinhole, 85);
  FrothRenderInfo info = infoOf(view);
  expectIdsOfReference(view, info);
  View moved = view;
  moved.cx += info.camera.jitter[0] = 0.375f;
  moved.cy += info.camera.jitter[1] = -0.25f;
  expectIdsOfReference(moved, info);
}

TEST(Ids, AreThoseOfTheReferenceForParallelRaysAndAFisheye) {
  for (const auto& [kind, scale] : {std::pair(LensKind::kOrthographic, 32.0), std::pair(LensKind::kFisheye, 60.0)}) {
    const View view = viewOf(kind, scale);
    expectIdsOfReference(view, infoOf(view));
  }
}

// The scene's depth stops rays in mid-cell: the cell there is the last one.
TEST(Ids, BeforeASceneAreTheLastCellThatTheRayMet) {
  const View view = viewOf(LensKind::kFisheye, 60);
  const Image wall{kWidth, kHeight, 1, std::vector<float>(size_t{kWidth} * kHeight, 2.4f)};
  HostImage sceneDepth = *sharedHost().createImage(VK_FORMAT_R32_SFLOAT, {kWidth, kHeight});
  ASSERT_TRUE(sharedHost().writeImage(sceneDepth, wall.values));
  FrothRenderInfo info = infoOf(view);
  info.sceneDepth = sharedHost().describeInput(sceneDepth);
  expectIdsOfReference(view, info, &wall);
  sharedHost().destroyImage(sceneDepth);
}

TEST(Ids, NameTheCellThatAQueryFindsThere) {
  const View view = viewOf(LensKind::kPinhole, 85);
  const Frame frame = stage().draw(Method::kRaster, view);
  const ViewRays rays(view);
  const uint32_t bits = stage().assetStatus().cellBits;
  size_t found = 0, differing = 0;
  for (uint32_t y = 0; y < kHeight; ++y) {
    for (uint32_t x = 0; x < kWidth; ++x) {
      const float t = *frame.distance.pixel(x, y);
      if (std::isinf(t)) continue;
      const glm::dvec3 place = eyeOf(view) + double{t} * rays.ofPixel(x, y)->direction;
      const double point[3] = {place.x, place.y, place.z};
      FrothLocation location{};
      location.structSize = sizeof(location);
      ASSERT_EQ(frothLocate(context(), stage().instance(), point, &location), FROTH_OK);
      const uint32_t code = frame.id[y * kWidth + x][1];
      ++found;
      differing += location.chunk != uint64_t{code} >> bits || location.cell != (code & ((uint64_t{1} << bits) - 1));
    }
  }
  EXPECT_GT(found, kWidth * kHeight / 8);
  EXPECT_LE(differing, found / 200);
}

// Two foams crossing each other: what a query meets first, in both.
TEST(Ids, NameTheInstanceThatAQueryMeetsWhereSeveralOverlap) {
  const Foam second = makeRandomFoam(250, 2, 0, 7);
  Stage other(bakeForTest(second), {kWidth, kHeight}, context(), 0, kLenses, true);
  FrothInstanceInfo placement = placementOf({0.4, 0.1, 0.5}, {0, 0.6f, 0, 0.8f}, 0.75f);
  placement.position[0] -= 2;  // the foam's centre lies at z = 3, turned about the origin
  placement.position[2] += 2;
  placement.userId = 12;
  other.place(placement);
  const View view = viewOf(LensKind::kPinhole, 85);
  const ViewRays rays(view);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    const Frame frame = stage().draw(method, view);
    size_t found[2] = {0, 0}, differing = 0;
    for (uint32_t y = 0; y < kHeight; ++y) {
      for (uint32_t x = 0; x < kWidth; ++x) {
        const glm::dvec3 eye = eyeOf(view), d = rays.ofPixel(x, y)->direction;
        const FrothRay ray{{eye.x, eye.y, eye.z}, {d.x, d.y, d.z}, 0, 0};
        FrothRayHit hit{};
        ASSERT_EQ(frothCastRays(context(), nullptr, &ray, &hit, 1), FROTH_OK);
        if (std::isinf(hit.distance)) continue;
        const bool isOther = hit.instance.index == other.instance().index;
        const uint32_t bits = (isOther ? other : stage()).assetStatus().cellBits;
        const Id expected = {isOther ? 12 : kUser, static_cast<uint32_t>(uint64_t{hit.chunk} << bits | hit.cell)};
        ++found[isOther];
        differing += frame.id[y * kWidth + x] != expected;
      }
    }
    EXPECT_GT(found[0], kWidth * kHeight / 20);
    EXPECT_GT(found[1], kWidth * kHeight / 20);
    EXPECT_LE(differing, (found[0] + found[1]) / 200);
  }
}

TEST(Ids, OfAnEmptyViewAreNone) {
  FrothInstanceInfo away = namedPlacement();
  away.position[0] = 1000;
  stage().place(away);
  for (const Method method : {Method::kRaster, Method::kWalk}) {
    for (const Id& id : stage().draw(method, viewOf(LensKind::kPinhole, 85)).id) ASSERT_EQ(id, kNone);
  }
  stage().place(namedPlacement());
}

}  // namespace
}  // namespace froth::test
