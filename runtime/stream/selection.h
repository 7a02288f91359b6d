// Which groups the views want to be refined, within a budget of bytes, of chunks and of views, and cells that all
// assets share.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "runtime/stream/group_set.h"

namespace froth {

// What lies before it: dot(normal, x) + offset >= 0.
struct SightPlane {
  glm::dvec3 normal{0};
  double offset = 0;
};

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
  // Around what it sees, relative to the position; as they are by default it sees all around.
  std::array<SightPlane, 4> sight{};
};

// Whether a point of the bounds may lie before all planes of the eye. What holds for bounds holds for all that hold
// them, however it is rounded: each step is monotone.
bool sees(const StreamEye& eye, const GroupBounds& bounds);

// How much eyes want a group, and when.
//
// A group that is coarser than another has a greater error, and its bounds hold the other's, so an eye is as near or
// nearer to it, the pixel as small or smaller, and it is seen where the other is: its key and its rank are as great or
// greater. The maximum over eyes keeps that.
struct Wish {
  // The measured error by the size of a pixel at the nearest point of the bounds (format/group_bounds.h), of the eye
  // that wants it most. From 1 on an eye that turned there would see the error: the group is wanted.
  double key = 0;
  // The greatest of the eyes that want it, of those that do not see the bounds kUnseenPart: what is wanted comes in
  // this order.
  double rank = 0;
};
inline constexpr double kUnseenPart = 1.0 / 16;

Wish wishFor(const LevelGraph::Group& group, std::span<const StreamEye> eyes);

// What an asset brings to the selection, and what it gets.
struct AssetDemand {
  const LevelGraph* graph = nullptr;
  std::vector<StreamEye> eyes;
  GroupSet wanted;                // by descending rank
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

// The groups of all assets whose key is 1 or more, by descending rank, up to the first that is not affordable. By the
// above this is a cut of each asset, and depends on eyes and budget alone. Equal ranks: the lower asset, then the lower
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
    double rank = 0;
    GroupId id;
    bool operator<(const Offer& other) const;
  };
  void offer(const AssetDemand& asset, GroupId id);
  void offerFiner(const AssetDemand& asset, GroupId bought);

  std::vector<Offer> heap_;
  std::vector<GroupId> bought_;
};

}  // namespace froth
