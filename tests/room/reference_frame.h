// A frame of the room in double precision, ray by ray: triangles by brute force, foam by the reference renderer and by
// queries.
#pragma once

#include <optional>
#include <vector>

#include "reference/render/reference.h"
#include "samples/mirror_room/room_geometry.h"
#include "tests/room/room_fixture.h"

namespace froth::test {

class ReferenceFrame {
 public:
  ReferenceFrame(RoomUnderTest& room, const std::vector<Particle>& particles);

  std::vector<float> render() const;  // [height * width * 4] linear light, alpha 1

  // Share of the sun, and of the surrounding light, that reaches a place on a mesh.
  double sunAt(const glm::dvec3& position, const glm::dvec3& normal) const;
  double surroundAt(const glm::dvec3& position, const glm::dvec3& normal) const;

  // Share of light that comes through the foam.
  double throughFoam(const glm::dvec3& origin, const glm::dvec3& direction, double tMax) const;
  // Unit direction i of count that stands for the same share of a surface's light as all others.
  static glm::dvec3 spreadDirection(const glm::dvec3& normal, uint32_t i, uint32_t count);

 private:
  struct Surface {
    glm::dvec3 position, normal;
    double distance;
    const RoomMaterialInfo* material;
  };
  struct Light {
    glm::dvec3 colour{0};  // premultiplied, linear
    double alpha = 0;
  };
  struct FoamSeen {
    glm::dvec3 coded{0};  // premultiplied, display-coded
    double alpha = 0, distance = -1;
    glm::dvec3 normal{0};
  };

  std::optional<Surface> surfaceAlong(const glm::dvec3& origin, const glm::dvec3& direction) const;
  FoamSeen foamAlong(const glm::dvec3& eye, const glm::dvec3& direction, double tEnd) const;
  // Of a ray that leaves `eye` and counts from tStart on; what lies before holds no foam.
  Light foamAndMotes(const glm::dvec3& eye, const glm::dvec3& direction, double tStart, double tEnd) const;
  glm::dvec3 caughtShadow(const glm::dvec3& position, const glm::dvec3& normal) const;
  glm::dvec3 surroundings(const glm::dvec3& direction) const;
  glm::dvec3 litSurface(const Surface& surface, const glm::dvec3& along) const;
  glm::dvec3 lightInMirror(const glm::dvec3& eye, const Surface& mirror, const glm::dvec3& along) const;
  glm::dvec3 lightAlong(const glm::dvec3& eye, const glm::dvec3& along) const;

  const Room& room_;
  Pose pose_;
  RoomLook look_;
  room::RoomFrame frame_;  // for its constants
  FrothContext* context_;
  RoomGeometry meshes_;
  ReferenceRenderer renderer_;
  std::vector<Particle> particles_;
  glm::dvec3 foamPosition_;
  glm::dmat3 assetFromWorld_;  // rotation
  double foamScale_;
};

}  // namespace froth::test
