// One zstd frame, fed in pieces. Internal to the writing half of format/.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <zstd.h>

#include "format/result.h"

namespace froth {

class FrameWriter {
 public:
  FrameWriter(uint64_t contentSize, int level);

  Status write(std::span<const uint8_t> piece, bool isLast);

  // Writes byte 0 of every element, then byte 1 of every element, ... and ends the frame.
  Status writePlanes(std::span<const uint8_t> elements, uint32_t elementSize);

  std::vector<uint8_t> take() { return std::move(frame_); }

 private:
  std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context_;
  std::vector<uint8_t> buffer_, frame_;
};

}  // namespace froth
