// A step of training on the CPU, over TBB: the readable truth of what trainer/cuda does. The same input gives the same
// bits on any number of threads: each row of tiles has sums of its own, and they are added in the order of rows.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "trainer/cpu/foam_storage.h"
#include "trainer/cpu/skin_pairs.h"
#include "trainer/cpu/tile_row.h"
#include "trainer/step/adam.h"
#include "trainer/step/gradient_sums.h"
#include "trainer/step/pixel_passes.h"
#include "trainer/step/pixels.h"
#include "trainer/step/seen_cells.h"
#include "trainer/step/training_view.h"
#include "trainer/step/view_gradients.h"

namespace froth {

template <class Real>
class CpuStep {
 public:
  explicit CpuStep(FoamStorage<Real>& foam) : foam_(foam) {}  // keeps a reference

  // The calls of a step, in this order. `leastSkin`: SkinPairs.
  void activate(float leastSkin);
  // What the view shows; colour over black and transmittance by pixel. Parameters are those before adam.step, waiting
  // ones too, and stay as they are.
  const std::vector<glm::vec<4, Real>>& render(const TrainingView<Real>& view, const PixelSettings<Real>& settings,
                                               const AdamStep<Real>& adam);
  // gradients: [pixels] of the loss, by what render() returned. wanted: what PixelArrays says.
  void differentiate(const std::vector<glm::vec<4, Real>>& gradients, const std::vector<glm::vec<4, Real>>& wanted);
  // overlapWeight: lambda of L_connect.
  void update(const AdamStep<Real>& adam, Real overlapWeight);

  // In place of update(), in a step of several views (trainer/step/view_gradients.h): the first after each
  // differentiate(), the second after the last view; it forgets what was kept.
  void keepGradients(const AdamStep<Real>& adam, Real overlapWeight);
  void updateByViews(const AdamStep<Real>& adam);

  // After cells changed places: before the next activate().
  void forgetPairs() { pairs_.forget(); }

  SeenCells<Real> seen();                                  // of the last render(): PreparedCells::seen()
  GradientSums<Real> sums();                               // what the last differentiate() added up for it
  uint64_t droppedCount() const { return droppedCount_; }  // contributions that were no finite numbers, of all steps
  const CellGraph& pairs() const { return pairs_.graph(); }
  NeighbourRows rows() const { return pairs_.rows(); }  // the same, of the last activate()

 private:
  // A cell that the view sees.
  struct Candidate {
    Real power = 0;  // of the eye
    uint32_t cell = 0;
    uint32_t tilesBegin = 0, tilesEnd = 0;  // in the tiles of its block
  };
  // Cells that follow each other often lie beside each other, so they are culled together.
  static constexpr uint32_t kBlockCells = 256;
  struct CellBlock {
    glm::vec<4, Real> ball;             // around those of its cells
    std::vector<Candidate> candidates;  // by cell
    std::vector<uint32_t> tiles;        // of each candidate, ascending
  };
  void boundBlock(uint32_t block);
  void cull();
  void cullBlock(uint32_t block, const std::vector<glm::vec<4, Real>>& cones);
  std::span<const uint32_t> tilesOf(const Candidate& candidate) const;
  void bin();
  void binRow(uint32_t tileY);
  void forEachRow(void (*pass)(const RowImage<Real>&, uint32_t tileY, TileRow<Real>&));
  void reduce();
  glm::vec<4, Real> gradientOfBall(uint32_t cell, const Eyes& eyes, Real overlapWeight);
  PixelArrays<Real> pixels();

  FoamStorage<Real>& foam_;
  SkinPairs pairs_;
  TrainingView<Real> view_;
  PixelSettings<Real> settings_;
  uint64_t droppedCount_ = 0;

  std::vector<CellBlock> blocks_;
  std::vector<Candidate> candidates_;  // by rank
  PreparedCells<Real> prepared_;
  std::vector<TileRow<Real>> rows_;
  struct RowRange {
    uint32_t first, last;
  };
  std::vector<RowRange> rowRanges_;     // [ranks] rows of tiles that see the cell
  std::vector<uint32_t> rowPlaces_;     // of all ranks, of each in each row of its range
  std::vector<size_t> rowPlacesBegin_;  // [ranks + 1]

  std::vector<glm::vec<4, Real>> rendered_, gradients_, wanted_;
  std::vector<Real> logTransmittances_;
  std::vector<CellSums<Real>> cellSums_;
  std::vector<DetailSums<Real>> detailSums_;
  std::vector<glm::vec<4, Real>> pairSums_;

  struct KeptView {
    glm::vec<3, Real> eye;
    std::vector<KeptCell<Real>> cells;
    std::vector<DetailSums<Real>> details;
  };
  std::vector<KeptView> keptViews_;  // of this step
};

}  // namespace froth
