// The arrays of a foam in training, in host memory.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "trainer/step/trained_foam.h"

namespace froth {

template <class Real>
struct FoamStorage {
  using Tensors = std::array<std::vector<Real>, kParameterCount>;  // by Parameter

  FoamShape shape;
  Tensors values;
  Tensors firstMoments, secondMoments;  // empty: the foam is drawn and differentiated, and no step of Adam changes it
  std::vector<uint32_t> lastSteps;
  std::vector<glm::vec<4, Real>> balls;
  std::vector<Real> contributions, errors;
  Tensors meanValues;          // of values after averaged steps (trainer/step/running_mean.h); empty: of none yet
  uint32_t averagedSteps = 0;  // how many
};

// Moments are two thirds of what a foam in training takes.
enum class AdamMoments { kKept, kNone };

// Sets the shape and all lengths but those of mean values; what is new is 0.
template <class Real>
void resizeStorage(FoamStorage<Real>& foam, const FoamShape& shape, AdamMoments moments = AdamMoments::kKept) {
  foam.shape = shape;
  for (size_t i = 0; i < kParameterCount; ++i) {
    const size_t length = size_t{shape.cellCount} * widthOf(static_cast<Parameter>(i), shape);
    foam.values[i].resize(length);
    for (auto* tensors : {&foam.firstMoments, &foam.secondMoments}) {
      (*tensors)[i].resize(moments == AdamMoments::kKept ? length : 0);
    }
  }
  foam.lastSteps.resize(shape.cellCount);
  foam.balls.resize(shape.cellCount);
  foam.contributions.resize(shape.cellCount);
  foam.errors.resize(shape.cellCount);
}

template <class Real>
ParameterRows<Real> rowsOf(typename FoamStorage<Real>::Tensors& tensors) {
  ParameterRows<Real> rows;
  for (size_t i = 0; i < kParameterCount; ++i) rows.tensors[i] = tensors[i].data();
  return rows;
}

template <class Real>
TrainedFoam<Real> viewStorage(FoamStorage<Real>& foam) {
  // Of a foam without moments nobody reads the rows, but everybody finds them.
  const bool hasMoments = !foam.firstMoments[0].empty();
  return {foam.shape,
          rowsOf<Real>(foam.values),
          rowsOf<Real>(hasMoments ? foam.firstMoments : foam.values),
          rowsOf<Real>(hasMoments ? foam.secondMoments : foam.values),
          foam.lastSteps.data(),
          foam.balls.data(),
          foam.contributions.data(),
          foam.errors.data()};
}

}  // namespace froth
