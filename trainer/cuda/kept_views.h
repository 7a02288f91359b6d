// What the views of a step ask of the cells (trainer/step/view_gradients.h) in the memory of a GPU: a block of bytes
// for each, one after another, so that GPUs send each other blocks.
#pragma once

#include "trainer/loop/schedule.h"
#include "trainer/step/view_gradients.h"

namespace froth {

// The first bytes of a block; cells and detail sites follow.
struct alignas(16) KeptHeader {
  uint32_t isVoid = 0;  // the lists of the view did not fit: the step changes nothing, on any GPU
};

inline size_t bytesOfKeptView(const FoamShape& shape) {
  const size_t perCell = sizeof(KeptCell<float>) + shape.detailCount * sizeof(DetailSums<float>);
  return (sizeof(KeptHeader) + shape.cellCount * perCell + alignof(KeptHeader) - 1) / alignof(KeptHeader) *
         alignof(KeptHeader);
}

struct KeptView {
  KeptHeader* header;
  ViewGradients<float> gradients;
};

inline KeptView keptViewAt(uint8_t* block, const FoamShape& shape, const glm::vec3& eye) {
  auto* cells = reinterpret_cast<KeptCell<float>*>(block + sizeof(KeptHeader));
  return {reinterpret_cast<KeptHeader*>(block),
          {eye, cells, reinterpret_cast<DetailSums<float>*>(cells + shape.cellCount)}};
}

// All of a step: what kernels get.
struct KeptViews {
  uint32_t count = 0;
  const KeptHeader* headers[kMostPhotosPerStep];
  ViewGradients<float> gradients[kMostPhotosPerStep];
};

}  // namespace froth
