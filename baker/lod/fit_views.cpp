#include "baker/lod/fit_views.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include "reference/camera/view_rays.h"

namespace froth {
namespace {

constexpr size_t kNeighbours = 4;  // of a view, towards which others are put

glm::dquat turnOf(const View& view) {
  glm::dmat3 axes;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      axes[column][row] = view.worldFromCamera[static_cast<size_t>(4 * row + column)];
    }
  }
  return glm::quat_cast(axes);
}

// The lens is that of the first. `share`: of the way to the second.
View viewBetween(const View& a, const View& b, double share) {
  View view = a;
  const glm::dmat3 axes = glm::mat3_cast(glm::slerp(turnOf(a), turnOf(b), share));
  const glm::dvec3 eye = glm::mix(eyeOf(a), eyeOf(b), share);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      view.worldFromCamera[static_cast<size_t>(4 * row + column)] = axes[column][row];
    }
    view.worldFromCamera[static_cast<size_t>(4 * row + 3)] = eye[row];
  }
  return view;
}

// The nearest first; equals by index.
std::vector<size_t> neighboursOf(std::span<const View> views, size_t own) {
  std::vector<std::pair<double, size_t>> others;
  for (size_t k = 0; k < views.size(); ++k) {
    if (k != own) others.emplace_back(glm::distance(eyeOf(views[k]), eyeOf(views[own])), k);
  }
  std::sort(others.begin(), others.end());
  std::vector<size_t> nearest;
  for (size_t k = 0; k < std::min(kNeighbours, others.size()); ++k) nearest.push_back(others[k].second);
  return nearest;
}

}  // namespace

std::vector<View> chooseFitViews(std::span<const View> views) {
  std::vector<View> chosen;
  if (views.size() < 2) return chosen;
  for (size_t k = 0; k < kFitViews; ++k) {
    const size_t first = views.size() > kFitViews ? k * views.size() / kFitViews : k % views.size();
    const std::vector<size_t> near = neighboursOf(views, first);
    const double share = std::fmod((static_cast<double>(k) + 1) / std::numbers::phi, 1.0);  // evenly spread
    chosen.push_back(viewBetween(views[first], views[near[k / views.size() % near.size()]], share));
  }
  return chosen;
}

}  // namespace froth
