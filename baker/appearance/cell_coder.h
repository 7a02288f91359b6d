// Compresses the colours of one cell: its detail sites together, for where one shows others mostly show too.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/appearance/appearance.h"
#include "baker/appearance/axis_codebook.h"
#include "baker/appearance/detail_coder.h"
#include "baker/appearance/observations.h"

namespace froth {

// A detail site is coded after those of its cell that show less, and makes up for what they get wrong where
// it shows too; then all colours are fitted again, each to what the others left.
class CellCoder {
 public:
  // Keeps references.
  CellCoder(const Foam& foam, const Observer& observer, const AxisCodebook& codebook, const AppearanceOptions& options)
      : foam_(foam), observer_(observer), codebook_(codebook), options_(options) {}

  void append(uint32_t cell, CellAppearance& out) const;
  // Adds the cell's squared error in each view, in the unit of observations' weights.
  void addViewErrors(uint32_t cell, std::span<double> perView) const;

 private:
  struct Detail {
    Observations seen;
    double weight = 0;
    CodedDetail coded;
    std::vector<glm::vec3> misses;  // [observations] shown - wanted
  };

  double lobePrice() const { return double(options_.errorBound) * options_.errorBound; }
  std::vector<Detail> observeCell(uint32_t cell) const;
  uint8_t chooseColourScale(const std::vector<Detail>& details) const;
  // The coarsest lattice of detail sites and heights whose error shows little.
  uint8_t chooseDetailScale(const std::vector<Detail>& details) const;
  // Squared error of a shown colour, per squared step of a lattice of detail sites [radii].
  static double shiftError(const Detail& detail, const glm::dvec3& cellMean);
  static glm::dvec3 meanOf(const std::vector<Detail>& details);
  void codeDetails(uint32_t cell, double step, std::vector<Detail>& details) const;
  // [observations of detail site k] What the errors of `others` (k itself does not count) look like where detail site k
  // shows.
  std::vector<glm::vec3> carriedTo(uint32_t cell, uint32_t k, const std::vector<Detail>& details,
                                   std::span<const uint32_t> others) const;

  const Foam& foam_;
  const Observer& observer_;
  const AxisCodebook& codebook_;
  const AppearanceOptions& options_;
};

}  // namespace froth
