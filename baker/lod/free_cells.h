// The cells that a fit changes, and how they descend: Adam (trainer/step/adam.h). Internal to baker/lod.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "foam/foam.h"
#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_storage.h"

namespace froth {

class FreeCells {
 public:
  // `isFree`: [cells]. Keeps a reference to the storage.
  FreeCells(FoamStorage<float>& storage, std::span<const uint8_t> isFree);

  // After step.differentiate(). `rate`: what all rates are multiplied by. Cells that the view does not show stay.
  void update(CpuStep<float>& step, float rate);
  // What has changed, into the foam that the storage was made of.
  void write(Foam& foam) const;

 private:
  struct Moments {
    float first = 0, second = 0;
  };
  class Descent;
  void updateCell(const SeenCell<float>& seen, const SeenDetail<float>* shown, const CellSums<float>& sums,
                  const DetailSums<float>* details, float rate);
  void moveDetails(const SeenCell<float>& seen, const SeenDetail<float>* shown, const DetailSums<float>* details,
                   Descent& descent);
  // A detail site: place, height and colour.
  size_t momentsOfCell() const { return kMomentsOfFace + 6 * size_t{foam_.shape.detailCount}; }
  static constexpr size_t kMomentsOfFace = 5;  // density, quaternion
  static constexpr uint32_t kNotFree = UINT32_MAX;

  TrainedFoam<float> foam_;
  bool hasHeights_ = false;       // a foam without gets none
  std::vector<uint32_t> rows_;    // [cells] in what follows, or kNotFree
  std::vector<uint32_t> steps_;   // [free cells] how many have moved it
  std::vector<float> densities_;  // [free cells] at first
  std::vector<Moments> moments_;  // [free cells * momentsOfCell()]
};

}  // namespace froth
