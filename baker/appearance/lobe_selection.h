// Which lobes a detail site keeps.
#pragma once

#include <cstdint>
#include <vector>

#include "baker/appearance/lobe_fit.h"

namespace froth {

// Grows a set of lobes one by one: first the one that says most, then the one that lowers the least-squares
// error most.
class LobeSelection {
 public:
  // Keeps references.
  LobeSelection(const Observations& seen, const LobeBasis& basis, const glm::dvec3& base)
      : seen_(seen), basis_(basis), base_(base) {}

  // False: no candidate is left.
  bool grow();
  const std::vector<uint32_t>& chosen() const { return chosen_; }
  double leastError() const { return leastError_; }  // of LobeEquations

 private:
  uint32_t findMostHeard() const;

  const Observations& seen_;
  const LobeBasis& basis_;
  const glm::dvec3 base_;
  std::vector<uint32_t> chosen_;
  double leastError_ = 0;
};

}  // namespace froth
