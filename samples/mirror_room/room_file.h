// The room around the foam, from a glTF file: meshes, camera, sun, and where foam and ball go.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "base/result.h"
#include "host/camera_path.h"

namespace froth {

struct RoomVertex {
  glm::vec3 position, normal;  // of the node
};

enum class MaterialKind { kMatt, kGlossy, kMirror };

struct RoomMaterialInfo {
  glm::vec3 colour{1};  // linear
  float roughness = 1;
  MaterialKind kind = MaterialKind::kMatt;
};

struct RoomNode {
  std::string name;
  glm::dvec3 position{0};  // in the world [metres]; y is up
  glm::dquat rotation{1, 0, 0, 0};
  double scale = 1;

  glm::dvec3 toWorld(const glm::dvec3& point) const { return position + rotation * (scale * point); }
};

// A range of triangles with one material.
struct RoomPart {
  uint32_t node = 0, material = 0;
  uint32_t firstIndex = 0, indexCount = 0;
};

// A plane dot(normal, p) + offset = 0 that shows what is on the side of its normal.
struct MirrorPlane {
  glm::dvec3 normal{0};
  double offset = 0;

  glm::dvec3 reflect(const glm::dvec3& point) const { return point - 2 * (glm::dot(normal, point) + offset) * normal; }
};

struct Room {
  std::vector<RoomVertex> vertices;
  std::vector<uint32_t> indices;
  std::vector<RoomPart> parts;
  std::vector<RoomNode> nodes;
  std::vector<RoomMaterialInfo> materials;
  MirrorPlane mirror;
  RoomNode foam;  // where it stands and how it is turned
  // the middle of its foot stands there, and it fills a cube of edge foam.scale; else its origin, in its own size
  bool isFoamFitted = false;
  RoomNode centre;    // what the camera and the motes turn around; its scale is how far they reach
  uint32_t ball = 0;  // its node; the ball has radius 1 there
  Pose camera;
  glm::dvec3 toSun{0, 1, 0};
  glm::vec3 sun{1};  // light on a surface that faces it
};

// Reads triangles with normals and 16-bit indices, materials without textures and nodes without children. A metal of
// roughness 0 is a mirror, and all mirrors lie in one plane; roughness below 0.3 is glossy. A mirror, the nodes "foam",
// "ball" and "centre", a camera and a directional light must be there.
Result<Room> readRoom(const std::filesystem::path& path);

}  // namespace froth
