// The cells of a sample with levels, level by level. Internal to level_sample.cpp.
#pragma once

#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/graph/graph.h"
#include "format/asset_contents.h"
#include "format/lattice.h"
#include "level_sample.h"

namespace froth {

inline constexpr double kLevelSampleStep = 0x1p-12;       // of positions
inline constexpr uint32_t kLevelSampleGroups[] = {4, 2};  // of levels 0 and 1

// std::mt19937's sequence is fixed by the standard, that of the distributions is not.
class LevelRandom {
 public:
  explicit LevelRandom(uint32_t seed) : engine_(seed) {}
  float operator()() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }  // [0, 1)
  float snapped() { return snapToStep(2 * (*this)() - 1, static_cast<float>(kLevelSampleStep)); }

 private:
  std::mt19937 engine_;
};

struct LevelCell {
  uint32_t number = 0;  // the same in all levels that hold the cell
  glm::vec3 site{};
  float radius = 0;
  float density = 0;
  glm::vec3 colour{};
  uint32_t madeBy = kNoGroup, in = kNoGroup;  // groups of the level below, and of this level
};

// One level as a whole, without hidden cells.
struct LevelFoam {
  std::vector<LevelCell> cells;
  RegularTriangulation triangulation;

  std::span<const uint32_t> neighbours(uint32_t cell) const { return neighboursOf(triangulation.graph, cell); }
};

struct SiteArrays {
  std::vector<glm::vec3> sites;
  std::vector<float> radii;
};

SiteArrays arraysOf(const std::vector<LevelCell>& cells);

// Level 0 first. Pairs of neighbours across groups of a level are the same in the next one, and their cells too.
std::vector<LevelFoam> makeLevelFoams(const LevelSampleOptions& options);

}  // namespace froth
