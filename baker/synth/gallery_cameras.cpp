#include <cmath>

#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "baker/synth/synth.h"
#include "reference/camera/view_pose.h"

namespace froth {

using glm::dvec3;

namespace {

constexpr uint32_t kWidth = 960, kHeight = 640;
constexpr double kHalfWidthTangent = 0.7;  // 70 degrees across

View lookAt(std::string name, const dvec3& eye, const dvec3& target) {
  View view;
  setPose(view, eye, glm::normalize(target - eye), {0, 0, 1});
  view.name = std::move(name);
  view.width = kWidth;
  view.height = kHeight;
  view.fx = view.fy = 0.5 * kWidth / kHalfWidthTangent;
  view.cx = 0.5 * kWidth;
  view.cy = 0.5 * kHeight;
  return view;
}

std::string numbered(const char* stem, int number) {
  return std::string(stem) + (number < 10 ? "_0" : "_") + std::to_string(number);
}

}  // namespace

CameraSet galleryCameras() {
  constexpr dvec3 kTestViews[12][2] = {{{6.4, 2.0, 1.60}, {1.0, 3.9, 1.15}},  {{2.6, 2.2, 1.55}, {6.9, 4.9, 1.10}},
                                       {{3.4, 4.2, 1.50}, {6.8, 0.8, 0.60}},  {{5.6, 3.9, 1.65}, {2.2, 0.6, 0.75}},
                                       {{2.3, 3.0, 1.45}, {8.0, 3.0, 1.50}},  {{4.2, 2.6, 1.60}, {4.1, 6.0, 1.55}},
                                       {{5.3, 3.4, 1.45}, {6.8, 5.1, 1.15}},  {{3.2, 3.4, 1.35}, {1.4, 5.2, 0.90}},
                                       {{5.2, 2.6, 1.10}, {6.7, 1.2, 0.40}},  {{3.0, 2.4, 1.25}, {1.5, 0.8, 0.45}},
                                       {{3.9, 3.3, 2.00}, {-0.5, 2.8, 1.30}}, {{4.6, 3.6, 2.10}, {3.0, 1.2, 0.20}}};
  CameraSet cameras;
  for (int i = 0; i < 12; ++i) cameras.views.push_back(lookAt(numbered("view", i), kTestViews[i][0], kTestViews[i][1]));

  constexpr int kKeyFrames = 16;
  for (int i = 0; i < kKeyFrames; ++i) {
    const double angle = glm::two_pi<double>() * i / kKeyFrames;
    const dvec3 eye(4.1 + 1.6 * std::cos(angle), 2.95 + 0.9 * std::sin(angle), 1.55 + 0.2 * std::sin(2 * angle));
    // The look runs around the walls ahead of the eye, so that a loop shows all four.
    const double ahead = angle + glm::pi<double>();
    const dvec3 target(4.0 + 3.6 * std::cos(ahead), 3.0 + 2.7 * std::sin(ahead), 1.2 - 0.15 * std::cos(2 * angle));
    cameras.flight.push_back(lookAt(numbered("key", i), eye, target));
  }
  return cameras;
}

}  // namespace froth
