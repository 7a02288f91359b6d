#include "baker/lod/border_numbers.h"

namespace froth {

std::vector<CellRef> numberBorders(std::span<const PlannedChunk> chunks, std::span<const CellRows> rows,
                                   uint32_t cellCount, uint32_t& count) {
  constexpr uint32_t kNone = 0xffffffff;
  std::vector<uint32_t> lastChunk(cellCount, kNone);  // the last chunk so far where a cell stands
  std::vector<uint8_t> isShared(cellCount, 0);
  for (uint32_t index = 0; index < chunks.size(); ++index) {
    for (const uint32_t cell : chunks[index].cells) {
      isShared[cell] |= lastChunk[cell] != kNone;
      lastChunk[cell] = index;
    }
    for (const uint32_t neighbour : rows[index].walk.neighbours) isShared[neighbour] |= lastChunk[neighbour] != index;
  }
  std::vector<CellRef> numbers(cellCount, kNoRef);
  count = 0;
  for (const PlannedChunk& chunk : chunks) {
    for (const uint32_t cell : chunk.cells) {
      if (isShared[cell] && numbers[cell] == kNoRef) numbers[cell] = count++;
    }
  }
  return numbers;
}

}  // namespace froth
