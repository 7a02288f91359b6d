// Cells are prepared once, whoever comes to them.
#include "trainer/cpu/prepared_cells.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <numeric>
#include <thread>

#include "tests/reference/scenes.h"
#include "trainer/cpu/foam_exchange.h"
#include "trainer/cpu/skin_pairs.h"
#include "trainer/cpu/view_exchange.h"

namespace froth {
namespace {

constexpr uint32_t kDetails = 2;

// Of what a ray reads of a cell.
double sumOf(const SeenCells<float>& seen, uint32_t rank) {
  const SeenCell<float>& cell = seen.cells[rank];
  double sum = cell.centre.x + cell.radius + cell.normal.y + cell.tangent.z + cell.density;
  for (uint32_t i = cell.planesBegin; i < cell.planesEnd; ++i) sum += seen.planes[i].plane.x / seen.planes[i].clearance;
  for (uint32_t k = 0; k < kDetails; ++k) sum += seen.details[size_t{rank} * kDetails + k].colour.y;
  return sum;
}

// Under the thread sanitizer a cell that is read before it is whole is found too. It knows nothing of TBB's own order.
TEST(PreparedCells, ThreadsFindTheSameOfEachCell) {
  const tbb::global_control alone(tbb::global_control::max_allowed_parallelism, 1);
  FoamStorage<float> storage = storeFoam<float>(randomFoam(500, kDetails, 2, 5));
  const TrainedFoam<float> foam = viewStorage(storage);
  for (uint32_t cell = 0; cell < foam.shape.cellCount; ++cell) foam.balls[cell] = ballOf(foam, cell);
  SkinPairs pairs;
  pairs.follow(storage.balls, 0);
  const TrainingView<float> view = trainingView<float>(lookAt({0.5, 0.4, -6}, {0, 0, 0}, 8, 8, 0.3));
  const AdamStep<float> adam{};
  std::vector<uint32_t> cellOfRank(foam.shape.cellCount);
  std::iota(cellOfRank.rbegin(), cellOfRank.rend(), 0u);

  PreparedCells<float> cells;
  for (int round = 0; round < 20; ++round) {
    cells.take(foam, pairs.rows(), view, adam, cellOfRank);
    ASSERT_EQ(cells.count(), foam.shape.cellCount);
    EXPECT_EQ(cells.seen().cells[7].radius, 0);
    std::vector<std::vector<double>> found(4);
    std::vector<std::thread> threads;
    for (std::vector<double>& sums : found) {
      threads.emplace_back([&] {
        for (uint32_t rank = 0; rank < cells.count(); ++rank) {
          cells.prepare(rank);
          sums.push_back(sumOf(cells.seen(), rank));
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    for (uint32_t rank = 0; rank < cells.count(); ++rank) {
      const double whole = sumOf(cells.seen(), rank);
      for (const std::vector<double>& sums : found) ASSERT_EQ(sums[rank], whole) << rank;
    }
  }
}

}  // namespace
}  // namespace froth
