#include "baker/bake/left_out.h"

namespace froth {
namespace {

constexpr uint64_t kPairBytes = 8;     // both rows
constexpr uint64_t kLobeBytes = 24;    // axis and colour
constexpr uint64_t kSiteBytes = 16;    // site and radius
constexpr uint64_t kFaceBytes = 20;    // density and orientation
constexpr uint64_t kDetailBytes = 12;  // detail site and height

}  // namespace

std::vector<LeftOut> listLeftOut(const Foam& foam, const AssetContents& contents, const StoredCounts& stored) {
  const BakeStatistics& statistics = contents.statistics;
  const uint64_t details = foam.detailCount, lobesPerCell = foam.lobeColours.size() / foam.cellCount;
  const uint64_t faceBytes = kFaceBytes + details * kDetailBytes + lobesPerCell * kLobeBytes;

  std::vector<LeftOut> list;
  const auto add = [&](const char* what, uint64_t bytes) {
    if (bytes > 0) list.push_back({what, bytes});
  };
  add("hidden cells", statistics.hiddenDropped * (kSiteBytes + faceBytes));
  add("faces and colours of dead and empty cells", (statistics.deadCells + statistics.emptyCells) * faceBytes);
  add("faces and colours of unseen cells", statistics.unseenCulled * faceBytes);
  add("displacement", (stored.live * details - stored.detailHeights) * sizeof(float));
  const uint64_t lobes = stored.live * lobesPerCell;
  if (lobes > stored.lobes) {
    add(contents.lobeCount == 0 ? "view dependence" : "lobes that no direction needs",
        (lobes - stored.lobes) * kLobeBytes);
  }
  if (!contents.hasWalkGraph) add("walk graph", (statistics.walkPairs - statistics.alphaPairs) * kPairBytes);
  return list;
}

}  // namespace froth
