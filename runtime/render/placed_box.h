// The boxes of instances as a camera sees them.
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "froth/froth.h"
#include "runtime/render/camera_rays.h"
#include "runtime/render/view_renderer.h"

namespace froth {

// A box as seen from the eye, in the axes of the world or of an asset.
struct PlacedBox {
  glm::dvec3 centre{0};
  glm::dmat3 axes{1};  // columns: unit and orthogonal
  glm::dvec3 half{0};  // its extent along each, from the centre

  // How far it reaches from its centre along an axis, in lengths of that.
  double reachAlong(const glm::dvec3& axis) const;
};

// Around all that can be seen of the instance, in world axes.
PlacedBox boxOf(const RenderInstance& instance, const glm::dvec3& eye);

// Where the rays of a camera's region run, with a pixel around it: between planes through the eye.
class RayPyramid {
 public:
  RayPyramid() = default;  // all around
  // In the axes of the rays. All around where the camera is no pinhole.
  RayPyramid(const FrothCamera& camera, const CameraRays& rays);
  // False: no ray meets the box. True where that is not known.
  bool mayMeet(const PlacedBox& box) const;

 private:
  std::array<glm::dvec3, 4> inwards_{};  // unit normals of the planes; 0: there is none
};

}  // namespace froth
