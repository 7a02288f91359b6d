// The way back: from the chunks of an asset to a foam. Internal to baker/bake.
#pragma once

#include <cstdint>
#include <utility>

#include "foam/foam.h"
#include "format/asset_contents.h"

namespace froth {

class FoamAssembler {
 public:
  // The foam has base colours, and its own number of lobes per detail site, only if told so; a chunk may have either
  // then.
  FoamAssembler(uint32_t detailCount, uint32_t lobeCount, bool hasBaseColours, bool hasLobeOffsets);
  void append(const ChunkContents& chunk);  // array lengths must match the counts
  Foam take() { return std::move(foam_); }

 private:
  void appendLobes(const ChunkContents& chunk, size_t bareDetails);

  Foam foam_;
  bool hasBaseColours_, hasLobeOffsets_;
};

}  // namespace froth
