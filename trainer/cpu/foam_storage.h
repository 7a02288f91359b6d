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
  Tensors values, firstMoments, secondMoments;
  std::vector<uint32_t> lastSteps;
  std::vector<glm::vec<4, Real>> balls;
  std::vector<Real> contributions, errors;
};

// Sets the shape and all lengths; what is new is 0.
template <class Real>
void resizeStorage(FoamStorage<Real>& foam, const FoamShape& shape) {
  foam.shape = shape;
  for (size_t i = 0; i < kParameterCount; ++i) {
    const size_t length = size_t{shape.cellCount} * widthOf(static_cast<Parameter>(i), shape);
    for (auto* tensors : {&foam.values, &foam.firstMoments, &foam.secondMoments}) (*tensors)[i].resize(length);
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
  return {foam.shape,
          rowsOf<Real>(foam.values),
          rowsOf<Real>(foam.firstMoments),
          rowsOf<Real>(foam.secondMoments),
          foam.lastSteps.data(),
          foam.balls.data(),
          foam.contributions.data(),
          foam.errors.data()};
}

}  // namespace froth
