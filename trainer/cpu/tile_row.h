// The rays of a row of tiles, on one thread: what they meet, and what they add up.
#pragma once

#include <cstdint>
#include <vector>

#include "trainer/cpu/prepared_cells.h"
#include "trainer/cpu/tile_balls.h"
#include "trainer/step/gradient_sums.h"
#include "trainer/step/pixel_passes.h"
#include "trainer/step/pixels.h"
#include "trainer/step/training_view.h"

namespace froth {

// Cells of the row are numbered by their place in `ranks`.
template <class Real>
struct TileRow {
  std::vector<uint32_t> ranks;                    // ascending
  std::vector<uint32_t> planesBegin;              // [ranks + 1] of the cell's pairs in `pairs`
  std::vector<std::vector<uint32_t>> tiles;       // [tiles] the ranks that each can see
  std::vector<std::vector<uint32_t>> tilePlaces;  // [tiles] the same cells, by their place
  std::vector<TileBalls<Real>> balls;             // [tiles] theirs
  // Of the rays, line by line: places in the tile's list of the cells that each met, front to back.
  std::vector<uint32_t> met;
  std::vector<size_t> metEnds;  // [pixels] in `met`
  // Sums.
  std::vector<CellSums<Real>> cells;
  std::vector<DetailSums<Real>> details;
  std::vector<glm::vec<4, Real>> pairs;
  uint32_t droppedCount = 0;
};

// The image that rows are of.
template <class Real>
struct RowImage {
  PreparedCells<Real>& cells;
  uint32_t detailCount;
  const TrainingView<Real>& view;
  const PixelSettings<Real>& settings;
  PixelArrays<Real> pixels;  // without ends
};

// Forward: takes the lists of `row`, writes what its rays met and the pixels' colours and transmittances.
template <class Real>
void renderRow(const RowImage<Real>& image, uint32_t tileY, TileRow<Real>& row);

// Backward, by the gradients of the pixels: writes the sums of `row`.
template <class Real>
void differentiateRow(const RowImage<Real>& image, uint32_t tileY, TileRow<Real>& row);

}  // namespace froth
