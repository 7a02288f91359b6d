// A stiff case: a small foam, the views that make it hard, and what follows from that for its image.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/gtc/quaternion.hpp>

#include "base/image/image.h"
#include "base/result.h"
#include "foam/foam.h"
#include "reference/camera/camera.h"

namespace froth {

// A fault that is known: no other is excused by it, and one that is gone fails the case until it is taken out here.
struct KnownFault {
  std::string preset, renderer;  // "exact", "raster"
  std::string kind;              // as CaseFault::kind without the renderer: "over its bound"
  double factor = 0;             // times the bound; within a factor two. 0: of kinds without a number
  std::string cause;
};

// Of an instance: world from foam by scale, then rotation, then position.
struct CasePlace {
  glm::dvec3 position{0};
  glm::quat rotation{1, 0, 0, 0};  // unit length
  float scale = 1;

  bool operator==(const CasePlace&) const = default;
};

inline constexpr size_t kMostPlaces = 4;  // that a ray of the GPU is in at the same time (FROTH_WALK_STREAMS)

inline constexpr uint32_t kAllLayersOfCase = 3;

struct StiffCase {
  std::string name;      // "sites/duplicate_equal": family and case, [a-z0-9_/]
  std::string what;      // one line: what is extreme here
  std::string analysis;  // one or two sentences: what conditions the image, and so what the bound grows with
  Foam foam;
  std::vector<View> views;  // small; with near limits of their own (0: off)
  // [scene units] where a renderer of assets places the foam, and moves the eyes to; the image is that of 0
  glm::dvec3 moved{0};
  uint32_t chunkCells = 0;          // most cells of a chunk of its bakes; 0: as always
  std::vector<CasePlace> places{};  // of instances, of which there are as many; empty: one, as it is
  // [views] 1 channel, of the views' sizes: where each ray ends [scene units]; empty: nowhere
  std::vector<Image> ends{};
  // [pixels] of devices' images, whose lenses are moved against it: the image stays as it is
  glm::vec2 jitter{0};
  uint32_t layers = kAllLayersOfCase;  // of the bakes that are loaded; the image is that of the foam which these hold
  bool isImported = false;             // the foam is written as a checkpoint and read back first, as a trained one is
  std::string refusal{};               // part of the message with which it must be refused; empty: it must not
  std::vector<KnownFault> known{};     // how it falls short of its bound, if it is known to; empty: it must not
};

// All built-in cases, in the order of the table. The same on every call and machine.
std::vector<StiffCase> builtInCases();

// The cases that transform a user's foam: placed, and saved in float, 10^3, 10^6 and 10^9 units away; in units of 1e-6
// and 1e6; with the eye on a site, sphere, radical plane and vertex (if it has one) of the cell in the middle of the
// first view. `views` are some of the user's own, drawn at most 160 pixels wide; without limits of their own their near
// tests are those of published models.
std::vector<StiffCase> casesOfFoam(const Foam& foam, const std::vector<View>& views);

}  // namespace froth
