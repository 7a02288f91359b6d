// Which cells go, which are split, and in what order they then lie (design: training.md 6).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "trainer/cpu/foam_storage.h"
#include "trainer/step/cell_change.h"
#include "trainer/step/eyes.h"

namespace froth {

// What a plan is made of, by cell.
struct CellFacts {
  std::span<const glm::vec4> balls;    // site, radius
  std::span<const float> quaternions;  // raw, 4 each
  std::span<const float> contributions, errors;
  std::span<const uint32_t> overlaps;  // countOverlaps()
};

// What they are of a foam whose balls are known. Both outlive the facts.
CellFacts factsOf(const FoamStorage<float>& foam, std::span<const uint32_t> overlaps);

// Cell i of the foam that comes is a copy of cell sources[i], moments and all, changed by changes[i]. Along a Morton
// curve, so that cells near each other lie near each other in memory.
struct CellPlan {
  std::vector<uint32_t> sources;
  std::vector<CellChange> changes;
};

// Cells that show too little are removed, and parents drawn without replacement by their error until there are
// `wanted`; a parent and its child part in opposite directions on the face. Crowded cells shrink. The same facts, seed
// and step give the same plan. Fewer than wanted come where there are too few parents.
CellPlan planCells(const CellFacts& facts, uint32_t wanted, const Eyes& eyes, uint64_t seed, uint32_t step);

FoamStorage<float> rearrange(const FoamStorage<float>& foam, const CellPlan& plan);

}  // namespace froth
