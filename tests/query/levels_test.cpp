// Queries on cuts of an asset with levels of detail: what a plain foam of the drawn cells answers, and brute force.
#include <algorithm>
#include <map>

#include "froth/froth_estimate.h"
#include "runtime/context/context.h"
#include "tests/levels/level_cuts.h"
#include "tests/query/first_ball.h"
#include "tests/query/query_fixture.h"
#include "tests/query/reference_rays.h"

namespace froth::test {
namespace {

constexpr int kMostFrames = 200;  // until a cut is drawn
constexpr double kTolerance = 1e-9;

std::vector<std::vector<uint32_t>> cutsToAsk() {
  std::vector<std::vector<uint32_t>> cuts = {floorCut(), finestCut()};
  std::mt19937 random(11);
  for (int i = 0; i < 6; ++i) cuts.push_back(randomCut(random));
  return cuts;
}

std::vector<FrothRay> raysToCast() {
  Random random(21);
  std::vector<FrothRay> rays;
  for (int i = 0; i < 400; ++i) {
    rays.push_back(makeRay(random.inBox(glm::dvec3(-2), glm::dvec3(2)), random.direction()));
  }
  return rays;
}

std::vector<glm::dvec3> pointsToLocate() {
  Random random(22);
  std::vector<glm::dvec3> points;
  for (int i = 0; i < 400; ++i) points.push_back(random.inBox(glm::dvec3(-2), glm::dvec3(2)));
  return points;
}

// An asset without levels: ghosts name cells, and are in their order.
AssetContents plainAssetOf(const std::vector<uint32_t>& cut) {
  AssetContents plain = contentsOf(cut);
  std::map<uint32_t, CellRef> holders;
  for (uint32_t index = 0; index < plain.chunks.size(); ++index) {
    const ChunkContents& chunk = plain.chunks[index];
    for (size_t i = 0; i < chunk.borderCells.size(); ++i) {
      holders[chunk.borderNumbers[i]] = index << plain.localBits | chunk.borderCells[i];
    }
  }
  for (ChunkContents& chunk : plain.chunks) {
    std::map<CellRef, uint32_t> ghosts;  // by the cell's name: the ghost's place before
    for (uint32_t ghost = 0; ghost < chunk.ghostCount; ++ghost) ghosts[holders.at(chunk.ghostRefs[ghost])] = ghost;
    const ChunkContents before = chunk;
    std::vector<uint32_t> places(chunk.ghostCount);
    uint32_t place = 0;
    for (const auto& [ref, ghost] : ghosts) {
      chunk.ghostRefs[place] = ref;
      chunk.sites[chunk.cellCount + place] = before.sites[chunk.cellCount + ghost];
      chunk.radii[chunk.cellCount + place] = before.radii[chunk.cellCount + ghost];
      places[ghost] = place++;
    }
    for (uint32_t& site : chunk.neighbours) {
      if (site >= chunk.cellCount) site = chunk.cellCount + places[site - chunk.cellCount];
    }
    chunk.borderCells.clear();
    chunk.borderNumbers.clear();
  }
  return plain;
}

struct Answers {
  std::vector<FrothRayHit> hits;
  std::vector<FrothLocation> locations;
  std::vector<FrothContact> contacts;
};

class CutQueries : public QueryTest {
 protected:
  FrothAsset openLevels(const AssetContents& contents = levelSample()) {
    if (!context_) createContext();
    bytes_ = *encodeAsset(contents);
    auto info = makeStruct<FrothAssetInfo>();
    info.data = bytes_.data();
    info.dataSize = bytes_.size();
    info.bytesStay = 1;
    info.keepForQueries = 1;
    FrothAsset asset{};
    EXPECT_EQ(frothOpenAsset(context_, &info, &asset), FROTH_OK) << lastText();
    waitFor(asset);
    return asset;
  }
  void waitFor(FrothAsset asset) {
    for (int i = 0; i < kMostFrames && statusOf(asset).state == FROTH_ASSET_OPENING; ++i) frame();
    ASSERT_EQ(statusOf(asset).state, FROTH_ASSET_READY) << lastText();
  }
  void frame() { EXPECT_EQ(update(++serial_), FROTH_OK) << lastText(); }
  std::vector<uint32_t> drawn(FrothAsset asset) const {
    const std::span<const uint32_t> chunks = context_->findAsset(asset)->drawnChunks();
    return {chunks.begin(), chunks.end()};
  }
  bool isIdle(FrothAsset asset) const {
    for (uint32_t chunk = 0; chunk < levelSample().chunks.size(); ++chunk) {
      const SlotState state = context_->findAsset(asset)->chunkState(chunk);
      if (state != SlotState::kAbsent && state != SlotState::kResident) return false;
    }
    return true;
  }
  // And nothing comes or goes any more.
  void show(FrothAsset asset, const std::vector<uint32_t>& cut) {
    context_->setCut(asset, cut);
    for (int i = 0; i < kMostFrames && !(drawn(asset) == cut && isIdle(asset)); ++i) frame();
    ASSERT_EQ(drawn(asset), cut);
    frame();
  }

