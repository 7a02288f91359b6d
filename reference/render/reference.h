// The reference renderer: the oracle of everything. Brute force over a bounding volume hierarchy, with its own Cech
// pairs (no triangulation), every cell sorted by its power, compiled from shaders/foam/ like the shaders.
#pragma once

#include <array>
#include <memory>

#include "base/image/image.h"
#include "base/progress.h"
#include "base/result.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

enum class Precision { kFloat, kDouble };

struct ReferenceOptions {
  Precision precision = Precision::kDouble;
  double cutoff = 0;     // a ray ends when its transmittance falls below
  double nearRatio = 4;  // resolved: the view's own value, else the asset's default
  double nearDepth = 0;  // [scene units]
  double quantile = 0.5;
  double detailSharpness = 10;
  // detail sites with less of a cell's weights have no part in its colour, as of rays (foam::leastShownShare)
  double leastShare = 0;
  // Every value that a cell is drawn with gets a relative error of up to this, of its own and random by the seed:
  // positions by their distance from the eye. What the image then changes by, a renderer may err by that rounds so
  // (Monte Carlo arithmetic). 0: none.
  double rounding = 0;
  uint64_t roundingSeed = 0;
  // 1 channel, size of the view: where each ray ends [scene units]; null: nowhere
  const Image* sceneDistance = nullptr;
  // Unit view axis, where a renderer is given the scene as depth along it; 0: as distances along rays. Changes how ends
  // are rounded.
  glm::dvec3 depthAxis{0};
};

struct RenderedImages {
  Image colour;    // 3 channels, display-coded over black, not clamped
  Image alpha;     // 1 channel, 1 - T
  Image distance;  // 1 channel, distance along the ray where T falls below quantile; -1: never
  Image normal;    // 3 channels, sum of T alpha n, world axes
  // [pixels] the one at distance, until there the last one that was met; UINT32_MAX: none, and of several foams
  std::vector<uint32_t> cells;
  // [pixels] where the quarters of what each shows stand (shaders/foam/quarters.h), as distances; -1: behind the foam.
  // Of several foams: whose, by the densest there
  std::vector<std::array<float, 4>> quarters;
  std::vector<std::array<uint32_t, 4>> quarterFoams;
};  // pixels without a ray (shaders/foam/lens.h): 0, 0, -1, 0, none, -1, 0

// Renders with all cores; the same input gives the same bits on any number of threads.
class ReferenceRenderer {
 public:
  // Keeps a reference to the foam; builds hierarchy and pairs once. All renders fail when `progress` asked to stop.
  explicit ReferenceRenderer(const Foam& foam, const Progress& progress = {});
  ~ReferenceRenderer();
  // Near limits are those of `options`, whatever the view says. Fails with kUsage for a view without pixels or with
  // more than 2^28, a ray map of another size, or a quantile outside 0..1; with kCancelled. May be called from several
  // threads at once.
  Result<RenderedImages> render(const View& view, const ReferenceOptions& options, const Progress& progress = {}) const;

  struct State;  // reference_state.h
  const State& state() const { return *state_; }

 private:
  std::unique_ptr<State> state_;
};

}  // namespace froth
