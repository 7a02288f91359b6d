#include "baker/lod/free_cells.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "foam/checkpoint/activation.h"
#include "trainer/step/cell_update.h"

namespace froth {
namespace {

// What a parameter moves in a step, at most about.
constexpr float kDensityRate = 0.02f;   // of the density
constexpr float kTurnRate = 0.007f;     // of a unit quaternion
constexpr float kPlaceRate = 0.007f;    // [radii]
constexpr float kHeightRate = 0.0035f;  // [radii]
constexpr float kColourRate = 0.007f;
constexpr float kMostLiveChange = 2;  // of a density, in all steps: a live cell stays one

}  // namespace

// Goes through the moments of a cell, one parameter after the other.
class FreeCells::Descent {
 public:
  Descent(Moments* moments, uint32_t step, float rate)
      : next_(moments),
        root_(std::sqrt(1 - std::pow(kBeta2, step))),
        rate_(rate * root_ / (1 - std::pow(kBeta1, step))) {}

  // By how much the next parameter moves.
  float move(float gradient, float rate) {
    float change = 0;
    updateValue(change, next_->first, next_->second, gradient, static_cast<float>(rate * rate_),
                static_cast<float>(kEpsilon * root_));
    ++next_;
    return change;
  }

 private:
  Moments* next_;
  double root_, rate_;
};

FreeCells::FreeCells(FoamStorage<float>& storage, std::span<const uint8_t> isFree)
    : foam_(viewStorage(storage)), rows_(isFree.size(), kNotFree) {
  const std::vector<float>& heights = storage.values[static_cast<size_t>(Parameter::kDetailHeights)];
  hasHeights_ = std::ranges::any_of(heights, [](float height) { return height != 0; });
  for (uint32_t cell = 0; cell < isFree.size(); ++cell) {
    if (!isFree[cell]) continue;
    rows_[cell] = static_cast<uint32_t>(densities_.size());
    densities_.push_back(*foam_.values.row(Parameter::kDensity, foam_.shape, cell));
  }
  steps_.assign(densities_.size(), 0);
  moments_.resize(densities_.size() * momentsOfCell());
}

void FreeCells::update(CpuStep<float>& step, float rate) {
  const SeenCells<float> seen = step.seen();
  const GradientSums<float> sums = step.sums();
  const size_t K = foam_.shape.detailCount;
  tbb::parallel_for(0u, seen.count, [&](uint32_t rank) {
    const SeenCell<float>& cell = seen.cells[rank];
    if (rows_[cell.cell] == kNotFree || !isShown(sums.cells[rank])) return;
    updateCell(cell, seen.details + rank * K, sums.cells[rank], sums.details + rank * K, rate);
  });
}

void FreeCells::updateCell(const SeenCell<float>& seen, const SeenDetail<float>* shown, const CellSums<float>& sums,
                           const DetailSums<float>* details, float rate) {
  const uint32_t row = rows_[seen.cell];
  Descent descent(&moments_[row * momentsOfCell()], ++steps_[row], rate);
  float& density = *foam_.values.row(Parameter::kDensity, foam_.shape, seen.cell);
  const float moved = density + descent.move(sums.density * foam::softplusSlope(density), kDensityRate * seen.density);
  const float first = densities_[row];
  if (first > 0) density = std::clamp(moved, first / kMostLiveChange, first * kMostLiveChange);
  float* turn = foam_.values.row(Parameter::kOrientations, foam_.shape, seen.cell);
  const glm::vec4 gradient = foam::quaternionGradient(glm::vec4(turn[0], turn[1], turn[2], turn[3]), sums.torque);
  for (int c = 0; c < 4; ++c) turn[c] += descent.move(gradient[c], kTurnRate);
  moveDetails(seen, shown, details, descent);
}

// A colour moves for all directions alike: views are too few to tell lobes apart.
void FreeCells::moveDetails(const SeenCell<float>& seen, const SeenDetail<float>* shown,
                            const DetailSums<float>* details, Descent& descent) {
  float* places = foam_.values.row(Parameter::kDetailSites, foam_.shape, seen.cell);
  float* heights = foam_.values.row(Parameter::kDetailHeights, foam_.shape, seen.cell);
  float* colours = foam_.values.row(Parameter::kLobeColours, foam_.shape, seen.cell);
  const uint32_t perDetail = 3 * foam_.shape.lobeCount;
  for (uint32_t k = 0; k < foam_.shape.detailCount; ++k) {
    places[2 * k] += descent.move(details[k].place.x, kPlaceRate);
    places[2 * k + 1] += descent.move(details[k].place.y, kPlaceRate);
    heights[k] += descent.move(seen.radius * details[k].height, hasHeights_ ? kHeightRate : 0);
    for (uint32_t c = 0; c < 3; ++c) {
      const int channel = static_cast<int>(c);
      const float gradient = foam::shownGradient(shown[k].colour[channel], details[k].colour[channel]);
      const float change = descent.move(gradient, kColourRate);
      for (uint32_t m = c; m < perDetail; m += 3) colours[k * perDetail + m] += change;
    }
  }
}

void FreeCells::write(Foam& foam) const {
  const uint32_t K = foam_.shape.detailCount, M = foam_.shape.lobeCount;
  for (uint32_t cell = 0; cell < foam.cellCount; ++cell) {
    if (rows_[cell] == kNotFree || steps_[rows_[cell]] == 0) continue;
    const auto row = [&](Parameter parameter) { return foam_.values.row(parameter, foam_.shape, cell); };
    foam.densities[cell] = static_cast<float>(softplus(double{*row(Parameter::kDensity)}));
    const float* turn = row(Parameter::kOrientations);
    foam.orientations[cell] = normaliseQuaternion(glm::dvec4(turn[0], turn[1], turn[2], turn[3]));
    for (size_t k = 0; k < K; ++k) {
      const float* place = row(Parameter::kDetailSites) + 2 * k;
      foam.detailSites[cell * size_t{K} + k] = {place[0], place[1]};
      foam.detailHeights[cell * size_t{K} + k] = row(Parameter::kDetailHeights)[k];
    }
    for (size_t m = 0; m < size_t{K} * M; ++m) {
      const float* colour = row(Parameter::kLobeColours) + 3 * m;
      foam.lobeColours[cell * size_t{K} * M + m] = {colour[0], colour[1], colour[2]};
    }
  }
}

}  // namespace froth
