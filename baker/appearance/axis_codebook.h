// Nearest entries of a codebook of lobe axes, and its training.
//
// Distances are taken between warped axes: a cell's colours depend on exponents -|a| |direction - a / |a||,
// which a change of `a` by one moves by about one; but the sharper a lobe, the narrower the band of
// directions in which an exponent matters.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "base/progress.h"

namespace froth {

glm::vec3 warpAxis(const glm::vec3& axis);
glm::vec3 unwarpAxis(const glm::vec3& warped);

// Each component to the nearest multiple of step; 0: the axis.
glm::vec3 snapAxis(const glm::vec3& axis, float step);

// A k-d tree over the warped entries. Thread-safe.
class AxisCodebook {
 public:
  AxisCodebook() = default;
  explicit AxisCodebook(std::vector<glm::vec3> entries);

  const std::vector<glm::vec3>& entries() const { return entries_; }
  bool isEmpty() const { return entries_.empty(); }
  uint32_t findNearest(const glm::vec3& axis) const;  // equal distances: the lower index; there are entries

 private:
  struct Best {
    float distance;
    uint32_t index;
  };
  void build(uint32_t begin, uint32_t end, uint32_t depth);
  void search(uint32_t begin, uint32_t end, uint32_t depth, const glm::vec3& target, Best& best) const;

  std::vector<glm::vec3> entries_;
  std::vector<glm::vec3> warped_;  // [entries]
  std::vector<uint32_t> order_;    // [entries] tree: the middle of each range splits it
};

// Mini-batch k-means (Sculley 2010) over samples: at most `size` entries, the most used ones first. The same
// samples and seed give the same entries on any number of threads. No samples, or stopped on request: no
// entries.
std::vector<glm::vec3> trainCodebook(std::span<const glm::vec3> samples, uint32_t size, uint64_t seed,
                                     const Progress& progress = {});

}  // namespace froth
