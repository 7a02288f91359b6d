// One ray through a foam in training: its loss, the branches it takes, and the gradient of every raw parameter.
#pragma once

#include <array>
#include <vector>

#include "trainer/cpu/cpu_step.h"
#include "trainer/cpu/foam_storage.h"

namespace froth {

// The derivatives of the loss by what the ray shows, and weights of the losses that go by cell.
struct ProbeLoss {
  glm::dvec3 colour;
  double transmittance;
  double normalWeight, overlapWeight;
};

struct ProbeRay {
  glm::dvec3 eye, direction;
};

struct ProbeResult {
  double loss = 0;
  glm::dvec4 shown{0};         // colour, T_N
  uint64_t branches = 0;       // a hash: equal where the loss is smooth between two foams
  bool isHeld = false;         // some divisor or value is held: there the gradient is not the slope
  double leastBallCosine = 1;  // between the ray and the normals of balls that bound its segments
  std::vector<uint32_t> metCells;
};

template <class Real>
class RayProbe {
 public:
  explicit RayProbe(FoamStorage<Real>& foam) : foam_(foam), step_(foam) {}
  ProbeResult look(const ProbeRay& ray, const ProbeLoss& loss);
  // By parameter, of all cells.
  std::array<std::vector<Real>, kParameterCount> differentiate(const ProbeRay& ray, const ProbeLoss& loss);

 private:
  void render(const ProbeRay& ray, const ProbeLoss& loss);
  void visit(const SeenCells<Real>& seen, uint32_t rank, const glm::vec<3, Real>& direction, const ProbeLoss& loss,
             double& logTransmittance, ProbeResult& result) const;

  FoamStorage<Real>& foam_;
  CpuStep<Real> step_;
  std::vector<glm::vec<4, Real>> shown_;
};

}  // namespace froth
