// A group on its way to the next level. Internal to baker/lod.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "baker/lod/coarse_form.h"
#include "baker/lod/level_chunk.h"
#include "baker/lod/merge_plan.h"
#include "base/result.h"

namespace froth {

struct LevelStep {
  std::vector<uint32_t> group;             // chunks
  std::optional<MergePlan> merges = {};    // until there is a form
  std::optional<MergePlan> replaced = {};  // by the last review, until the next
  std::vector<uint32_t> ring = {};
  std::optional<Result<CoarseForm>> form = {};
  uint32_t firstMerged = 0;  // cell of the scene
  std::vector<LevelChunk> made = {};
  Status status = {};

  void takeBack() {
    if (replaced) merges = std::move(replaced);
  }
};

}  // namespace froth
