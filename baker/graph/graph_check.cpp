// The validity report of a bake: rows by inspection, the diagram by samples.
#include <algorithm>
#include <functional>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "baker/graph/diagram_check.h"
#include "baker/graph/graph.h"

namespace froth {
namespace {

constexpr size_t kMaxFaults = 16;
constexpr uint32_t kWaves = 16, kBlocksPerWave = 16;
constexpr uint32_t kPoints = 8192, kRays = 192;

using Faults = std::vector<std::string>;

// Runs check(index, faults) for all indices on all cores; faults come in the order of the indices. False: stopped.
bool checkAll(uint32_t count, const Progress& progress, Faults& faults,
              const std::function<void(uint32_t, Faults&)>& check) {
  for (uint32_t wave = 0; wave < kWaves; ++wave) {
    if (!report(progress, "check", wave, kWaves)) return false;
    std::array<Faults, kBlocksPerWave> found;
    tbb::parallel_for(uint32_t{0}, kBlocksPerWave, [&](uint32_t block) {
      const auto beginOf = [&](uint64_t k) { return static_cast<uint32_t>(count * k / (kWaves * kBlocksPerWave)); };
      const uint32_t number = wave * kBlocksPerWave + block;
      for (uint32_t k = beginOf(number); k < beginOf(number + 1); ++k) {
        if (found[block].size() < kMaxFaults) check(k, found[block]);
      }
    });
    for (Faults& some : found) faults.insert(faults.end(), some.begin(), some.end());
    faults.resize(std::min(faults.size(), kMaxFaults));
  }
  return true;
}

// Offsets ascend to the array's end, and neighbours are cells: what must hold before a row is read.
bool checkLayout(const char* name, const CellGraph& graph, size_t cellCount, Faults& faults) {
  const std::vector<uint32_t>& offsets = graph.offsets;
  if (offsets.size() != cellCount + 1 || offsets.front() != 0 || offsets.back() != graph.neighbours.size() ||
      !std::is_sorted(offsets.begin(), offsets.end())) {
    faults.push_back(fmt::format("{} graph: the offsets do not describe rows of {} cells", name, cellCount));
    return false;
  }
  const auto stray = std::find_if(graph.neighbours.begin(), graph.neighbours.end(),
                                  [&](uint32_t neighbour) { return neighbour >= cellCount; });
  if (stray == graph.neighbours.end()) return true;
  faults.push_back(fmt::format("{} graph: neighbour {} of {} cells", name, *stray, cellCount));
  return false;
}

void checkRow(const char* name, const CellGraph& graph, uint32_t cell, Faults& faults) {
  const std::span<const uint32_t> row = neighboursOf(graph, cell);
  for (size_t k = 0; k < row.size(); ++k) {
    if (row[k] == cell) faults.push_back(fmt::format("{} graph: cell {} is its own neighbour", name, cell));
    if (k > 0 && row[k] <= row[k - 1]) {
      faults.push_back(fmt::format("{} graph: row of cell {} has {} after {}", name, cell, row[k], row[k - 1]));
    }
    const std::span<const uint32_t> back = neighboursOf(graph, row[k]);
    if (!std::binary_search(back.begin(), back.end(), cell)) {
      faults.push_back(fmt::format("{} graph: cell {} has neighbour {}, but not the other way", name, cell, row[k]));
    }
  }
}

void checkCell(const RegularTriangulation& triangulation, const AlphaComplex& alpha, bool isAlone, uint32_t cell,
               Faults& faults) {
  const std::span<const uint32_t> walkRow = neighboursOf(triangulation.graph, cell);
  const std::span<const uint32_t> alphaRow = neighboursOf(alpha.graph, cell);
  const bool isHidden = triangulation.isHidden[cell];
  if (isHidden && !walkRow.empty()) {
    faults.push_back(fmt::format("hidden cell {} has {} neighbours", cell, walkRow.size()));
  }
  if (!isHidden && walkRow.empty() && !isAlone) {
    faults.push_back(fmt::format("cell {} is not hidden, but has no neighbour", cell));
  }
  if ((isHidden || alpha.isEmpty[cell]) && !alphaRow.empty()) {
    faults.push_back(fmt::format("invisible cell {} has {} neighbours in the alpha-complex", cell, alphaRow.size()));
  }
  if (!std::includes(walkRow.begin(), walkRow.end(), alphaRow.begin(), alphaRow.end())) {
    faults.push_back(
        fmt::format("cell {} has neighbours in the alpha-complex that it lacks in the triangulation", cell));
  }
}

}  // namespace

ValidityReport checkGraphs(std::span<const glm::vec3> sites, std::span<const float> radii,
                           const RegularTriangulation& triangulation, const AlphaComplex& alpha, uint64_t seed,
                           const Progress& progress) {
  const auto cellCount = static_cast<uint32_t>(sites.size());
  ValidityReport validity;
  validity.cells = cellCount;
  validity.walkPairs = triangulation.graph.neighbours.size() / 2;
  validity.alphaPairs = alpha.graph.neighbours.size() / 2;
  if (triangulation.isHidden.size() != cellCount || alpha.isEmpty.size() != cellCount) {
    validity.faults.push_back(fmt::format("marks of {} and {} cells for {} cells", triangulation.isHidden.size(),
                                          alpha.isEmpty.size(), cellCount));
    return validity;
  }
  if (!checkLayout("walk", triangulation.graph, cellCount, validity.faults) ||
      !checkLayout("alpha", alpha.graph, cellCount, validity.faults)) {
    return validity;
  }
  const auto visible = std::count(triangulation.isHidden.begin(), triangulation.isHidden.end(), uint8_t{0});
  const auto checkRows = [&](uint32_t cell, Faults& faults) {
    checkRow("walk", triangulation.graph, cell, faults);
    checkRow("alpha", alpha.graph, cell, faults);
    checkCell(triangulation, alpha, visible == 1, cell, faults);
  };
  if (!checkAll(cellCount, progress, validity.faults, checkRows) || visible == 0) return validity;
  sampleDiagram(sites, radii, triangulation, alpha, seed, progress, validity);
  return validity;
}

bool sampleDiagram(std::span<const glm::vec3> sites, std::span<const float> radii,
                   const RegularTriangulation& triangulation, const AlphaComplex& alpha, uint64_t seed,
                   const Progress& progress, ValidityReport& validity) {
  const DiagramCheck diagram(sites, radii, triangulation, alpha, seed);
  const auto checkPoint = [&](uint32_t k, Faults& faults) { diagram.checkPoint(k, faults); };
  if (!checkAll(kPoints, progress, validity.faults, checkPoint)) return false;
  validity.pointsChecked += kPoints;
  const auto checkRay = [&](uint32_t k, Faults& faults) { diagram.checkRay(k, faults); };
  if (!checkAll(kRays, progress, validity.faults, checkRay)) return false;
  validity.raysChecked += kRays;
  return true;
}

}  // namespace froth
