#include "trainer/start/scene_frame.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "reference/camera/view_rays.h"

namespace froth {
namespace {

constexpr double kSpreads = 3;  // a subject that nothing tells of lies so many spreads of the cameras away

// The upper median; `values` not empty.
double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

glm::dvec3 medianPoint(const std::vector<CapturedPoint>& points) {
  glm::dvec3 median;
  std::vector<double> values(points.size());
  for (int axis = 0; axis < 3; ++axis) {
    std::transform(points.begin(), points.end(), values.begin(),
                   [&](const CapturedPoint& point) { return point.position[axis]; });
    median[axis] = medianOf(values);
  }
  return median;
}

// From points to who observed them; if nobody says, from cameras to the centre.
double medianDistance(const Capture& capture, const glm::dvec3& centre) {
  std::vector<double> distances;
  for (const CapturedPoint& point : capture.points) {
    for (uint32_t i = 0; i < point.observerCount; ++i) {
      const View& view = capture.views[capture.observers[point.firstObserver + i]].view;
      distances.push_back(glm::distance(point.position, eyeOf(view)));
    }
  }
  if (distances.empty()) {
    for (const CapturedView& view : capture.views) distances.push_back(glm::distance(centre, eyeOf(view.view)));
  }
  return medianOf(std::move(distances));
}

glm::dvec3 meanEye(const std::vector<CapturedView>& views) {
  glm::dvec3 sum(0);
  for (const CapturedView& view : views) sum += eyeOf(view.view);
  return sum / static_cast<double>(views.size());
}

double spreadOf(const std::vector<CapturedView>& views, const glm::dvec3& middle) {
  double sum = 0;
  for (const CapturedView& view : views) {
    const glm::dvec3 offset = eyeOf(view.view) - middle;
    sum += glm::dot(offset, offset);
  }
  return std::sqrt(sum / static_cast<double>(views.size()));
}

// The place of the least sum of squared distances to the axes; none where most cameras do not look at it.
std::optional<glm::dvec3> meetingOfAxes(const std::vector<CapturedView>& views, const glm::dvec3& middle) {
  constexpr double kTie = 1e-3;  // parallel axes meet anywhere along them: a weak pull to the cameras decides
  const double tie = kTie * static_cast<double>(views.size());
  glm::dmat3 sum = tie * glm::dmat3(1);
  glm::dvec3 right(0);
  for (const CapturedView& view : views) {
    const glm::dvec3 axis = forwardOf(view.view);
    const glm::dmat3 across = glm::dmat3(1) - glm::outerProduct(axis, axis);
    sum += across;
    right += across * (eyeOf(view.view) - middle);
  }
  const glm::dvec3 place = middle + glm::inverse(sum) * right;
  const auto isBefore = [&](const CapturedView& view) {
    return glm::dot(place - eyeOf(view.view), forwardOf(view.view)) > 0;
  };
  const auto before = static_cast<size_t>(std::count_if(views.begin(), views.end(), isBefore));
  if (2 * before <= views.size()) return std::nullopt;
  return place;
}

SceneFrame frameOfCameras(const Capture& capture) {
  constexpr double kLeastShare = 0.25;  // of the spread: nearer than that, axes meet by chance or in the cameras
  const glm::dvec3 middle = meanEye(capture.views);
  constexpr double kRounding = 1e-9;  // of how far out the cameras are: eyes at one place, as a mean rounds them
  const double measured = spreadOf(capture.views, middle);
  const double spread = measured > kRounding * glm::length(middle) ? measured : 0;
  if (const std::optional<glm::dvec3> place = meetingOfAxes(capture.views, middle)) {
    const double distance = medianDistance(capture, *place);
    if (distance > kLeastShare * spread && distance > 0) return {*place, kNearDistance / distance};
  }
  const double distance = spread > 0 ? kSpreads * spread : 1;
  return {middle, kNearDistance / distance};
}

Foam movedFoam(Foam foam, const glm::dvec3& before, double scale, const glm::dvec3& after) {
  for (glm::vec3& site : foam.sites) site = (glm::dvec3(site) - before) * scale + after;
  for (float& radius : foam.radii) radius = static_cast<float>(radius * scale);
  for (float& density : foam.densities) density = static_cast<float>(density / scale);
  return foam;
}

}  // namespace

SceneFrame findSceneFrame(const Capture& capture) {
  if (capture.points.empty()) return frameOfCameras(capture);
  const glm::dvec3 centre = medianPoint(capture.points);
  const double distance = medianDistance(capture, centre);
  return distance > 0 ? SceneFrame{centre, kNearDistance / distance} : frameOfCameras(capture);
}

Eyes findEyes(const Capture& capture, const SceneFrame& frame) {
  const glm::dvec3 middle = meanEye(capture.views);
  double radius = 0;
  for (const CapturedView& view : capture.views) radius = std::max(radius, glm::distance(middle, eyeOf(view.view)));
  return {glm::vec3(normalised(middle, frame)), static_cast<float>(radius * frame.scale)};
}

glm::dvec3 normalised(const glm::dvec3& place, const SceneFrame& frame) { return (place - frame.centre) * frame.scale; }

View normalised(const View& view, const SceneFrame& frame) {
  View moved = view;
  const glm::dvec3 eye = normalised(eyeOf(view), frame);
  for (int axis = 0; axis < 3; ++axis) moved.worldFromCamera[4 * axis + 3] = eye[axis];
  if (moved.nearDepth) *moved.nearDepth *= frame.scale;
  return moved;
}

Foam normalisedFoam(Foam foam, const SceneFrame& frame) {
  return movedFoam(std::move(foam), frame.centre, frame.scale, glm::dvec3(0));
}

Foam sceneFoam(Foam foam, const SceneFrame& frame) {
  return movedFoam(std::move(foam), glm::dvec3(0), 1 / frame.scale, frame.centre);
}

}  // namespace froth
