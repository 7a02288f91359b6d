// What levels of detail do to pictures: the errors of groups (docs/STREAMING.md "Errors").
//
// Views of the bake are drawn with all cells of level 0, then with all cells of each coarser level. Each pixel's
// squared difference belongs to the chunk that it shows, and to the group that made that chunk.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "baker/lod/front_image.h"
#include "baker/lod/level_chunk.h"
#include "base/progress.h"
#include "base/result.h"
#include "format/group_bounds.h"

namespace froth {

class LevelErrors {
 public:
  // Without views nothing is measured.
  LevelErrors(std::span<const View> views, const FrontOptions& options);

  bool isMeasuring() const { return !views_.empty(); }

  // The cells of level 0; owners are chunks.
  Status takeFinest(const Foam& foam, std::span<const uint32_t> owners, const Progress& progress);
  // All cells as the groups from `firstGroup` on leave them; owners are chunks.
  Status addLevel(const Foam& foam, std::span<const uint32_t> owners, std::span<const LevelChunk> chunks,
                  uint32_t firstGroup, uint32_t groupCount, const Progress& progress);

  // Squared errors, over all views. `owners`: [cells] or kNoOwner.
  struct OwnerErrors {
    std::vector<double> ofOwners;  // of the pixels that show most of each
    double ofAll = 0;              // pixels
  };
  Result<OwnerErrors> sumByOwner(const Foam& foam, std::span<const uint32_t> owners, uint32_t ownerCount,
                                 const Progress& progress) const;

  // Until now errors of groups are the distances between their forms [scene units]; without views they stay, but grow
  // towards the floor. bounds: [groups].
  void finish(std::span<const LevelChunk> chunks, std::span<const GroupBounds> bounds,
              std::vector<LevelGroup>& groups) const;

 private:
  Result<std::vector<FrontImage>> draw(const Foam& foam, std::span<const uint32_t> owners,
                                       const Progress& progress) const;
  // Of a pixel, mean of channels.
  static double squaredError(const FrontImage& image, const FrontImage& finest, size_t pixel);
  void addPixel(size_t view, size_t pixel, const FrontImage& image, std::span<const LevelChunk> chunks,
                uint32_t firstGroup);
  void measureGroups(std::vector<LevelGroup>& groups) const;
  double chooseScale(std::span<const LevelChunk> chunks, std::span<const GroupBounds> bounds,
                     std::span<const LevelGroup> groups) const;

  struct SeenView {
    View view;              // of few pixels
    double pixelScale = 1;  // of the full view's pixels, of those of `view`
    FrontImage finest;
    std::vector<uint32_t> owners;  // [pixels] chunks of the newest level
    std::vector<double> squares;   // [chunks] sum over pixels of the squared difference, mean of channels
    std::vector<double> areas;     // [groups] the same, times the area of a pixel there [scene units squared]
  };
  FrontOptions options_;
  std::vector<SeenView> views_;
};

}  // namespace froth
