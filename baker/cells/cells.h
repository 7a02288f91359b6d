// The cells of a bake, between its steps. Internal to the baker.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

inline constexpr uint32_t kNoSource = 0xffffffff;

// Cells of the input, in its order and on the asset's lattices; then Steiner cells; then the merged cells of levels.
struct BakeCells {
  std::vector<glm::vec3> sites;  // [cells] world coordinates [scene units]
  std::vector<float> radii;      // [cells] [scene units, > 0]
  std::vector<float> densities;  // [cells] [1 / scene unit]; Steiner: 0
  // [cells] index in the input foam, and behind its cells in the foam of merged cells; kNoSource: Steiner
  std::vector<uint32_t> sources;
  std::vector<uint8_t> isUnseen;  // [input cells] 1: no camera sees it, so it only cuts its neighbours

  uint32_t count() const { return static_cast<uint32_t>(sites.size()); }
  uint32_t inputCount() const { return static_cast<uint32_t>(isUnseen.size()); }
};

// States from kHidden on have no place in the asset.
enum class CellState : uint8_t {
  kLive,
  kDead,    // too thin to be seen
  kEmpty,   // no bounded cell
  kUnseen,  // culled, but still cuts a live cell
  kSteiner,
  kHidden,    // no power cell
  kUnneeded,  // without a walk graph: cuts no live cell
};

inline bool isInAsset(CellState state) { return state < CellState::kHidden; }

}  // namespace froth
