// Eyes that no view has, from which a detail site may be seen too.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "baker/appearance/visibility.h"
#include "foam/foam.h"

namespace froth {

// What a detail site shows in views says how open it lies; that, and how large its face looks, says what it shows from
// an eye where no view is. Each cell has eyes of its own beside the views: together they fill the region, and the
// errors of neighbours differ. Thread-safe.
class RegionEyes {
 public:
  struct Sight {
    uint32_t eye;         // ascending; the same number is the same eye for all detail sites of a cell
    glm::vec3 direction;  // unit, from the eye to the detail site
    double weight;        // > 0, in pixels as those of Visibility
  };

  // Keeps references. `radius`: most distance of an eye from its view's [scene units]
  RegionEyes(const Foam& foam, const Visibility& visibility, float radius);

  // `shown`: the sum of the detail site's weights in the views. Eyes behind the face have no sight of it.
  std::vector<Sight> sightsOf(uint64_t detail, const glm::vec3& position, const FaceFrame<float>& frame,
                              double shown) const;

 private:
  double sumFacing(uint64_t cell, const glm::vec3& position, const FaceFrame<float>& frame) const;

  const Foam& foam_;
  const Visibility& visibility_;
  float radius_;
  uint32_t eyeCount_;  // of a cell
  double leastOpenness_ = 0;
};

}  // namespace froth
