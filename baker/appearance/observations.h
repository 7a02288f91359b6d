// From where a detail site is seen, and the colour that the input foam shows there: what a fit has to match.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/appearance/region_eyes.h"
#include "baker/appearance/visibility.h"
#include "foam/foam.h"

namespace froth {

// One entry per eye.
struct Observations {
  std::vector<uint32_t> eyes;         // ascending; the same number is the same eye for all detail sites of a cell
  std::vector<glm::vec3> directions;  // unit, from the eye to the detail site
  std::vector<float> weights;         // > 0, in units of a typical detail site
  std::vector<glm::vec3> colours;     // display-coded, 0..1.5

  size_t size() const { return directions.size(); }
};

// Weighted mean colour, and the sum of the weights.
glm::dvec3 meanColour(const Observations& seen);
double totalWeight(const Observations& seen);

// A game's camera flies between the input's cameras and somewhat beyond: around each that sees a detail site
// stand others that count less. And where none of the input was, each detail site counts a little along the
// hemisphere before its face, so every one has some observations. Thread-safe.
class Observer {
 public:
  // Keeps references. `visibility` null: the hemisphere alone. `eyeRadius`: of AppearanceOptions. `viewWeights`: how
  // much an error in each view counts [views] > 0; empty: all alike.
  // `weight`: what a typical detail site weighs.
  Observer(const Foam& foam, const Visibility* visibility, float eyeRadius, std::vector<float> viewWeights = {},
           float weight = 1);

  // The view of whose camera an eye is; nothing for eyes around cameras and in the hemisphere.
  std::optional<uint32_t> viewOfEye(uint32_t eye) const;
  const std::vector<float>& viewWeights() const { return viewWeights_; }
  float viewWeight(uint32_t view) const { return viewWeights_.empty() ? 1.0f : viewWeights_[view]; }

  Observations observe(uint64_t detail) const;
  // How much of where one detail site of a cell shows the other one shows too [0..1] (Visibility::overlaps).
  float overlap(uint32_t cell, uint32_t k, uint32_t l) const;

 private:
  static constexpr uint32_t kEyesAround = 2;

  void addCameras(uint64_t detail, const glm::vec3& position, Observations& seen) const;
  void addRegion(uint64_t detail, const glm::vec3& position, const FaceFrame<float>& frame, Observations& seen) const;
  void addHemisphere(const FaceFrame<float>& frame, Observations& seen) const;

  const Foam& foam_;
  const Visibility* visibility_;
  std::vector<float> viewWeights_;
  std::vector<glm::vec3> hemisphere_;                           // unit; z: against the face's normal
  std::array<std::vector<glm::vec3>, kEyesAround> eyesAround_;  // [views] each
  std::optional<RegionEyes> region_;
  float weight_;              // of a typical detail site
  double typicalWeight_ = 1;  // mean over the detail sites that are seen, by weight_
};

}  // namespace froth
