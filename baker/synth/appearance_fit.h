// Fits what a cell shows, by least squares over samples of its face and of directions.
#pragma once

#include <span>
#include <vector>

#include <glm/glm.hpp>

namespace froth {

// The part of a cell's face plane that belongs to it, and the places of its detail sites; all in units of its
// radius.
struct FacePatch {
  std::vector<glm::dvec2> samples;
  std::vector<uint32_t> nearestDetail;  // [samples] index into `details`
  std::vector<glm::dvec2> details;
};

// `cuts`: radical planes in the face plane, a.x * u + a.y * v <= a.z. Spreads `detailCount` detail sites
// evenly over what they leave of the unit disc.
FacePatch spreadDetails(std::span<const glm::dvec3> cuts, uint32_t detailCount);

// Values at the detail sites whose soft Voronoi blend comes closest to the values at the samples. Sharper
// than the samples themselves: it makes up for the blur of the blend.
std::vector<glm::dvec4> fitDetailValues(const FacePatch& patch, std::span<const glm::dvec4> sampleValues,
                                        double sharpness);

// A surface point as it looks from somewhere.
struct SeenColour {
  glm::dvec3 direction;  // unit, from the eye to the surface
  glm::dvec3 colour;     // display-coded
  double weight;
};

// Axes for Spherical Voronoi lobes: clusters of the directions, denser where the colour departs from its
// mean, and hotter where they are denser.
std::vector<glm::dvec3> chooseLobeAxes(std::span<const SeenColour> seen, uint32_t lobeCount);

// Least-squares colours of lobes with the given axes, as offsets from one half.
std::vector<glm::dvec3> fitLobeColours(std::span<const glm::dvec3> axes, std::span<const SeenColour> seen);

}  // namespace froth
