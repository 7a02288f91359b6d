// Compresses the colours of a foam: base colours, fewer lobes, axes from a codebook; errors weighed by what
// is seen.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "baker/appearance/visibility.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "format/asset_contents.h"

namespace froth {

// Knobs of a preset.
struct AppearanceOptions {
  // [display-coded] RMS error that a lobe has to take away, of a detail site that shows typically: one that
  // shows x times as much keeps lobes that take away errorBound / sqrt(x). Colours are rounded accordingly.
  float errorBound = 0;
  uint32_t lobeLimit = 32;    // most lobes kept per detail site
  uint32_t codebookSize = 0;  // entries of the axis codebook [0..65536]; 0: none
  float colourStep = 0;       // [display-coded] lattice of base and lobe colours, a power of two
  float lobeAxisStep = 0;     // lattice of axes, or of their residuals; a power of two
  float detailSiteStep = 0;   // [radii] finest lattice of detail sites, for detail scales; a power of two; 0: none
  // Errors count from all sides of a region too: from eyes within this distance of those of the views, whether or not
  // the views show the detail site. [scene units] negative: from the views and around them alone
  float eyeRadius = -1;
  uint64_t seed = 1;
};

// The colours of some cells, in the arrays of ChunkContents.
struct CellAppearance {
  std::vector<glm::vec3> cellColours;  // [cells] display-coded, multiples of 1/255
  std::vector<glm::vec3> baseColours;  // [cells * K]
  std::vector<uint8_t> colourScales;   // [cells]
  std::vector<uint8_t> detailScales;   // [cells]; empty without detailSiteStep
  std::vector<uint8_t> lobeCounts;     // [cells * K]
  std::vector<glm::vec3> lobeAxes, lobeColours;
  double squaredError = 0;  // sum over detail sites of weighted squared errors, display-coded, mean over channels
  double weight = 0;        // sum of the weights
  double maxError = 0;      // largest error of a channel of a detail site along a direction that counts
};

class AppearanceCoder {
 public:
  // Keeps references to foam and visibility. `visibility` null: directions are the hemisphere before each
  // face, all alike. Trains the codebook from a sample of the foam's lobes.
  static Result<AppearanceCoder> create(const Foam& foam, const Visibility* visibility,
                                        const AppearanceOptions& options, const Progress& progress = {});

  // The same for another foam with a visibility of its own, of both of which it keeps references; its axes are those
  // of the same codebook. `weight`: what an error of a typical cell weighs, beside one of the first foam.
  AppearanceCoder forFoam(const Foam& foam, const Visibility* visibility, float weight) const;

  const std::vector<glm::vec3>& codebook() const;
  // Thread-safe. Each cell's result depends on that cell (and the codebook) alone, so the order and grouping
  // of calls do not matter. Values lie on the lattices of the options and of the codebook.
  CellAppearance compress(std::span<const uint32_t> cells) const;

 private:
  struct Model;

  const Foam* foam_ = nullptr;
  AppearanceOptions options_;
  std::shared_ptr<const Model> model_;
};

}  // namespace froth