  static FrothCastInfo wholeRays() {
    auto info = makeStruct<FrothCastInfo>();
    info.cutoff = -1;
    return info;
  }
  // Of an instance that is there for this alone.
  Answers ask(FrothAsset asset) {
    const FrothInstance instance = createInstance(asset);
    Answers answers;
    answers.hits = cast(raysToCast(), wholeRays());
    for (const glm::dvec3& point : pointsToLocate()) {
      answers.locations.push_back(locate(instance, point));
      answers.contacts.push_back(overlap(point, 0.3, 0.05f));
    }
    EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
    return answers;
  }

 private:
  std::vector<uint8_t> bytes_;
};

template <class Place>
void expectSameCell(const Place& found, const Place& plain, const std::vector<uint32_t>& cut) {
  EXPECT_EQ(found.chunk, cut[plain.chunk]);
  EXPECT_EQ(found.cell, plain.cell);
}

TEST_F(CutQueries, AnswerAsAPlainFoamOfTheDrawnCellsDoes) {
  const FrothAsset asset = openLevels();
  size_t stopped = 0, touching = 0;
  for (const std::vector<uint32_t>& cut : cutsToAsk()) {
    show(asset, cut);
    const Answers found = ask(asset), plain = ask(openReady(plainAssetOf(cut)));
    for (size_t i = 0; i < found.hits.size(); ++i) {
      const FrothRayHit &hit = found.hits[i], &other = plain.hits[i];
      EXPECT_NEAR(hit.transmittance, other.transmittance, 1e-6);
      ASSERT_EQ(std::isfinite(hit.distance), std::isfinite(other.distance));
      if (!std::isfinite(hit.distance)) continue;
      ++stopped;
      EXPECT_NEAR(hit.distance, other.distance, kTolerance);
      expectSameCell(hit, other, cut);
    }
    for (size_t i = 0; i < found.locations.size(); ++i) {
      expectSameCell(found.locations[i], plain.locations[i], cut);
      EXPECT_NEAR(found.locations[i].power, plain.locations[i].power, kTolerance);
      const FrothContact &contact = found.contacts[i], &other = plain.contacts[i];
      ASSERT_EQ(contact.isTouching, other.isTouching);
      if (!contact.isTouching) continue;
      ++touching;
      EXPECT_NEAR(contact.depth, other.depth, kTolerance);
      expectSameCell(contact, other, cut);
    }
  }
  EXPECT_GT(stopped, 500u);
  EXPECT_GT(touching, 500u);
}

// The cells that are drawn, without any graph.
struct Mixture {
  explicit Mixture(const std::vector<uint32_t>& drawn) : cut(drawn), foam(*foamFromAsset(contentsOf(drawn))) {}

