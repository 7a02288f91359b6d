// Compresses the colours of one detail site.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/appearance/appearance.h"
#include "baker/appearance/axis_codebook.h"
#include "baker/appearance/lobe_fit.h"

namespace froth {

// A detail site as it is stored.
struct CodedDetail {
  glm::dvec3 base{0};               // display-coded offset from one half
  std::vector<glm::vec3> axes;      // ascending by codebook entry
  std::vector<glm::dvec3> colours;  // offsets from the base
  FitError error;
};

class DetailCoder {
 public:
  // Keeps references. `price`: the squared error, in the units of FitError, that a lobe has to take away.
  DetailCoder(const AppearanceOptions& options, const AxisCodebook& codebook, double price)
      : options_(options), codebook_(codebook), price_(price) {}

  // `axes`: the lobes of the input. Colours become multiples of `step` [0: any].
  CodedDetail code(const Observations& seen, std::span<const glm::vec3> axes, double step) const;

  // The best colours for the axes that a detail site has.
  void refit(const Observations& seen, double step, CodedDetail& detail) const;

 private:
  enum class AxisChoice { kEntries, kResiduals };

  std::vector<glm::vec3> candidates(std::span<const glm::vec3> axes, AxisChoice choice) const;
  // Replaces `best` where it finds less than `least`: squared error + price of the lobes.
  void tryLobes(const Observations& seen, std::span<const glm::vec3> axes, AxisChoice choice, double price, double step,
                CodedDetail& best, double& least) const;

  const AppearanceOptions& options_;
  const AxisCodebook& codebook_;
  double price_;
};

}  // namespace froth
