// zstd frames whose contents are taken in pieces. Internal to the reading half of format/.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include <zstd.h>

#include "base/result.h"

namespace froth {

inline constexpr char kSectionRemedy[] = "the file is damaged, copy it or bake the scene again";

class FrameReader {
 public:
  // Both must outlive the reader. `place` names the section in messages.
  FrameReader(std::span<const uint8_t> stored, const std::string& place);

  // One frame after the other: start, read ..., end. The frame must state this content size.
  Status start(uint64_t contentSize);

  // Fills `out` whole.
  Status read(std::span<uint8_t> out);

  // The frame must end here; its checksum is read now.
  Status end();

  // Reads a frame with byte 0 of every element, then one with byte 1 of every element, ... `elements` is whole
  // elements.
  Status readPlanes(std::span<uint8_t> elements, uint32_t elementSize);

  // Only zeros may follow.
  Status finish() const;

 private:
  Status advance(ZSTD_outBuffer& output);

  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_;
  ZSTD_inBuffer input_;
  bool atEnd_ = false;
  const std::string& place_;
};

}  // namespace froth
