// Where the first cells of a foam go, and what is known of them there.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "trainer/photos/photos.h"
#include "trainer/start/scene_frame.h"

namespace froth {

struct StartCell {
  glm::dvec3 position{0};        // normalised
  glm::dvec3 towards{0};         // to whom sees it, of any length; 0: not known
  glm::dvec3 colour{0.5};        // display-coded
  double mostRadius = HUGE_VAL;  // of 5 % of the height of an image that shows it
};

// What a start begins from.
struct StartScene {
  const Capture& capture;
  SceneFrame frame;
  std::span<const uint32_t> training;  // indices of views
  std::span<const Photo> photos;       // of those; empty: random cells are grey, and not cut by masks
  uint64_t seed = 0;
  Eyes eyes = {};  // without: all cells count as near
};

// One cell for each point, but for those that coincide with another, lie outliers' far away or that only other views
// observed; each beginning of the list is spread over the scene (spread_points.h). A point that nobody is said to
// observe faces the nearest training view that has it in its image.
std::vector<StartCell> cellsOfPoints(const StartScene& scene);

// Points that a random mixture is of.
constexpr uint32_t kMixed = 6;

// `count` random convex mixtures of a point and its nearest. `points` has at least kMixed.
std::vector<StartCell> mixCells(const std::vector<StartCell>& points, uint32_t count, uint64_t seed);

// A ball is no larger than 5 % of the height of any training view's image that has its centre, whether that view is
// said to see it or not: before a camera it would hide what lies behind.
void limitRadii(const StartScene& scene, std::vector<StartCell>& cells);

// `count` random pixels of training views at log-uniform depths. Where photos have alpha, of pixels that show the
// object, at depths that most other views show as object too, so in the visual hull; some tries that find none stay
// outside.
std::vector<StartCell> cellsInFrusta(const StartScene& scene, uint32_t count);

}  // namespace froth
