// What happened while a level was made coarser.
#pragma once

#include <cstdint>

namespace froth {

struct LevelReport {
  uint64_t groups = 0;   // that got coarser
  uint64_t failed = 0;   // that did not: their chunks belong to the floor
  uint64_t live = 0;     // live cells of all these groups
  uint64_t locked = 0;   // of these, cells that border on others
  uint64_t merges = 0;   // that stand
  uint64_t undone = 0;   // merges that would have changed a border
  uint64_t reviews = 0;  // of its merges, that stand
  uint64_t rounds = 0;   // triangulations until all borders were right
};

}  // namespace froth
