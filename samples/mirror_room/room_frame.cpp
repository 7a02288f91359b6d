#include "samples/mirror_room/room_frame.h"

#include <algorithm>
#include <limits>

namespace froth {
namespace {

// The surroundings beyond the room; the sun is the room's own.
const glm::vec4 kSky(0.42f, 0.47f, 0.54f, 0), kGround(0.25f, 0.22f, 0.19f, 0);

static_assert(static_cast<uint32_t>(MaterialKind::kMatt) == room::kMatt);
static_assert(static_cast<uint32_t>(MaterialKind::kGlossy) == room::kGlossy);
static_assert(static_cast<uint32_t>(MaterialKind::kMirror) == room::kMirror);

glm::dmat4 translation(const glm::dvec3& by) {
  glm::dmat4 matrix(1);
  matrix[3] = glm::dvec4(by, 1);
  return matrix;
}

// Reversed depth with an infinite far plane, as Froth is told.
glm::dmat4 clipFromRelative(const Pose& pose, VkExtent2D extent) {
  const FrothCamera camera = cameraOf(pose, extent);
  glm::dmat4 clipFromView;
  for (int i = 0; i < 16; ++i) clipFromView[i / 4][i % 4] = camera.clipFromView[i];
  return clipFromView * glm::dmat4(glm::transpose(glm::mat3_cast(pose.worldFromCamera)));
}

void setRays(const Pose& pose, VkExtent2D extent, room::RoomFrame& frame) {
  const double perPixel = 2 * pose.tanHalfFovY / extent.height;
  const glm::dmat3 worldFromView = glm::mat3_cast(pose.worldFromCamera);
  const glm::dvec3 corner(-0.5 * perPixel * extent.width, -0.5 * perPixel * extent.height, 1);
  frame.rayCorner = glm::dvec4(worldFromView * corner, 0);
  frame.rayStepX = glm::dvec4(perPixel * worldFromView[0], 0);
  frame.rayStepY = glm::dvec4(perPixel * worldFromView[1], 0);
}

void setMaterials(const Room& room, room::RoomFrame& frame) {
  const size_t count = std::min<size_t>(room.materials.size(), room::kMostMaterials);
  for (size_t i = 0; i < count; ++i) {
    const RoomMaterialInfo& material = room.materials[i];
    frame.materials[i].colour = glm::vec4(material.colour, material.roughness);
    frame.materials[i].looks.w = static_cast<float>(material.kind);
  }
}

void setParticles(const RoomShot& shot, room::RoomFrame& frame) {
  const size_t count = std::min<size_t>(shot.particles.size(), room::kMostParticles);
  for (size_t i = 0; i < count; ++i) {
    const Particle& particle = shot.particles[i];
    frame.particles[i] = {glm::dvec4(particle.centre - shot.pose.eye, particle.radius), particle.colour};
  }
  frame.counts.x = static_cast<int>(count);
}

}  // namespace

SunCamera::SunCamera(const Room& room) {
  const glm::dvec3 aside = glm::normalize(glm::cross(room.toSun, glm::dvec3(0, 0, 1)));
  const glm::dmat3 axes(aside, glm::cross(room.toSun, aside), -room.toSun);
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low);
  for (const RoomPart& part : room.parts) {
    for (uint32_t i = 0; i < part.indexCount; ++i) {
      const RoomVertex& vertex = room.vertices[room.indices[part.firstIndex + i]];
      const glm::dvec3 place = glm::transpose(axes) * room.nodes[part.node].toWorld(vertex.position);
      low = glm::min(low, place);
      high = glm::max(high, place);
    }
  }
  constexpr double kMargin = 0.1;  // [metres]
  extent = std::max(high.x - low.x, high.y - low.y) + 2 * kMargin;
  const double depth = high.z - low.z + 2 * kMargin;
  const glm::dvec3 middle = 0.5 * (low + high);
  glm::dmat4 clipFromSun(1);
  clipFromSun[0][0] = clipFromSun[1][1] = 2 / extent;
  clipFromSun[2][2] = 1 / depth;
  clipFromSun[3] = glm::dvec4(-2 / extent * middle.x, -2 / extent * middle.y, 0.5 - middle.z / depth, 1);
  clipFromWorld = clipFromSun * glm::dmat4(glm::transpose(axes));
}

MeshCamera cameraOf(const RoomShot& shot, VkExtent2D extent) {
  return {clipFromRelative(shot.pose, extent), shot.pose.eye, nullptr};
}

MeshCamera mirroredCameraOf(const RoomShot& shot, VkExtent2D extent) {
  const MirrorPlane& mirror = shot.room.mirror;
  const glm::dvec3& n = mirror.normal;
  glm::dmat4 reflection(glm::dmat3(1) - 2.0 * glm::outerProduct(n, n));
  reflection[3] = glm::dvec4(mirror.reflect(shot.pose.eye) - shot.pose.eye, 1);
  return {clipFromRelative(shot.pose, extent) * reflection, shot.pose.eye, &mirror};
}

room::RoomFrame frameOf(const RoomShot& shot, const SunCamera& sun, uint32_t shadowMapEdge, VkExtent2D extent,
                        bool hasFoam) {
  const Room& room = shot.room;
  room::RoomFrame frame{};
  frame.shadowFromRelative = sun.clipFromWorld * translation(shot.pose.eye);
  setRays(shot.pose, extent, frame);
  frame.mirror = glm::dvec4(room.mirror.normal, glm::dot(room.mirror.normal, shot.pose.eye) + room.mirror.offset);
  frame.toSun = glm::dvec4(room.toSun, sun.extent / shadowMapEdge);
  frame.sun = glm::vec4(room.sun, 0);
  frame.sky = kSky;
  frame.ground = kGround;
  const float depthAtOne = cameraOf(shot.pose, extent).clipFromView[14];
  frame.numbers = {depthAtOne, static_cast<float>(shot.look.occlusionReach),
                   static_cast<float>(shot.look.shadowCatching), 0};
  setMaterials(room, frame);
  setParticles(shot, frame);
  frame.counts.y = hasFoam ? 1 : 0;
  frame.counts.z = static_cast<int>(shot.look.rayStep);
  frame.counts.w = shot.look.hasBaseColours ? 1 : 0;
  return frame;
}

}  // namespace froth
