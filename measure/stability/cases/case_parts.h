// What the built-in cases are put together from.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "measure/stability/cases/stiff_case.h"

namespace froth {

// Of every case that does not say otherwise, so that a GPU compiles its shaders once.
inline constexpr uint32_t kCaseDetails = 4, kCaseLobes = 2;

// A face towards -z, where most views look from, and one whose plane holds the z axis.
inline constexpr glm::vec4 kFaceToViewer = {0.70710678f, 0, -0.70710678f, 0};
inline constexpr glm::vec4 kFaceSideways = {1, 0, 0, 0};

// A cell with a textured and dented face; all of its looks follow from `look`.
struct CaseCell {
  glm::vec3 site{0};
  float radius = 0.5f;
  float density = 8;
  glm::vec4 orientation = kFaceToViewer;
  float height = 0.4f;  // mean displacement [radii]; 5: all of the ball is solid
  uint32_t look = 0;
};

Foam foamOfCells(const std::vector<CaseCell>& cells, uint32_t details = kCaseDetails, uint32_t lobes = kCaseLobes);

// Overlapping cells in the cube -1..1, with faces of any direction, some without density. Sites are multiples of
// `step`.
std::vector<CaseCell> cloud(uint32_t count, uint64_t seed, float step = 1.0f / 1024);

// A grid of cubes with edges of one half: balls of one radius, `first` is the lowest site.
Foam foamOfCubes(const glm::ivec3& count, const glm::vec3& first, float radius);

// Cubes whose planes lie at whole halves of x and y and odd quarters of z, behind the plane z = 0.
Foam foamOfBoxes();

// All lengths times `factor`, about the origin: the same image for an eye that moves along.
Foam scaledFoam(Foam foam, float factor);
Foam movedFoam(Foam foam, const glm::vec3& by);

// Square pixels, a field of view of 2 atan(tanHalfFov) across the height, near limits off. `up` is not along the view.
View caseView(const glm::dvec3& eye, const glm::dvec3& target, uint32_t width = 32, uint32_t height = 24,
              double tanHalfFov = 0.5, const glm::dvec3& up = {0, -1, 0});
View orthographicView(const glm::dvec3& eye, const glm::dvec3& target, double halfHeight, uint32_t width = 32,
                      uint32_t height = 24);
// From the front and from a corner, at `distance` of the origin.
std::vector<View> outsideViews(double distance = 3.5);

// The families, one file each.
std::vector<StiffCase> siteCases();        // site_cases.cpp
std::vector<StiffCase> placeCases();       // place_cases.cpp
std::vector<StiffCase> sizeCases();        // size_cases.cpp
std::vector<StiffCase> densityCases();     // density_cases.cpp
std::vector<StiffCase> faceCases();        // face_cases.cpp
std::vector<StiffCase> eyeCases();         // eye_cases.cpp
std::vector<StiffCase> appearanceCases();  // appearance_cases.cpp
std::vector<StiffCase> viewCases();        // view_cases.cpp
std::vector<StiffCase> instanceCases();    // instance_cases.cpp
std::vector<StiffCase> depthCases();       // depth_cases.cpp
std::vector<StiffCase> layerCases();       // layer_cases.cpp
std::vector<StiffCase> inputCases();       // input_cases.cpp

}  // namespace froth