  double leastPower(const glm::dvec3& point) const { return test::leastPower(foam, point); }
  // By a name of the file; infinite: it is not drawn.
  double powerOf(uint32_t chunk, uint32_t cell, const glm::dvec3& point) const {
    if (!std::ranges::binary_search(cut, chunk)) return kInfinity;
    size_t number = cell;
    for (const uint32_t before : cut) number += before < chunk ? levelSample().chunks[before].cellCount : 0;
    return powerOfCell(foam, number, point);
  }

  const std::vector<uint32_t> cut;
  const Foam foam;
};

TEST_F(CutQueries, AnswerAsBruteForceOverTheDrawnCellsDoes) {
  const FrothAsset asset = openLevels();
  for (const std::vector<uint32_t>& cut : cutsToAsk()) {
    show(asset, cut);
    const Answers found = ask(asset);
    const Mixture mixture(cut);
    const ReferenceRays reference(mixture.foam);
    const std::vector<FrothRay> rays = raysToCast();
    for (size_t i = 0; i < rays.size(); ++i) {
      const FrothRayHit& hit = found.hits[i];
      const auto& [o, d, tMin, tMax] = rays[i];
      const ReferenceHit expected = reference.cast({o[0], o[1], o[2]}, {d[0], d[1], d[2]}, kInfinity, 0.5, 0);
      expectFirstBall(*context_->findAsset(asset)->queryFoam(), cut, {o[0], o[1], o[2]}, {d[0], d[1], d[2]}, 0);
      EXPECT_NEAR(hit.transmittance, expected.transmittance, 1e-6);
      ASSERT_EQ(std::isfinite(hit.distance), expected.distance >= 0);
      if (!std::isfinite(hit.distance)) continue;
      EXPECT_NEAR(hit.distance, expected.distance, kTolerance);
      const glm::dvec3 position(hit.position[0], hit.position[1], hit.position[2]);
      EXPECT_NEAR(mixture.powerOf(hit.chunk, hit.cell, position), mixture.leastPower(position), kTolerance);
    }
    const std::vector<glm::dvec3> points = pointsToLocate();
    for (size_t i = 0; i < points.size(); ++i) {
      const FrothLocation& location = found.locations[i];
      const double least = mixture.leastPower(points[i]);
      EXPECT_NEAR(location.power, least, kTolerance);
      EXPECT_NEAR(mixture.powerOf(location.chunk, location.cell, points[i]), least, kTolerance);
    }
  }
}

TEST_F(CutQueries, FollowTheDrawnCutAndNeverEnd) {
  const FrothAsset asset = openLevels();
  const FrothInstance instance = createInstance(asset);
  const std::vector<glm::dvec3> points = pointsToLocate();
  std::mt19937 random(5);
  size_t changes = 0;
  std::vector<uint32_t> before = drawn(asset);
  for (size_t i = 0; i < 300 && !HasFailure(); ++i) {
    if (random() % 4 == 0) context_->setCut(asset, randomCut(random));
    frame();
    const std::vector<uint32_t> cut = drawn(asset);
    changes += cut != before;
    before = cut;
    cast({raysToCast()[i]});  // expects FROTH_OK
    const FrothLocation location = locate(instance, points[i]);
    EXPECT_NEAR(location.power, Mixture(cut).leastPower(points[i]), kTolerance);
    EXPECT_TRUE(std::ranges::binary_search(cut, location.chunk));
  }
  EXPECT_GT(changes, 20u);
}

TEST_F(CutQueries, FollowAStreamPointWithoutADevice) {
  const FrothAsset asset = openLevels();
  createInstance(asset);
  EXPECT_EQ(drawn(asset), floorCut());
  const FrothStreamPoint point{{0, 0, 0}, 2, 1e-6f, 0};
  auto info = makeStruct<FrothStreamInfo>();
  info.pointCount = 1;
  info.points = &point;
  ASSERT_EQ(frothSetStreaming(context_, &info), FROTH_OK) << lastText();
  for (int i = 0; i < kMostFrames && drawn(asset) != finestCut(); ++i) frame();
  EXPECT_EQ(drawn(asset), finestCut());
}

TEST_F(CutQueries, GiveBackTheMemoryOfEvictedChunks) {
  const FrothAsset asset = openLevels();
  const uint64_t floor = statusOf(asset).hostBytes;
  show(asset, finestCut());
  const uint64_t finest = statusOf(asset).hostBytes;
  show(asset, floorCut());
  EXPECT_EQ(statusOf(asset).hostBytes, floor);
  show(asset, finestCut());
  EXPECT_EQ(statusOf(asset).hostBytes, finest);
  EXPECT_GT(finest, floor + 100 * 100);  // some hundred cells
}

TEST_F(CutQueries, TakeTheHostMemoryThatWasEstimated) {
  const FrothAsset asset = openLevels();
  show(asset, finestCut());
  const std::vector<uint8_t> bytes = *encodeAsset(levelSample());
  auto opened = makeStruct<FrothAssetInfo>();
  opened.data = bytes.data();
  opened.dataSize = bytes.size();
  opened.keepForQueries = 1;
  auto info = makeStruct<FrothEstimateInfo>();
  info.asset = &opened;
  auto estimate = makeStruct<FrothMemoryEstimate>();
  ASSERT_EQ(frothEstimateMemory(&info, &estimate), FROTH_OK);
  EXPECT_EQ(estimate.assetHostBytes, statusOf(asset).hostBytes);
}

TEST_F(CutQueries, AnswerFromTheLastCutUntilTheFloorIsBackAfterADeviceLoss) {
  const FrothAsset asset = openLevels();
  const FrothInstance instance = createInstance(asset);
  show(asset, finestCut());
  const glm::dvec3 point(0.1, -0.2, 0.3);
  const FrothLocation fine = locate(instance, point);
  const uint64_t finest = statusOf(asset).hostBytes;
  ASSERT_EQ(frothDeviceLost(context_), FROTH_OK);
  EXPECT_EQ(locate(instance, point).chunk, fine.chunk);
  FrothContextInfo info = nullContextInfo();
  info.onMessage = logMessage;
  info.messageUser = &messages_;
  ASSERT_EQ(frothRestoreDevice(context_, &info), FROTH_OK) << lastText();
  EXPECT_EQ(locate(instance, point).chunk, fine.chunk);
  waitFor(asset);
  EXPECT_NEAR(locate(instance, point).power, Mixture(drawn(asset)).leastPower(point), kTolerance);
  show(asset, finestCut());
  EXPECT_EQ(locate(instance, point).chunk, fine.chunk);
  EXPECT_EQ(statusOf(asset).hostBytes, finest);
}

TEST_F(CutQueries, EndWithAnAssetThatIsClosedWhileChunksCome) {
  const FrothAsset asset = openLevels();
  const FrothInstance instance = createInstance(asset);
  context_->setCut(asset, finestCut());
  frame();
  EXPECT_EQ(frothDestroyInstance(context_, instance), FROTH_OK);
  EXPECT_EQ(frothCloseAsset(context_, asset), FROTH_OK);
  frame();
  EXPECT_TRUE(std::isinf(cast({raysToCast()[0]})[0].distance));
}

// Borders that name other cells than their ghosts mean, or no cell.
TEST_F(CutQueries, EndInAFileWhoseBordersLie) {
  AssetContents lying = levelSample();
  for (ChunkContents& chunk : lying.chunks) {
    if (chunk.borderNumbers.empty()) continue;
    std::ranges::rotate(chunk.borderNumbers, chunk.borderNumbers.begin() + 1);
    chunk.borderCells.resize(chunk.borderCells.size() * 2 / 3);
    chunk.borderNumbers.resize(chunk.borderCells.size());
  }
  const FrothAsset asset = openLevels(lying);
  for (const std::vector<uint32_t>& cut : cutsToAsk()) {
    show(asset, cut);
    for (const FrothLocation& location : ask(asset).locations) {
      EXPECT_TRUE(std::ranges::binary_search(cut, location.chunk));
    }
  }
}

}  // namespace
}  // namespace froth::test
