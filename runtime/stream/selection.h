// Which groups the views want to be refined, within a budget of bytes, of chunks and of views, and cells that all
// assets share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "runtime/stream/group_set.h"

namespace froth {

// Who looks at an asset: a view of one of its instances, or a point where a view may soon be. In the asset's frame; an
// asset has an eye for each view and instance.
struct StreamEye {
  glm::dvec3 position{0};  // [scene units]
  double radius = 0;       // the eye may be anywhere this near to the position [scene units]
  // The size of a pixel at distance d is max(pixelSize, pixelAngle * d). Orthographic views have no angle; others may
  // give the size at their nearest distance, so that an eye inside of a group does not want it without bound.
  double pixelAngle = 0;  // [radians]
  double pixelSize = 0;   // [scene units]
  double detail = 1;      // how much finer than measured errors ask for; 0: wants the floor [>= 0]
};

// How much an eye wants a group: its measured error by the size of a pixel at the nearest point of its bounds
// (format/group_bounds.h). From 1 on the eye sees the error.
//
// A group that is coarser than another has a greater error, and its bounds hold the other's, so the eye is as near or
// nearer to it and the pixel as small or smaller: its key is as great or greater. The maximum over eyes keeps that.
double keyOf(const LevelGraph::Group& group, std::span<const StreamEye> eyes);

// What an asset brings to the selection, and what it gets.
struct AssetDemand {
  const LevelGraph* graph = nullptr;
  std::vector<StreamEye> eyes;
  GroupSet wanted;                // by descending key
  uint64_t viewBytesPerCell = 0;  // [bytes] that views need for each live cell that is drawn
};

// What a cut may cost.
struct CutLimits {
  uint64_t bytes = UINT64_MAX;      // of chunks
  uint64_t cells = UINT64_MAX;      // live
  uint64_t viewBytes = UINT64_MAX;  // for the cells
};

struct GroupId {
  uint32_t asset = 0, group = 0;
};

// The groups of all assets by descending key, up to the first that is not affordable or whose key is below 1. By the
// above this is a cut of each asset, and depends on eyes and budget alone. Equal keys: the lower asset, then the lower
// group first. Time: that of a heap of the wanted groups and those next to them, whatever else the assets hold.
class Selection {
 public:
  // Room for as many groups over all assets, so that select() does not allocate.
  void reserve(size_t groupCount);

  // limits: of groups, beside floors. Assets without a graph are left alone.
  void select(std::span<AssetDemand> assets, CutLimits limits);
  std::span<const GroupId> bought() const { return bought_; }  // of all assets, in order

 private:
  struct Offer {
    double key = 0;
    GroupId id;
    bool operator<(const Offer& other) const;
  };
  void offer(const AssetDemand& asset, GroupId id);
  void offerFiner(const AssetDemand& asset, GroupId bought);

  std::vector<Offer> heap_;
  std::vector<GroupId> bought_;
};

}  // namespace froth
