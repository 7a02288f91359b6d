// Captures that tests make: cameras around a subject, and points on it.
#pragma once

#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include "base/counter_random.h"
#include "reference/camera/view_pose.h"
#include "reference/capture/capture.h"

namespace froth::test {

// Looks from `eye` at `subject`; y is down.
inline CapturedView viewFrom(const glm::dvec3& eye, const glm::dvec3& subject, const std::string& name) {
  CapturedView captured;
  View& view = captured.view;
  setPose(view, eye, glm::normalize(subject - eye), {0, -1, 0});
  view.name = name;
  view.width = 64;
  view.height = 48;
  view.fx = view.fy = 60;
  view.cx = 32;
  view.cy = 24;
  return captured;
}

// `count` views on a circle around the subject.
inline Capture orbit(uint32_t count, const glm::dvec3& subject, double distance) {
  Capture capture;
  for (uint32_t i = 0; i < count; ++i) {
    const double angle = glm::two_pi<double>() * i / count;
    const glm::dvec3 eye = subject + distance * glm::dvec3(std::cos(angle), 0.1, std::sin(angle));
    capture.views.push_back(viewFrom(eye, subject, fmt::format("{:03}.png", i)));
  }
  return capture;
}

// Points in a ball, which every view observed.
inline void addPoints(Capture& capture, uint32_t count, const glm::dvec3& centre, double radius) {
  const CounterRandom random(1, Purpose::kSite);
  for (uint32_t i = 0; i < count; ++i) {
    const glm::dvec3 place = centre + radius * std::cbrt(random.uniform(100000 + i)) * random.direction(i);
    capture.points.push_back({place, {uint8_t(i), 100, 200}, capture.observers.size(), uint32_t(capture.views.size())});
    for (uint32_t view = 0; view < capture.views.size(); ++view) capture.observers.push_back(view);
  }
}

inline std::vector<uint32_t> allViews(const Capture& capture) {
  std::vector<uint32_t> indices(capture.views.size());
  std::iota(indices.begin(), indices.end(), 0u);
  return indices;
}

}  // namespace froth::test
