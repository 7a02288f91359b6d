#include "baker/bake/eye_region.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/counter_random.h"
#include "format/limits.h"
#include "format/to_vector.h"
#include "reference/camera/view_pose.h"
#include "reference/camera/view_rays.h"

namespace froth {
namespace {

constexpr uint32_t kSideOfFreeViews = 960;  // [pixels] without cameras, whose views say it

bool hasViews(const CameraSet* cameras) { return cameras && !cameras->views.empty(); }

glm::dvec3 drawEye(const EyeRegion& region, uint32_t index, uint32_t count, uint64_t seed) {
  const CounterRandom place(seed, Purpose::kSite), radius(seed, Purpose::kRadius), direction(seed, Purpose::kDirection);
  const Box& box = region.boxes[uint64_t{index} * region.boxes.size() / count % region.boxes.size()];
  const uint64_t first = uint64_t{index} * 3;
  const glm::dvec3 share(place.uniform(first), place.uniform(first + 1), place.uniform(first + 2));
  const double distance = region.radius * std::cbrt(radius.uniform(index));  // even in volume
  return glm::mix(toVector(box.min), toVector(box.max), share) + distance * direction.direction(index);
}

const View& findNearest(const std::vector<View>& views, const glm::dvec3& eye) {
  return *std::ranges::min_element(views, {}, [&](const View& view) { return glm::distance(eyeOf(view), eye); });
}

// Axes x right, y down, z forward, evenly spread over all rotations but for the roll.
glm::dmat3 drawAxes(uint32_t index, uint64_t seed) {
  const glm::dvec3 forward = CounterRandom(seed, Purpose::kFrame).direction(index);
  const glm::dvec3 beside = std::abs(forward.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
  const glm::dvec3 right = glm::normalize(glm::cross(forward, beside));
  return {right, glm::cross(forward, right), forward};
}

View makeFreeView(const glm::dmat3& axes, uint32_t side) {
  View view;
  view.width = view.height = side;
  view.fx = view.fy = view.cx = view.cy = 0.5 * side;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) view.worldFromCamera[4 * row + column] = axes[column][row];
  }
  return view;
}

void place(View& view, const glm::dvec3& eye) {
  for (int row = 0; row < 3; ++row) view.worldFromCamera[4 * row + 3] = eye[row];
}

// Looks at `target` from `eye`.
View lookAt(const glm::dvec3& eye, const glm::dvec3& target) {
  View view;
  setPose(view, eye, glm::normalize(target - eye), {0.31, 0.22, 1});
  view.width = 160;
  view.height = 120;
  view.fx = view.fy = 120;
  view.cx = 80;
  view.cy = 60;
  return view;
}

}  // namespace

Status checkEyes(const BakeOptions& options) {
  const EyeChoice& eyes = options.eyes;
  if (!(eyes.aroundCameras >= 0 && eyes.aroundCameras <= kMaxNumber)) {
    return makeError(ErrorKind::kUsage, "eyes: found distance %g; give 0 to 2^50", eyes.aroundCameras);
  }
  if (eyes.aroundCameras > 0 && !hasViews(options.cameras)) {
    return makeError(ErrorKind::kUsage,
                     "eyes: found a distance to cameras, but none; give cameras with views, or a box");
  }
  if (!eyes.box) return {};
  for (size_t axis = 0; axis < 3; ++axis) {
    const double least = eyes.box->min[axis], most = eyes.box->max[axis];
    if (std::abs(least) <= kMaxNumber && std::abs(most) <= kMaxNumber && least <= most) continue;
    return makeError(ErrorKind::kUsage, "eyes: found %g to %g on axis %c; give the lower corner first, within +-2^50",
                     least, most, "xyz"[axis]);
  }
  return {};
}

EyeRegion makeEyeRegion(const BakeOptions& options) {
  EyeRegion region;
  if (options.eyes.box) {
    region.boxes = {*options.eyes.box};
  } else if (hasViews(options.cameras)) {
    region.radius = options.eyes.aroundCameras;
    for (const View& view : options.cameras->views) {
      const glm::dvec3 eye = eyeOf(view);
      region.boxes.push_back({{eye.x, eye.y, eye.z}, {eye.x, eye.y, eye.z}});
    }
  }
  return region;
}

std::vector<View> drawViews(const EyeRegion& region, const CameraSet* cameras, uint32_t count, uint64_t seed) {
  std::vector<View> views;
  for (uint32_t index = 0; index < count; ++index) {
    const glm::dvec3 eye = drawEye(region, index, count, seed);
    const View* camera = hasViews(cameras) ? &findNearest(cameras->views, eye) : nullptr;
    if (camera && index % 2 == 0) {
      views.push_back(*camera);
    } else {
      const uint32_t side = camera ? std::min(camera->width, camera->height) : kSideOfFreeViews;
      views.push_back(makeFreeView(drawAxes(index, seed), side));
    }
    if (camera) views.back().nearDepth = camera->nearDepth;
    if (camera) views.back().nearRatio = camera->nearRatio;
    place(views.back(), eye);
  }
  return views;
}

std::vector<View> viewsAround(const Foam& foam) {
  glm::dvec3 low(foam.sites[0]), high(low);
  for (uint32_t i = 0; i < foam.cellCount; ++i) {
    low = glm::min(low, glm::dvec3(foam.sites[i]) - double{foam.radii[i]});
    high = glm::max(high, glm::dvec3(foam.sites[i]) + double{foam.radii[i]});
  }
  const glm::dvec3 centre = 0.5 * (low + high);
  const double distance = 1.2 * glm::length(high - low);
  std::vector<View> views;
  for (const glm::dvec3& corner :
       {glm::dvec3(1, 1, 1), glm::dvec3(1, -1, -1), glm::dvec3(-1, 1, -1), glm::dvec3(-1, -1, 1)}) {
    views.push_back(lookAt(centre + distance / std::sqrt(3.0) * corner, centre));
  }
  return views;
}

bool hasChosenEyes(const BakeOptions& options) { return options.eyes.box || options.eyes.aroundCameras > 0; }

}  // namespace froth
