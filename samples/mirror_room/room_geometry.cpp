#include "samples/mirror_room/room_geometry.h"

#include <cmath>

namespace froth {
namespace {

// Christer Ericson, Real-Time Collision Detection (2005), 5.1.5.
glm::dvec3 nearestOnTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
  const glm::dvec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return a;
  const glm::dvec3 bp = p - b;
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + d1 / (d1 - d3) * ab;
  const glm::dvec3 cp = p - c;
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

}  // namespace

RoomGeometry::RoomGeometry(const Room& room, std::optional<uint32_t> skipped) : room_(room) {
  for (uint32_t partIndex = 0; partIndex < room.parts.size(); ++partIndex) {
    const RoomPart& part = room.parts[partIndex];
    if (part.node == skipped) continue;
    const RoomNode& node = room.nodes[part.node];
    Group group{glm::dvec3(0), 0, triangles_.size(), 0};
    for (uint32_t i = 0; i < part.indexCount; i += 3) {
      RoomTriangle& triangle = triangles_.emplace_back();
      triangle.part = partIndex;
      for (uint32_t corner = 0; corner < 3; ++corner) {
        const RoomVertex& vertex = room.vertices[room.indices[part.firstIndex + i + corner]];
        triangle.corners[corner] = node.toWorld(vertex.position);
        triangle.normals[corner] = node.rotation * glm::dvec3(vertex.normal);
      }
    }
    group.last = triangles_.size();
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (size_t i = group.first; i < group.last; ++i) {
      for (const glm::dvec3& corner : triangles_[i].corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
      }
    }
    group.centre = 0.5 * (low + high);
    group.radius = 0.5 * glm::length(high - low);
    groups_.push_back(group);
  }
}

std::optional<MeshHit> RoomGeometry::cast(const glm::dvec3& origin, const glm::dvec3& direction, double tMin,
                                          double tMax) const {
  const RoomTriangle* met = nullptr;
  glm::dvec3 weights(0);
  for (const Group& group : groups_) {
    const glm::dvec3 offset = glm::cross(group.centre - origin, direction);
    if (glm::dot(offset, offset) > group.radius * group.radius * glm::dot(direction, direction)) continue;
    for (size_t i = group.first; i < group.last; ++i) {
      const RoomTriangle& triangle = triangles_[i];
      // Moller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
      const glm::dvec3 ab = triangle.corners[1] - triangle.corners[0], ac = triangle.corners[2] - triangle.corners[0];
      const glm::dvec3 p = glm::cross(direction, ac);
      const double determinant = glm::dot(ab, p);
      if (determinant == 0) continue;
      const glm::dvec3 s = origin - triangle.corners[0];
      const double u = glm::dot(s, p) / determinant;
      const glm::dvec3 q = glm::cross(s, ab);
      const double v = glm::dot(direction, q) / determinant;
      const double t = glm::dot(ac, q) / determinant;
      if (u < 0 || v < 0 || u + v > 1 || !(t > tMin) || !(t < tMax)) continue;
      tMax = t;
      met = &triangle;
      weights = {1 - u - v, u, v};
    }
  }
  if (!met) return {};
  const RoomPart& part = room_.parts[met->part];
  const glm::dvec3 normal = weights.x * met->normals[0] + weights.y * met->normals[1] + weights.z * met->normals[2];
  return MeshHit{tMax, glm::normalize(normal), part.material, part.node};
}

std::optional<glm::dvec3> RoomGeometry::nearest(const glm::dvec3& point, double reach) const {
  std::optional<glm::dvec3> found;
  for (const Group& group : groups_) {
    if (glm::distance(group.centre, point) > group.radius + reach) continue;
    for (size_t i = group.first; i < group.last; ++i) {
      const glm::dvec3(&corners)[3] = triangles_[i].corners;
      const glm::dvec3 candidate = nearestOnTriangle(point, corners[0], corners[1], corners[2]);
      if (glm::distance(candidate, point) > reach) continue;
      reach = glm::distance(candidate, point);
      found = candidate;
    }
  }
  return found;
}

}  // namespace froth
