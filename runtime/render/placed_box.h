// The boxes of instances as a camera sees them.
#pragma once

#include <array>

#include <glm/glm.hpp>

#include "froth/froth.h"
#include "runtime/render/view_renderer.h"

namespace froth {

// A box as seen from the eye, in world axes.
struct PlacedBox {
  glm::dvec3 centre{0};
  glm::dmat3 axes{1};  // columns: unit and orthogonal
  glm::dvec3 half{0};  // its extent along each, from the centre

  // How far it reaches from its centre along an axis, in lengths of that.
  double reachAlong(const glm::dvec3& axis) const;
};

// Around all that can be seen of the instance.
PlacedBox boxOf(const RenderInstance& instance, const glm::dvec3& eye);

// Where the rays of a camera's region run, with a pixel around it: between planes through the eye.
class RayPyramid {
 public:
  RayPyramid() = default;  // all around
  // In world axes, or in those of an instance's asset. All around where the camera is no pinhole.
  explicit RayPyramid(const FrothCamera& camera, const RenderInstance& instance = {});
  // False: no ray meets the box. True where that is not known. A box along the axes is relative to the eye, too.
  bool mayMeet(const PlacedBox& box) const;
  bool mayMeet(const glm::dvec3& low, const glm::dvec3& high) const;

 private:
  std::array<glm::dvec3, 4> inwards_{};  // unit normals of the planes; 0: there is none
};

}  // namespace froth
