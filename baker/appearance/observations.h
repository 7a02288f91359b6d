// From where a detail site is seen, and the colour that the input foam shows there: what a fit has to match.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "baker/appearance/visibility.h"
#include "baker/foam.h"

namespace froth {

// One entry per direction.
struct Observations {
  std::vector<glm::vec3> directions;  // unit, from the eye to the detail site
  std::vector<float> weights;         // > 0, in units of a typical detail site
  std::vector<glm::vec3> colours;     // display-coded, 0..1.5

  size_t size() const { return directions.size(); }
};

// Every detail site has some observations: a camera flies where none of the input was, so each one counts a little along
// the hemisphere before its face; and beside each camera that sees it stands one that counts less. Thread-safe.
class Observer {
 public:
  // Keeps references. `visibility` null: the hemisphere alone.
  Observer(const Foam& foam, const Visibility* visibility);

  Observations observe(uint64_t site) const;

 private:
  void addCameras(uint64_t site, const glm::vec3& position, Observations& seen) const;
  void addHemisphere(uint64_t site, const FaceFrame<float>& frame, Observations& seen) const;
  glm::vec3 colourAlong(uint64_t site, const glm::vec3& direction) const;

  const Foam& foam_;
  const Visibility* visibility_;
  std::vector<glm::vec3> eyesBeside_;  // [views]
  double typicalWeight_ = 1;           // mean over the detail sites that are seen [pixels]
};

}  // namespace froth
