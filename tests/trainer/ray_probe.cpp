#include "tests/trainer/ray_probe.h"

#include <algorithm>
#include <cmath>

#include "base/counter_random.h"
#include "trainer/step/ray_cell.h"

namespace froth {
namespace {

void mixInto(uint64_t& hash, uint64_t value) { hash = mixBits(hash ^ mixBits(value + 1)); }

template <class Real>
glm::dvec3 inDouble(const glm::vec<3, Real>& vector) {
  return glm::dvec3(vector);
}

// Adam without a rate: it leaves values and keeps a tenth of each gradient as the first moment.
template <class Real>
AdamStep<Real> stillAdam() {
  AdamStep<Real> adam{};
  std::fill(std::begin(adam.rates), std::end(adam.rates), Real(0));
  return adam;
}

// The cosine between the ray and the normal of the ball or plane that it meets at t.
template <class Real>
double cosineAt(const SeenCell<Real>& cell, const SeenPlane<Real>* planes, uint32_t surface,
                const glm::vec<3, Real>& direction, Real t) {
  if (surface == kBoundedByEye) return 1;
  if (surface == kBoundedByBall) return std::abs(glm::dot(t * direction - cell.centre, direction)) / cell.radius;
  return std::abs(glm::dot(glm::normalize(planes[surface].plane), direction));
}

}  // namespace

template <class Real>
void RayProbe<Real>::render(const ProbeRay& ray, const ProbeLoss& loss) {
  const glm::dvec3 side = std::abs(ray.direction.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(side, ray.direction));
  TrainingView<Real> view;
  view.width = view.height = 1;
  view.fx = view.fy = 1;
  view.cx = view.cy = Real(0.5);
  view.eye = glm::vec<3, Real>(ray.eye);
  view.worldFromCamera = {glm::vec<3, Real>(right), glm::vec<3, Real>(glm::cross(ray.direction, right)),
                          glm::vec<3, Real>(ray.direction)};
  PixelSettings<Real> settings;
  settings.cutoff = 0;
  settings.normalWeight = Real(loss.normalWeight);
  settings.perPixel = 1;
  step_.forgetPairs();
  step_.activate(0);
  shown_ = step_.render(view, settings, stillAdam<Real>());
}

template <class Real>
void RayProbe<Real>::visit(const SeenCells<Real>& seen, uint32_t rank, const glm::vec<3, Real>& direction,
                           const ProbeLoss& loss, double& logTransmittance, ProbeResult& result) const {
  const uint32_t detailCount = foam_.shape.detailCount;
  const SeenCell<Real>& cell = seen.cells[rank];
  const SeenPlane<Real>* planes = seen.planes + cell.planesBegin;
  const SeenDetail<Real>* details = seen.details + size_t{rank} * detailCount;
  Segment<Real> segment;
  if (!meetCell(cell, planes, details, detailCount, direction, Real(10), segment)) return;
  result.metCells.push_back(cell.cell);
  const double opticalDepth = double{cell.density} * (segment.far - segment.near);
  const double weight = std::exp(logTransmittance) * -std::expm1(-opticalDepth);
  logTransmittance -= opticalDepth;
  const double facing = std::max(double{segment.facing}, 0.0);
  result.loss += weight * (glm::dot(loss.colour, inDouble(segment.colour)) + loss.normalWeight * facing * facing);
  mixInto(result.branches, cell.cell);
  for (const uint32_t surface : {segment.nearSurface, segment.farSurface}) mixInto(result.branches, surface);
  mixInto(result.branches, (segment.facing < 0) + 2 * (segment.near > segment.ballOrPlaneNear) +
                               4 * (segment.far < segment.ballOrPlaneFar) +
                               8 * (segment.heightPlace > segment.ballOrPlaneNear) +
                               16 * (segment.heightWeights < Real(1e-20)) + 32 * (segment.colourWeights < Real(1e-20)));
  for (uint32_t k = 0; k < detailCount; ++k) {
    for (int c = 0; c < 3; ++c) mixInto(result.branches, details[k].colour[c] > 0);
  }
  // Twice where gradients are held, so that differences stay on one side.
  result.isHeld = result.isHeld || std::abs(segment.facing) < Real(2e-4);
  for (const auto& [surface, t] : {std::pair{segment.nearSurface, segment.ballOrPlaneNear},
                                   std::pair{segment.farSurface, segment.ballOrPlaneFar}}) {
    const double cosine = cosineAt(cell, planes, surface, direction, t);
    const bool isBall = surface == kBoundedByBall;
    result.isHeld = result.isHeld || cosine < (isBall ? 2e-3 : 2e-4);
    if (isBall) result.leastBallCosine = std::min(result.leastBallCosine, cosine);
  }
}

template <class Real>
ProbeResult RayProbe<Real>::look(const ProbeRay& ray, const ProbeLoss& loss) {
  render(ray, loss);
  const SeenCells<Real> seen = step_.seen();
  ProbeResult result;
  double logTransmittance = 0;
  for (uint32_t rank = 0; rank < seen.count; ++rank) {
    visit(seen, rank, glm::vec<3, Real>(ray.direction), loss, logTransmittance, result);
  }
  result.shown = glm::dvec4(shown_[0]);
  result.loss += loss.transmittance * std::exp(logTransmittance);
  const CellGraph& pairs = step_.pairs();
  for (uint32_t i = 0; i < foam_.shape.cellCount; ++i) {
    for (const uint32_t j : neighboursOf(pairs, i)) {
      const glm::dvec4 a(foam_.balls[i]), b(foam_.balls[j]);
      const double overlap = std::max(a.w + b.w - glm::distance(glm::dvec3(a), glm::dvec3(b)), 0.0);
      result.loss += loss.overlapWeight * overlap * overlap;
    }
  }
  return result;
}

template <class Real>
std::array<std::vector<Real>, kParameterCount> RayProbe<Real>::differentiate(const ProbeRay& ray,
                                                                             const ProbeLoss& loss) {
  for (std::vector<Real>& moments : foam_.firstMoments) std::fill(moments.begin(), moments.end(), Real(0));
  std::fill(foam_.lastSteps.begin(), foam_.lastSteps.end(), 0u);
  render(ray, loss);
  step_.differentiate({glm::vec<4, Real>(loss.colour, loss.transmittance)}, {glm::vec<4, Real>(0)});
  step_.update(stillAdam<Real>(), Real(loss.overlapWeight));
  std::fill(foam_.lastSteps.begin(), foam_.lastSteps.end(), 0u);
  std::array<std::vector<Real>, kParameterCount> gradients = foam_.firstMoments;
  for (std::vector<Real>& tensor : gradients) {
    for (Real& value : tensor) value *= 10;
  }
  return gradients;
}

template class RayProbe<float>;
template class RayProbe<double>;

}  // namespace froth
