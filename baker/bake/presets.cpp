// The presets: named sets of knobs.
#include "baker/bake/bake.h"

namespace froth {
namespace {

// `detailSiteBits`, `heightBits` and `colourStep` are the finest lattices: each cell coarsens them by what it shows.
BakeKnobs defaultKnobs() {
  BakeKnobs knobs;
  knobs.positionBits = 18;
  knobs.radiusBits = 11;
  knobs.densityBits = 4;
  knobs.frameBits = 12;
  knobs.detailSiteBits = 8;
  knobs.heightBits = 7;
  knobs.compressColours = true;
  knobs.appearance.errorBound = 0.02f;
  knobs.appearance.lobeLimit = 8;
  knobs.appearance.codebookSize = 2048;
  knobs.appearance.colourStep = 0x1p-5f;
  knobs.appearance.lobeAxisStep = 0.5f;
  return knobs;
}

BakeKnobs highKnobs() {
  BakeKnobs knobs = defaultKnobs();
  knobs.positionBits = 19;
  knobs.radiusBits = 12;
  knobs.densityBits = 7;
  knobs.detailSiteBits = 10;
  knobs.heightBits = 10;
  knobs.appearance.errorBound = 0.005f;
  knobs.appearance.lobeLimit = 32;
  knobs.appearance.colourStep = 0x1p-6f;
  knobs.appearance.lobeAxisStep = 0.25f;
  return knobs;
}

BakeKnobs smallKnobs() {
  BakeKnobs knobs = defaultKnobs();
  knobs.positionBits = 15;
  knobs.radiusBits = 8;
  knobs.densityBits = 3;
  knobs.frameBits = 8;
  knobs.appearance.errorBound = 0.038f;
  knobs.appearance.lobeLimit = 4;
  knobs.appearance.codebookSize = 1024;
  knobs.appearance.lobeAxisStep = 0;  // the codebook's axes as they are
  return knobs;
}

}  // namespace

Result<BakeKnobs> presetKnobs(const std::string& preset) {
  if (preset == "exact") return BakeKnobs{};
  if (preset == "high") return highKnobs();
  if (preset == "default") return defaultKnobs();
  if (preset == "small") return smallKnobs();
  return makeError(ErrorKind::kUsage, "preset '%s' does not exist; use exact, high, default or small", preset.c_str());
}

}  // namespace froth
