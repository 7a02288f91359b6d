// Finds lobe axes in a codebook. Part of froth_format_write.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

// What stands for an axis: an entry of the codebook, and the difference to it in steps.
struct AxisCode {
  uint32_t label = 0;
  std::array<int32_t, 3> residual{};
};

class AxisSearch {
 public:
  // `step`: lattice of the differences; 0: axes are entries of the codebook.
  AxisSearch(std::span<const glm::vec3> codebook, float step);

  // The nearest entry from which steps lead exactly to `axis` (of several, the first); none if there is none.
  // Thread-safe.
  std::optional<AxisCode> find(glm::vec3 axis) const;

 private:
  struct Entry {
    glm::vec3 axis;
    uint32_t label;
  };
  std::vector<Entry> entries_;  // ascending x
  float step_;
};

}  // namespace froth
